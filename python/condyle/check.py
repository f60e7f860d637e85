"""What a case comes to before it runs."""

from __future__ import annotations

from typing import Any, NamedTuple

__all__ = ["Check"]


class Check(NamedTuple):
    """What a case comes to before it runs, as ``condyle check`` says it; in a notebook, a picture of both bodies."""

    facts: dict[str, Any]
    """Bodies, where the femur settles, and what a run will need; units are in the names."""
    picture_svg: str
    """Both bodies from three sides."""

    @property
    def warnings(self) -> list[str]:
        """What was put right or looks doubtful."""
        return self.facts["warnings"]

    def _repr_svg_(self) -> str:
        return self.picture_svg
