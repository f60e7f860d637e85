"""The tables of docs/src/wear-laws.md. Usage: wear_laws.py by-law NAME=FOLDER..., or wear_laws.py by-design NAME=FOLDER...

By law, FOLDER contains a run for each law in a folder of its name; that of `archard` also reports the wear by the other laws. By
design, FOLDER is one run.
"""

import json
import sys
from pathlib import Path


def laws(folder):
    return json.loads((folder / "summary.json").read_text())["wear_laws"]


def rate(law):
    return f"{law['mass_loss_mg_per_million_cycles']:.1f}"


def outside(law):
    percent = law["outside_of_fit_percent"]
    return "not known" if percent is None else f"{percent:.0f} %"


def print_row(cells):
    print(f"| {' | '.join(cells)} |")


def print_head(cells):
    print_row(cells)
    print_row(["---"] * len(cells))


def by_law(folders):
    """One row per law: evaluated on the histories of Archard's law, and in a run of its own."""
    print_head(["case", "law", "on Archard's scar, mg/Mc", "on its own, mg/Mc", "deepest, mm", "outside of its fit"])
    for name, folder in folders:
        for compared in laws(folder / "archard"):
            own = laws(folder / compared["law"])[0]
            word = f"`{compared['law']}`" + (" (approximate)" if compared["approximate"] else "")
            print_row([f"`{name}`", word, rate(compared), rate(own), f"{own['max_depth_mm']:.3f}", outside(own)])


def by_design(folders):
    """A row a design, a column a law."""
    words = [law["law"] for law in laws(folders[0][1])]
    print_head(["dish", *(f"`{word}`" for word in words)])
    for name, folder in folders:
        print_row([name, *(rate(law) for law in laws(folder))])


def main():
    table, *given = sys.argv[1:]
    pairs = [argument.split("=", 1) for argument in given]
    {"by-law": by_law, "by-design": by_design}[table]([(name, Path(folder)) for name, folder in pairs])


main()
