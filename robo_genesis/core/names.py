"""The names of the environment variables by which commands, pages and Sphinx tell each other."""

BACKEND, RENDER = "ROBO_GENESIS_BACKEND", "ROBO_GENESIS_RENDER"
OUTPUTS_DIR = "ROBO_GENESIS_OUTPUTS_DIR"
"""The contract of a page: its compute target, its camera, and where it leaves files."""

RUN_ID, PAGE_SHA256 = "ROBO_GENESIS_RUN_ID", "ROBO_GENESIS_PAGE_SHA256"
COMMAND = "ROBO_GENESIS_COMMAND"
"""What a command tells a page: the id of the run, the digest of the page's code, the command."""

EXECUTED_PAGES = "ROBO_GENESIS_EXECUTED_PAGES"
"""What a build tells Sphinx: the file that lists the executed pages, see `build.built_pages`."""
