"""The engine's log: what it keeps, and what is left out of it."""

import logging
import re

from robo_genesis.core.project import without_folders


class EngineLog(logging.Handler):
    """Keeps every line that the engine logs, without its colour marks."""

    def __init__(self) -> None:
        super().__init__()
        self.lines: list[tuple[str, str]] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep (level, message)."""
        plain = re.sub("~{1,4}<|>~{1,4}", "", record.getMessage())
        self.lines.append((record.levelname, plain))

    @property
    def warnings(self) -> list[str]:
        """Messages at level WARNING or above, in order."""
        return [text for level, text in self.lines if level not in ("DEBUG", "INFO")]

    def text(self) -> str:
        """Return the log, one `LEVEL message` line each."""
        return "".join(f"{level} {text}\n" for level, text in self.lines)


def remove_private_paths(record: logging.LogRecord) -> bool:
    """Remove the folders of packages, checkout and home from a log line; keep every record."""
    record.msg = without_folders(str(record.msg))
    return True
