"""Cases: the inputs of a wear test."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _condyle
from ._ply import ply_bytes
from ._toml import document, value_text
from .check import Check
from .errors import BadInput

if TYPE_CHECKING:
    from typing import TypeAlias

    from numpy.typing import ArrayLike

__all__ = ["Case", "CaseLike"]


class Case:
    """The checked inputs of a wear test, with all defaults.

    A case is immutable; :meth:`replace` returns another. Two cases are equal, and have equal hashes, if their values and
    the bytes of their meshes are equal, wherever the files are. Cases can be pickled.

    >>> case = Case.from_dict({"contact": {"friction": 0.05}})
    >>> lower = case.replace({"contact.friction": 0.04, "march.updates": 5})
    >>> lower["contact.friction"], lower == case
    (0.04, False)
    >>> lower.replace({"contact.friction": 0.05, "march.updates": 10}) == case
    True
    """

    __slots__ = ("_base", "_changes", "_files", "_hash", "_path", "_raw", "_text")

    def __init__(
        self,
        path: str,
        text: str,
        base: str,
        files: Mapping[str, bytes] | None = None,
        changes: tuple[str, ...] = (),
    ) -> None:
        """Use :meth:`read`, :meth:`from_text` or :meth:`from_dict`."""
        self._path, self._text, self._base, self._changes = path, text, base, changes
        self._files = dict(files or {})
        self._raw = _condyle.RawCase(path, text, base, self._files, changes)
        self._hash: str | None = None

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Case:
        """Reads the case file at ``path``; paths in it are relative to its folder.

        Raises:
            BadInput: all problems of the file, with their places.
        """
        return cls(os.fspath(path), _condyle.RawCase.read_text(path), os.getcwd())

    @classmethod
    def from_text(cls, text: str, *, folder: str | os.PathLike[str] = ".", name: str = "case") -> Case:
        """Reads a case from TOML text; paths in it are relative to ``folder``, and messages call it ``name``.

        >>> Case.from_text("[march]\\nupdates = 5")["march.updates"]
        5
        """
        return cls(name, text, os.path.abspath(folder))

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], *, folder: str | os.PathLike[str] = ".") -> Case:
        """Creates a case from nested dictionaries as returned by :meth:`to_dict`; entries that are ``None`` are omitted."""
        return cls.from_text(document(tables), folder=folder, name="dictionary")

    def replace(self, changes: Mapping[str, Any]) -> Case:
        """The case with other values of some keys, as ``condyle run --set`` accepts them.

        Args:
            changes: a value for each key; a key is a dotted path such as ``"contact.friction"``, or its last word if
                that is unique. A new wear law replaces the law of the case and all its constants.

        Raises:
            BadInput: an unknown key, or a value outside its range.
        """
        law, kept = changes.get("wear.law"), self._changes
        if law is not None and law != self["wear.law"]:
            kept = self._changes_outside("wear")
        written = tuple(f"{key}={value_text(value)}" for key, value in changes.items())
        return Case(self._path, self._text, self._base, self._files, kept + written)

    def with_femur(self, vertices: ArrayLike, triangles: ArrayLike, **keys: Any) -> Case:
        """The case with a femoral component of triangles.

        Args:
            vertices: positions, shape (n, 3), in the unit and axes of the keys ``length_unit`` and ``axes``; by default
                mm, x anterior, y superior, z to the right.
            triangles: vertex numbers from 0, shape (m, 3), anticlockwise seen from outside.
            **keys: other keys of ``[femur]``, such as ``start_mm``; those of the present femur are dropped.
        """
        return self._with_body("femur", vertices, triangles, keys)

    def with_insert(self, vertices: ArrayLike, triangles: ArrayLike, **keys: Any) -> Case:
        """The case with an insert of triangles: closed, or an open articulating surface with ``thickness_mm``.

        Args:
            vertices: positions, shape (n, 3), as for :meth:`with_femur`.
            triangles: vertex numbers from 0, shape (m, 3), anticlockwise seen from outside.
            **keys: other keys of ``[insert]``, such as ``edge_mm``; those of the present insert are dropped.
        """
        return self._with_body("insert", vertices, triangles, keys)

    def check(self, *, threads: int = 1) -> Check:
        """Prepares a run up to its first cycle: reads the meshes and settles the femur on the insert.

        >>> check = Case.from_text("").check()
        >>> check.facts["insert"]["hexahedra"]
        12144

        Raises:
            BadInput: unusable bodies.
            NotSolved: a femur that does not settle.
        """
        facts, picture_svg = self._raw.preview(threads)
        return Check(json.loads(facts), picture_svg)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the case with all defaults to ``path``, and bodies given as arrays as .ply files next to it."""
        target = Path(path).absolute()
        text = self.written_in(target.parent)._raw.toml_in(target.parent)
        target.write_text(text, encoding="utf-8")

    def written_in(self, folder: str | os.PathLike[str]) -> Case:
        """Writes bodies given as arrays into ``folder`` as .ply files, and returns the case that names these files."""
        if not self._files:
            return self
        text = self._text
        for name, data in self._files.items():
            file = Path(folder).absolute() / Path(name).name
            file.write_bytes(data)
            text = text.replace(value_text(name), value_text(str(file)))
        return Case(self._path, text, self._base, None, self._changes)

    @property
    def text(self) -> str:
        """The case as run, as TOML with all defaults and with waveforms as points."""
        return self._raw.toml()

    def to_dict(self) -> dict[str, Any]:
        """The case as run, as nested dictionaries."""
        return json.loads(self._raw.json())

    def __getitem__(self, key: str) -> Any:
        """The value of the key at a dotted path, such as ``"activity.stairs.share"``; the unit is in the name."""
        value: Any = self.to_dict()
        for name in key.split("."):
            if isinstance(value, list):
                value = {one["name"]: one for one in value if isinstance(one, dict)}
            if not isinstance(value, dict) or name not in value:
                raise KeyError(key)
            value = value[name]
        return value

    def __contains__(self, key: str) -> bool:
        try:
            self[key]
        except KeyError:
            return False
        return True

    __iter__ = None  # type: ignore[assignment]

    @property
    def inputs_blake3(self) -> str:
        """The hash of the case and of the bytes of its meshes, as in ``summary.json``."""
        if self._hash is None:
            self._hash = self._raw.inputs_blake3()
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Case) and self.inputs_blake3 == other.inputs_blake3

    def __hash__(self) -> int:
        return hash(self.inputs_blake3)

    def __repr__(self) -> str:
        return f"<condyle.Case {self['title']!r}, {self._path}>"

    def _repr_html_(self) -> str:
        return f"<details><summary>{escape(repr(self))}</summary><pre>{escape(self.text)}</pre></details>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Case, (self._path, self._text, self._base, self._files, self._changes)

    def _with_body(self, body: str, vertices: ArrayLike, triangles: ArrayLike, keys: dict[str, Any]) -> Case:
        data = ply_bytes(vertices, triangles, body)
        # Named by content, so that equal bodies give equal cases; no folder of a disk has this name.
        name = f"/arrays/{body}-{hashlib.blake2b(data, digest_size=6).hexdigest()}.ply"
        table = document({"shape": "mesh", "file": name, **keys})
        text = _condyle.with_table(self._text, body, table)
        files = {file: kept for file, kept in self._files.items() if file in text}
        return Case(self._path, text, self._base, {**files, name: data}, self._changes_outside(body))

    def _changes_outside(self, table: str) -> tuple[str, ...]:
        """The changes without those of ``table`` and its keys."""
        own = [table, *self[table]]

        def is_outside(change: str) -> bool:
            first, _, rest = change.partition("=")[0].partition(".")
            # A key without its table may also lack its unit.
            return first != table if rest else not any(f"{name}_".startswith(f"{first}_") for name in own)

        return tuple(filter(is_outside, self._changes))

    @property
    def compiled(self) -> _condyle.RawCase:
        """The compiled case, for use in the package."""
        return self._raw

    @property
    def file(self) -> tuple[str, str]:
        """Path and text of a file with this case, for use in the package: its own text, or the case as run if it was changed."""
        if not self._changes:
            return os.path.join(self._base, self._path), self._text
        text = self.text
        return f"/cases/{hashlib.blake2b(text.encode(), digest_size=6).hexdigest()}.toml", text

    def has_processed(self, waveform: str) -> bool:
        """True if a waveform of :attr:`file`, at a dotted path, has its scale, offset or low pass applied, for use in the package.

        Raises:
            BadInput: the case cannot process it, such as a joint of a preset.
        """
        if not self._changes or waveform not in self:
            return False
        shape = f"{waveform}.interpolation"
        # A low pass makes a spline of any interpolation.
        if self.replace({shape: "half-cosine"})[shape] == "spline":
            return True
        try:
            return self.replace({f"{waveform}.scale": 1.0, f"{waveform}.offset": 0.0}) != self
        except BadInput:  # They convert its values from another unit: without them, it would stay as it is.
            return True

    @property
    def arrays(self) -> dict[str, bytes]:
        """Bodies given as arrays, as .ply files by their names in the case, for use in the package."""
        return dict(self._files)

    @property
    def has_arrays(self) -> bool:
        """True if a body was given as arrays and is not in a file yet."""
        return bool(self._files)


if TYPE_CHECKING:
    CaseLike: TypeAlias = Case | str | os.PathLike[str] | Mapping[str, Any]
    """A case, its path, its text, or nested dictionaries."""
else:
    CaseLike = "CaseLike"


def case_of(case: CaseLike) -> Case:
    """``case`` as a :class:`Case`. A string is TOML if it has line breaks, or a ``=`` and no file has this name; otherwise a path."""
    if isinstance(case, Case):
        return case
    if isinstance(case, Mapping):
        return Case.from_dict(case)
    if isinstance(case, str) and ("\n" in case or ("=" in case and not os.path.exists(case))):
        return Case.from_text(case)
    return Case.read(case)
