"""Pydantic's verdict on a document, said the way a colleague would."""

from __future__ import annotations

from collections.abc import Mapping
from types import UnionType
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, Tag, ValidationError

from boresight.errors import did_you_mean
from boresight.files.composing import KeyPath
from boresight.files.documents import Document
from boresight.files.problems import LISTED, Problems, listed, shown

Schema = TypeVar("Schema", bound=BaseModel)

_EXPECTED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "finite_number": "a finite number",
    "string_type": "text (put it in quotes if it looks like a number)",
    "list_type": "a list: [first, second]",
    "dict_type": "a block of names with their keys",
    "greater_than": "a number above {gt:g}",
    "greater_than_equal": "a number of at least {ge:g}",
    "less_than_equal": "a number of at most {le:g}",
    "too_short": "a list of at least {min_length}",
    "too_long": "a list of at most {max_length}",
    "expected": "{what}",
}
"""What was expected, by pydantic's type of error; the braces are filled from its context."""


def validated(document: Document, schema: type[Schema]) -> Schema:
    """Returns the document's data as a model.

    Raises:
        InputError: everything that is wrong with it, a sentence each.
    """
    try:
        return schema.model_validate(document.data)
    except ValidationError as error:
        problems = Problems()
        faults = error.errors(include_url=False)
        problems.extend(_sentence(document, schema, fault) for fault in faults[:LISTED])
        problems.extend("" for _ in faults[LISTED:])  # these are only counted, so they need no words
        problems.raise_if_any()
        raise


def _sentence(document: Document, schema: type[BaseModel], fault: Mapping[str, Any]) -> str:
    located: KeyPath = tuple(part for part in fault["loc"] if part != "[key]")
    where = _without_tags(document, located)
    kind, given, context = fault["type"], fault["input"], fault.get("ctx", {})
    while kind not in ("missing", "extra_forbidden") and where not in document.lines:
        where = where[:-1]  # a short form such as `robot: robot.yaml` has no keys of its own
    place = document.at(where)
    if kind == "extra_forbidden":
        keys = _model_at(schema, located[:-1]).model_fields
        return f"{place}unknown key{did_you_mean(str(where[-1])[:60], keys)}; expected one of {listed(keys)}"
    if kind == "missing":
        wanted = _model_at(schema, located[:-1]).model_fields[str(where[-1])].description
        return f"{place}this key is missing; expected {wanted}"
    if kind == "literal_error":
        choices = context["expected"].replace("'", "").replace(" or ", ", ").split(", ")
        near = did_you_mean(given[:60], choices) if isinstance(given, str) else ""
        return f"{place}got {shown(given)}{near}; expected {'one of ' * (len(choices) > 1)}{listed(choices)}"
    if kind == "model_type":
        keys = _model_at(schema, located).model_fields
        return f"{place}got {shown(given)}; expected a block with some of the keys {listed(keys)}"
    # The fallback is pydantic's own sentence: a kind of fault that the schemas do not have today.
    wanted = _EXPECTED[kind].format(**context) if kind in _EXPECTED else fault["msg"]
    return (
        f"{place}expected {wanted}"
        if isinstance(given, dict | BaseModel)
        else f"{place}got {shown(given)}; expected {wanted}"
    )


def _without_tags(document: Document, located: KeyPath) -> KeyPath:
    """Returns a fault's key path without the names that pydantic puts there of which kind of block it is."""
    where: KeyPath = ()
    for place, part in enumerate(located):
        if (*where, part) in document.lines or where not in document.lines or place == len(located) - 1:
            where = (*where, part)
    return where


def _model_at(schema: Any, where: KeyPath) -> Any:
    """Returns the model that describes the block at a key path, which may name kinds of block."""
    for part in where:
        if kinds := _kinds(schema):
            schema = kinds[str(part)]
        elif isinstance(schema, type) and issubclass(schema, BaseModel):
            schema = schema.model_fields[str(part)].annotation
        else:
            schema = get_args(schema)[-1]
        schema = _bare(schema)
    return schema


def _kinds(annotation: Any) -> dict[str, Any]:
    """Returns the models of a block that has several kinds, by kind; empty where it has one."""
    if get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    tagged = [get_args(choice) for choice in get_args(annotation) if get_origin(choice) is Annotated]
    return {str(tag.tag): model for model, *rest in tagged for tag in rest if isinstance(tag, Tag)}


def _bare(annotation: Any) -> Any:
    """Returns an annotation without `Annotated` and `| None`."""
    while get_origin(annotation) in (Annotated, Union, UnionType) and not _kinds(annotation):
        annotation = get_args(annotation)[0]
    return annotation
