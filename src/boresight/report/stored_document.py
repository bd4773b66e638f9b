"""What export and compensate read of a result.json, checked: programs write such files too, and disks damage them."""

from __future__ import annotations

import json
from typing import Annotated, Any, NoReturn

from pydantic import BaseModel, ConfigDict, Field, Strict, ValidationError

from boresight.errors import InputError
from boresight.files.problems import printable, shown
from boresight.files.schemas import Number, Triple
from boresight.files.sources import Source
from boresight.report.document import SCHEMA

_Flag = Annotated[bool, Strict()]
_Text = Annotated[str, Strict()]


class _Part(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True)


class _Verdict(_Part):
    accepted: _Flag
    reasons: list[_Text]


class _Parameter(_Part):
    name: _Text
    nominal: Number | None
    correction: Number | None


class _Frame(_Part):
    xyz: Triple
    rpy: Triple


class _Origin(_Part):
    joint: _Text
    type: _Text
    nominal: _Frame
    identified: _Frame


class _Urdf(_Part):
    origins: list[_Origin]


class _Stored(_Part):
    name: _Text
    verdict: _Verdict
    parameters: list[_Parameter]
    frames: dict[str, _Frame] = Field(default_factory=dict)
    urdf: _Urdf | None = None


def checked_document(source: Source) -> dict[str, Any]:
    """Returns the content of a result.json, the parts that are read of the kinds that they should be.

    Raises:
        InputError: it is not JSON, of another schema, or a number is none.
    """
    try:
        document = json.loads(source.content, parse_constant=_refuse_constant)
    except RecursionError:
        raise InputError(printable(f"{source.name}: not valid JSON: it is nested beyond all measure")) from None
    except ValueError as error:
        raise InputError(printable(f"{source.name}: not valid JSON: {error}")) from None
    schema = document.get("schema") if isinstance(document, dict) else None
    if schema != SCHEMA:
        raise InputError(printable(f"{source.name}: schema {shown(schema)}; expected {SCHEMA}"))
    try:
        _Stored.model_validate(document)
    except ValidationError as error:
        fault = error.errors(include_url=False)[0]
        where = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in fault["loc"]).removeprefix(".")
        given = "is missing" if fault["type"] == "missing" else f"is {shown(fault['input'])}"
        raise InputError(
            printable(f"{source.name}: not a result of this version of Boresight: {where} {given}; calibrate again")
        ) from None
    return {"frames": {}, **document}


def _refuse_constant(word: str) -> NoReturn:
    raise ValueError(f"{word} is no number of JSON")
