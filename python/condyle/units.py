"""Units of quantities, from the ends of their names."""

from __future__ import annotations

__all__ = ["unit_of"]

_UNITS = {
    "mm": "mm",
    "mm2": "mm2",
    "mm3": "mm3",
    "mg": "mg",
    "mpa": "MPa",
    "n": "N",
    "nm": "N m",
    "deg": "degree",
    "s": "s",
    "hz": "Hz",
    "percent": "%",
    "cycles": "1",
}


def unit_of(name: str) -> str:
    """The unit at the end of a name; empty for a pure number.

    >>> unit_of("mass_loss_mg"), unit_of("peak_pressure_mpa"), unit_of("cross_shear")
    ('mg', 'MPa', '')
    """
    return _UNITS.get(name.rsplit("_", 1)[-1], "")
