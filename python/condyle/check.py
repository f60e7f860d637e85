"""The facts about a case that are known before it runs."""

from __future__ import annotations

from typing import Any, NamedTuple

__all__ = ["Check"]


class Check(NamedTuple):
    """The facts of ``condyle check``; a notebook displays the picture of both bodies."""

    facts: dict[str, Any]
    """Bodies, the settled femur, and time and memory of a run; units are in the names."""
    picture_svg: str
    """A picture of both bodies from three sides."""

    @property
    def warnings(self) -> list[str]:
        """Repairs and doubtful settings."""
        return self.facts["warnings"]

    def _repr_svg_(self) -> str:
        return self.picture_svg
