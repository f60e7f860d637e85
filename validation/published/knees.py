"""Runs of the two knees: what each law wears where it moves the surface itself, in mg a million cycles."""

import json
import subprocess
from pathlib import Path

ISO = ["machine.axial_force.waveform=iso-like", "machine.frequency_hz=1.0"]
# As ISO 14243-1 of 2009 has them (approximate): with the posterior cruciate ligament, and with neither.
KEPT = ["machine.springs.posterior_n_per_mm=44", "machine.springs.anterior_n_per_mm=9.3"]
GONE = ["machine.springs.posterior_n_per_mm=9.3", "machine.springs.anterior_n_per_mm=9.3"]

KNEES = {
    "generic": {
        "stable": ("stanmore-force", ISO + KEPT),
        "unstable": ("stanmore-force", ISO + GONE),
    },
    "dm": {
        "stable": ("dm-knee", ISO + KEPT),
        "unstable": ("dm-knee", ISO + GONE),
        "measured gait": ("dm-knee-displacement", ISO),
    },
    # The conforming one, as the implant of [reinders2014] is; its contact reaches the rim, and its runs say so.
    "cams": {
        "stable": ("cams-knee", ISO + KEPT),
        "unstable": ("cams-knee", ISO + GONE),
    },
}

# What is changed where a finding asks what a change does, in displacement control.
FLEXION = [["machine.flexion.scale=0.9"], ["machine.flexion.scale=1.1"]]
PLACEMENT = [
    ["insert.posterior_slope_deg=2"],
    ["insert.posterior_slope_deg=-2"],
    ["insert.axial_rotation_deg=2"],
    ["insert.axial_rotation_deg=-2"],
    ["insert.coronal_tilt_deg=1"],
    ["insert.coronal_tilt_deg=-1"],
]
# Name, changes, rule and whether a ratio of wear keeps it.
ALIGNMENTS = [
    (
        "A rotational mismatch of 14 degrees wears more",
        ["insert.axial_rotation_deg=14", "insert.axial_rotation_deg=-14"],
        "more with either knee and sense; in brackets the ratios",
        lambda ratio: ratio > 1.0,
    ),
    (
        "A posterior slope of 10 degrees wears more",
        ["insert.posterior_slope_deg=10"],
        "more with either knee; in brackets the ratios",
        lambda ratio: ratio > 1.0,
    ),
    (
        "A joint line 4 degrees in varus wears less",
        ["insert.coronal_tilt_deg=4"],
        "no more than 1 % more with either knee; in brackets the ratios",
        lambda ratio: ratio < 1.01,
    ),
]
DISHES_MM = [(25, 45), (30, 55), (40, 80), (80, 200)]


class Runs:
    def __init__(self, condyle, folder):
        self.condyle, self.folder = condyle, Path(folder)
        self.done = 0

    def summary(self, case, changes):
        """That of a run of a case with changes."""
        self.done += 1
        out = self.folder / str(self.done)
        sets = [word for change in [*changes, "accuracy.estimate=false"] for word in ("--set", change)]
        command = [self.condyle, "run", f"cases/{case}.toml", *sets, "--out", out]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            raise SystemExit(f"{case} {changes}: {ran.stderr}")
        return json.loads((out / "summary.json").read_text())

    def by_itself(self, case, changes, law):
        own = self.summary(case, [*changes, f"wear.law={law}"])["wear_laws"][0]
        assert own["law"] == law and own["moved_the_surface"]
        return own["mass_loss_mg_per_million_cycles"]

    def beside(self, case, changes):
        """What every law says of the histories of Archard's."""
        return {law["law"]: law["mass_loss_mg_per_million_cycles"] for law in self.summary(case, changes)["wear_laws"]}

    def alone(self, case, changes):
        """Volume that a cycle of each activity wears on its own, in proportion."""
        activities = self.summary(case, changes)["activities"]
        return {own["name"]: own["volume_loss_alone_mm3"] / own["share_of_cycles"] for own in activities}


def rates(runs, laws, knees):
    """By knee, condition and law."""
    return {
        knee: {
            condition: {law: runs.by_itself(case, changes, law) for law in laws}
            for condition, (case, changes) in KNEES[knee].items()
        }
        for knee in knees
    }
