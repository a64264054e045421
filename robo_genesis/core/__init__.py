"""Plain data and numerics: what every other sub-package builds on."""
