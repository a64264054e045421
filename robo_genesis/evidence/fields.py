"""The types of the fields of a bundle's JSON files: bounded texts, digests, strict records."""

from functools import lru_cache
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from robo_genesis.core.text import BLANK, LINE_LIMIT

Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
RunId = Annotated[str, Field(pattern="^[0-9a-f]{32}$")]
Index = Annotated[int, Field(ge=0, lt=2**31)]
Timestamp = Annotated[
    str, Field(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d{1,9})?Z$")
]


def _plain(limit: int, other: str = "") -> AfterValidator:
    """Return a check of length and characters; a page or a terminal may show the text."""

    @lru_cache(maxsize=1024)  # most texts of a bundle are labels that occur many times
    def check(text: str) -> str:
        if len(text) > limit:
            raise ValueError(f"expected at most {limit} characters, found {len(text)}")
        if text.isprintable():
            return text
        odd = next((c for c in text if not c.isprintable() and c not in other), None)
        if odd is not None:
            raise ValueError(
                f"expected one line without control characters, found {odd!r}"
            )
        return text

    return AfterValidator(check)


Line = Annotated[str, _plain(200)]  # A name, version or unit
LongLine = Annotated[str, _plain(2000)]  # A command or a path

# A warning of the engine, which may have several lines.
Message = Annotated[str, _plain(LINE_LIMIT, BLANK)]


Found = bool | int | float | LongLine | None  # A value that a check found


class Strict(BaseModel):
    """A frozen record that refuses unknown fields and converts no types."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, strict=True, allow_inf_nan=False
    )
