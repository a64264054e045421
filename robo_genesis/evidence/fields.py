"""The types of the fields of a bundle's JSON files: bounded texts, digests, strict records."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from robo_genesis.core.text import BLANK, LINE_LIMIT

Sha256 = Annotated[str, Field(pattern="^[0-9a-f]{64}$")]
RunId = Annotated[str, Field(pattern="^[0-9a-f]{32}$")]
Index = Annotated[int, Field(ge=0, lt=2**31)]
Timestamp = Annotated[str, Field(pattern=r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d{1,9})?Z$")]

PRINTABLE = r" \p{L}\p{M}\p{N}\p{P}\p{S}"
"""Characters that a page or a terminal may show, as a class of a regular expression."""

OF_LINE, OF_MESSAGE = f"^[{PRINTABLE}]*$", f"^[{PRINTABLE}{BLANK}]*$"

Line = Annotated[str, Field(max_length=200, pattern=OF_LINE)]  # A name, version or unit
LongLine = Annotated[str, Field(max_length=2000, pattern=OF_LINE)]  # A command or a path
Message = Annotated[str, Field(max_length=LINE_LIMIT, pattern=OF_MESSAGE)]
"""A warning of the engine, which may have several lines."""

Found = bool | int | float | LongLine | None  # A value that a check found


class Strict(BaseModel):
    """A frozen record that refuses unknown fields and converts no types."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
