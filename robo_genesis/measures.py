"""Every metric of the course by its name: unit, and what a reader calls it."""

from robo_genesis import contact_metrics, drop_metrics, metrics

UNITS = drop_metrics.UNITS | contact_metrics.UNITS | metrics.UNITS
LABELS = drop_metrics.LABELS | contact_metrics.LABELS | metrics.LABELS
