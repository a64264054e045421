"""Sphinx's configuration: Jupyter Book's, from `_config.yml`."""

from pathlib import Path

from robo_genesis.site.frame.configuration import configuration

globals().update(configuration(Path(__file__).parent))
