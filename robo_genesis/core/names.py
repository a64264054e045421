"""The names of the environment variables by which commands, pages and Sphinx tell each other."""

BACKEND, RENDER = "ROBO_GENESIS_BACKEND", "ROBO_GENESIS_RENDER"
OUTPUTS_DIR = "ROBO_GENESIS_OUTPUTS_DIR"
"""The contract of a page: its compute target, its camera, and where it leaves files."""

RUN_ID, COMMAND = "ROBO_GENESIS_RUN_ID", "ROBO_GENESIS_COMMAND"
PAGE_SHA256, PAGE_IMPORTS = "ROBO_GENESIS_PAGE_SHA256", "ROBO_GENESIS_PAGE_IMPORTS"
"""What a command gives a page: the id of the run, the command, the digest of the page's code, and
the modules of the course that the page imports."""

EXECUTED_PAGES = "ROBO_GENESIS_EXECUTED_PAGES"
"""What a build tells Sphinx: the file that lists the executed pages, see `build.built_pages`."""
