"""Python values as TOML, written by the compiled module, which has a TOML library."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import Any

from . import _condyle
from .errors import BadInput


def value_text(value: Any) -> str:
    """``value`` as a TOML value on one line.

    >>> value_text([1, 2.5, True, "a"])
    '[1, 2.5, true, "a"]'
    """
    return _condyle.toml_value(_json(value))


def document(tables: Mapping[str, Any]) -> str:
    """A TOML file of nested dictionaries, without the entries that are ``None``.

    >>> print(document({"title": "A", "contact": {"friction": 0.04, "table": None}}), end="")
    title = "A"
    <BLANKLINE>
    [contact]
    friction = 0.04
    """
    return _condyle.toml_document(_json(tables))


def _json(value: Any) -> str:
    """``value`` as JSON without ``null``, all of whose values exist in TOML."""
    try:
        return json.dumps(_plain(value), allow_nan=False)
    except (TypeError, ValueError) as error:
        raise BadInput(f"{value!r} is no value of a case; give finite numbers, text, lists, dictionaries or arrays") from error


def _plain(value: Any) -> Any:
    """The same without ``None``, with numbers and arrays of NumPy and paths as types of Python."""
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items() if inner is not None}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [_plain(item) for item in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if value is None:
        raise TypeError("TOML has no null")
    return _plain(value.tolist()) if hasattr(value, "tolist") else value
