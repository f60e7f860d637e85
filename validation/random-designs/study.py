"""Runs random designs, judges each from its files, and writes the table of how they ended.

    study.py CONDYLE DATA OUT [--designs 1000] [--first 0] [--refine-every 10] [--perturb-every 10]

DATA is the folder of the real implants. OUT gets results.csv, a row a design, and results.md; a study that was stopped
continues from its ended.jsonl. Ends with 1 if a design is silently wrong, did not end, or ended in a way that the command does not have.
"""

import argparse
import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path

from designs import design, perturbed, refined, toml
from judge import judge, silent

LONGEST_S = 300
# A refined run may differ from a coarse one by this many stated errors, and by a little more for its own error.
STATED_ERRORS = 1.5
REFINED_RUN_S_OWN_PERCENT = 0.5
# A perturbation of 1e-12 may change a number by this part of it.
MAX_CHANGE_BY_PERTURBATION = 1e-6
GOOD, DOUBTFUL = "good", "good, with a warning"
ENDS = {2: "error: bad input", 3: "error: the physics could not be solved"}


# Checks that say of the stated error, or of the whole answer, that it is not to be believed.
DOUBT_THE_ERROR = (
    "single_update",
    "updates_too_few",
    "updates_overshoot",
    "error_incomplete",
    "cycles_not_repeating",
    "wear_at_rim",
    "pressure_at_rim",
)


@dataclass
class Ended:
    """How one design ended."""

    number: int
    how: str
    message: str = ""
    summary: dict = field(default_factory=dict)
    findings: list = field(default_factory=list)
    silent: list = field(default_factory=list)
    refined_mass_percent: float = None
    refined_depth_percent: float = None
    perturbed_change: float = None

    @property
    def wrong(self):
        return bool(self.silent) or self.how not in (GOOD, DOUBTFUL, *ENDS.values())


def run(condyle, case, folder):
    """Exit code and what was said of one run; None where it did not end in time."""
    path = folder / "case.toml"
    path.write_text(toml(case))
    command = ["nice", "-n", "5", condyle, "run", str(path), "-o", str(folder / "results")]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST_S, check=False)
    except subprocess.TimeoutExpired:
        return None, ""
    return done.returncode, done.stderr


def try_design(condyle, data, number, also_refined, also_perturbed):
    """Runs and judges one design."""
    case = design(number, data)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        code, said = run(condyle, case, folder)
        if code != 0:
            return Ended(number, ENDS.get(code, f"exit code {code}"), _error(said))
        ended = _judged(number, folder / "results")
        if also_refined:
            shutil.rmtree(folder / "results")
            _hold_against_refined(ended, condyle, refined(case), folder)
        if also_perturbed:
            shutil.rmtree(folder / "results", ignore_errors=True)
            _compare_with_perturbed(ended, condyle, perturbed(case), folder)
    return ended


def _judged(number, results):
    summary = json.loads((results / "summary.json").read_text())
    findings = judge(results)
    how = DOUBTFUL if summary["plausibility"] or summary["warnings"] else GOOD
    return Ended(
        number,
        how,
        "",
        summary,
        [finding.what for finding in findings],
        [finding.what for finding in silent(findings, summary)],
    )


def _hold_against_refined(ended, condyle, case, folder):
    """The stated error against what a refined run changes, unless either says that its error is large or unknown."""
    code, _ = run(condyle, case, folder)
    if code != 0:
        return
    finer = json.loads((folder / "results" / "summary.json").read_text())
    said = _said(ended.summary)
    for key, check, found in (
        ("mass_loss_mg", "error_of_mass", "refined_mass_percent"),
        ("max_depth_mm", "error_of_depth", "refined_depth_percent"),
    ):
        doubts = {check, *DOUBT_THE_ERROR}
        if doubts & _said(finer):
            continue
        change = 100 * (finer[key] - ended.summary[key]) / max(ended.summary[key], 1e-12)
        setattr(ended, found, change)
        stated = ended.summary["error"][f"{key.rsplit('_', 1)[0]}_percent"]["total"]
        allowed = STATED_ERRORS * stated + REFINED_RUN_S_OWN_PERCENT
        if abs(change) > allowed and not doubts & said:
            ended.silent.append(f"stated error of {key} {stated:.2g} %, refined {change:+.2g} %")


def _said(summary):
    return {warning["check"] for warning in [*summary["plausibility"], *summary["notes"]]}


def _compare_with_perturbed(ended, condyle, case, folder):
    """The largest change of a number by a perturbation that is far below what anybody can measure."""
    code, said = run(condyle, case, folder)
    if code != 0:
        ended.silent.append(f"not solved with a perturbation of 1e-12: {_error(said)}")
        return
    other = json.loads((folder / "results" / "summary.json").read_text())
    changes = {key: abs(other[key] / ended.summary[key] - 1) for key in NUMBERS if ended.summary.get(key)}
    key = max(changes, key=changes.get)
    ended.perturbed_change = changes[key]
    if changes[key] > MAX_CHANGE_BY_PERTURBATION:
        ended.silent.append(f"a perturbation of 1e-12 changes {key} by {changes[key]:.2g}")


def _error(said):
    """What an error says is wrong: its first sentence, without the box that shows the place."""
    found = re.search(r"^ *(?:error:|[x\u00d7]) (.*(?:\n +[|│] .*)*)", said, re.MULTILINE)
    return re.sub(r"\s*\n +[|│] ", " ", found.group(1)).split("; what was computed")[0] if found else ""


NUMBERS = ["mass_loss_mg", "max_depth_mm", "peak_pressure_mpa", "ap_range_mm", "ie_range_deg"]
COLUMNS = [
    "design",
    "ended",
    *NUMBERS,
    "told",
    "findings",
    "silently_wrong",
    "refined_mass_percent",
    "refined_depth_percent",
    "perturbed_change",
    "message",
]


def row(ended):
    """A row of results.csv."""
    numbers = [ended.summary.get(key) for key in NUMBERS]
    told = " ".join(warning["check"] for warning in ended.summary.get("plausibility", []))
    changes = [ended.refined_mass_percent, ended.refined_depth_percent, ended.perturbed_change]
    return [
        ended.number,
        ended.how,
        *map(_short, numbers),
        told,
        "; ".join(ended.findings),
        "; ".join(ended.silent),
        *map(_short, changes),
        ended.message,
    ]


def _short(value):
    return "" if value is None else f"{value:.4g}"


def table(all_ended):
    """results.md: how the designs ended, and what was found and told."""
    hows = Counter(ended.how for ended in all_ended)
    lines = ["| ended | designs |", "| --- | ---: |"]
    lines += [f"| {how} | {count} |" for how, count in hows.most_common()]
    lines += [f"| **silently wrong** | **{sum(ended.wrong for ended in all_ended)}** |", ""]
    lines += ["| found by the judge | designs | not reported |", "| --- | ---: | ---: |"]
    found = Counter(what for ended in all_ended for what in ended.findings)
    unsaid = Counter(what for ended in all_ended for what in ended.silent)
    lines += [f"| {what} | {count} | {unsaid[what]} |" for what, count in found.most_common()]
    held = [ended for ended in all_ended if ended.refined_mass_percent is not None]
    beyond = sum(any("stated error" in what for what in ended.silent) for ended in held)
    lines += [f"| stated error, compared with a refined run ({len(held)} tried) | {beyond} | {beyond} |"]
    tried = [ended for ended in all_ended if ended.perturbed_change is not None]
    moved = sum(ended.perturbed_change > MAX_CHANGE_BY_PERTURBATION for ended in tried)
    lines += [f"| changed by more than 1e-6 by a perturbation of 1e-12 ({len(tried)} tried) | {moved} | {moved} |", ""]
    lines += ["| reported by condyle | designs |", "| --- | ---: |"]
    told = Counter(warning["check"] for ended in all_ended for warning in ended.summary.get("plausibility", []))
    lines += [f"| `{check}` | {count} |" for check, count in told.most_common()]
    return "\n".join(lines) + "\n"


def read(line):
    return Ended(**json.loads(line))


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("condyle")
    arguments.add_argument("data", type=Path)
    arguments.add_argument("out", type=Path)
    arguments.add_argument("--designs", type=int, default=1000)
    arguments.add_argument("--first", type=int, default=0)
    arguments.add_argument("--refine-every", type=int, default=10)
    arguments.add_argument("--perturb-every", type=int, default=10)
    given = arguments.parse_args()
    numbers = range(given.first, given.first + given.designs)

    def one(number):
        also_refined = number % given.refine_every == 0
        # Not the refined ones: those take long enough.
        also_perturbed = number % given.perturb_every == given.perturb_every - 1
        return try_design(given.condyle, given.data.resolve(), number, also_refined, also_perturbed)

    # Each design is kept when it ends: a study that was stopped continues.
    given.out.mkdir(parents=True, exist_ok=True)
    kept = given.out / "ended.jsonl"
    known = {ended.number: ended for ended in map(read, kept.read_text().splitlines())} if kept.exists() else {}
    with ThreadPoolExecutor(os.cpu_count()) as pool, kept.open("a") as file:
        for ended in pool.map(one, [number for number in numbers if number not in known]):
            file.write(json.dumps(asdict(ended)) + "\n")
            file.flush()
            known[ended.number] = ended
    all_ended = [known[number] for number in numbers]
    with (given.out / "results.csv").open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *map(row, all_ended)])
    (given.out / "results.md").write_text(table(all_ended))
    print(table(all_ended))
    for ended in all_ended:
        if ended.wrong:
            print(f"design {ended.number}: {ended.how}: {'; '.join(ended.silent)} {ended.message}")
    sys.exit(any(ended.wrong for ended in all_ended))


if __name__ == "__main__":
    main()
