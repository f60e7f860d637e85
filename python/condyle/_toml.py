"""Values of Python as TOML."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from .errors import BadInput


def value_text(value: Any) -> str:
    """``value`` as one of TOML, on one line.

    >>> value_text([1, 2.5, True, "a \\"b\\""])
    '[1, 2.5, true, "a \\\\"b\\\\""]'
    """
    value = _plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else str(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        pairs = (f"{key_text(key)} = {value_text(inner)}" for key, inner in value.items() if inner is not None)
        return "{ " + ", ".join(pairs) + " }"
    if isinstance(value, Sequence):
        return "[" + ", ".join(value_text(item) for item in value) + "]"
    raise BadInput(f"{value!r} is no value of a case; give numbers, text, lists, dictionaries or arrays")


def key_text(key: object) -> str:
    """A key as TOML has it."""
    text = str(key)
    is_bare = text.isascii() and text.replace("-", "").replace("_", "").isalnum()
    return text if is_bare else json.dumps(text, ensure_ascii=False)


def document(tables: Mapping[str, Any]) -> str:
    """A whole file from nested dictionaries; what is ``None`` is left out.

    >>> print(document({"title": "A", "contact": {"friction": 0.04}}), end="")
    title = "A"
    [contact]
    friction = 0.04
    """
    return "".join(line + "\n" for line in _lines(tables, ()))


def _lines(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    entries = [(key_text(key), value) for key, value in table.items() if value is not None]
    for key, value in entries:
        if not isinstance(value, Mapping) and not _is_tables(value):
            yield f"{key} = {value_text(value)}"
    for key, value in entries:
        below = (*path, key)
        if isinstance(value, Mapping):
            yield f"[{'.'.join(below)}]"
            yield from _lines(value, below)
        elif _is_tables(value):
            for item in value:
                yield f"[[{'.'.join(below)}]]"
                yield from _lines(item, below)


def _is_tables(value: Any) -> bool:
    is_list = isinstance(value, Sequence) and not isinstance(value, str) and len(value) > 0
    return is_list and all(isinstance(item, Mapping) for item in value)


def _plain(value: Any) -> Any:
    """Numbers and arrays of NumPy, and paths, as what Python itself has."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value.tolist() if hasattr(value, "tolist") else value
