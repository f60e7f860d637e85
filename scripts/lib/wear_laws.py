"""The table of docs/src/wear-laws.md: what every law says of some runs. Usage: wear_laws.py NAME=FOLDER..."""

import json
import sys
from pathlib import Path


def outside(law):
    percent = law["outside_of_fit_percent"]
    return "not known" if percent is None else f"{percent:.0f} %"


def rows(name, folder):
    """A row a law: the first moved the surface, the others have their default constants."""
    for law in json.loads((Path(folder) / "summary.json").read_text())["wear_laws"]:
        word = f"`{law['law']}`" + (", of the run" if law["moved_the_surface"] else "")
        mark = " (approximate)" if law["approximate"] else ""
        yield (
            f"| `{name}` | {word}{mark} | {law['mass_loss_mg_per_million_cycles']:.1f} "
            f"| {law['max_depth_mm']:.3f} | {outside(law)} |"
        )


def main():
    print("| case | law | mg a million cycles | deepest, mm | volume outside of its fit |")
    print("| --- | --- | --- | --- | --- |")
    for argument in sys.argv[1:]:
        print("\n".join(rows(*argument.split("=", 1))))


main()
