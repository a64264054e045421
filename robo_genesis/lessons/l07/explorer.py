"""The data of the lesson's explorer, the map of the table."""

from robo_genesis.lessons.l07.table_map import explored as explored

MEASURES = False
