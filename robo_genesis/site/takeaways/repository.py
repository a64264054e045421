"""The repository that `_config.yml` names in `course_repository`, and its codespace."""

import re

from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.errors import ConfigError

ADDRESS = re.compile(r"https://(?P<host>[\w.-]+)/(?P<name>[\w.-]+/[\w.-]+)")
GITHUB = "github.com"


def require_address(app: Sphinx, config: Config) -> None:
    """Require the address of a repository, or none.

    Raises:
        ConfigError: the given address is not valid.
    """
    given = config.course_repository
    if given and not ADDRESS.fullmatch(given):
        raise ConfigError(
            f"course_repository={given!r} in _config.yml is not valid. Give an address like "
            "https://github.com/OWNER/NAME, without a slash at its end, or leave it empty."
        )


def codespace(repository: str) -> str:
    """Return Markdown that offers a codespace of a repository on GitHub, nothing for another one.

    Args:
        repository: its address, empty if none is configured.
    """
    found = ADDRESS.fullmatch(repository)
    if found is None or found["host"] != GITHUB:
        return ""
    return (
        f"Without Linux: [open the course in a codespace](https://codespaces.new/{found['name']}), "
        "a virtual machine at GitHub with the container of the labs. It needs an account there. We "
        "have not tried it; the page “Running a lab” has the steps."
    )
