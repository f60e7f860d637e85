"""Compares `condyle schema` with the shipped cases, with wrong ones, and with the messages of the command."""

import argparse
import json
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from jsonschema import Draft202012Validator

# Wrong cases, and the place that an editor underlines: the path of the value, or of the table of the key.
WRONG = [
    ("[contact]\nfrictoin = 0.05", "contact"),
    ("[contact]\nmu = 0.05", "contact"),
    ('[contact]\nfriction = "low"', "contact.friction"),
    ("[contact]\nfriction = 7.0", "contact.friction"),
    ('[contact.foundation]\nlaw = "lineer"', "contact.foundation.law"),
    ("[contact.foundation]\ntable = [[0.0, 0.0], [1.0, 1.0]]", "contact.foundation"),
    ('[contact.foundation]\nlaw = "tabulated"', "contact.foundation"),
    ('[contact.foundation]\nlaw = "tabulated"\ntable = [[0.0, 0.0, 1.0]]', "contact.foundation.table.0"),
    ('[insert]\nshape = "mesh"', "insert"),
    ("[insert]\nradius_mm = 24.0", "insert"),
    ("[insert]\nlayers = 2.5", "insert.layers"),
    ("[insert]\nedge_cm = 0.1", "insert"),
    ('[femur]\nshape = "sphere"\ncoronal_radius_mm = 24.0', "femur"),
    ("[femur]\nstart_mm = [1.0]", "femur.start_mm"),
    ("[femur]\nstart_mm = [1.0, 1000.0]", "femur.start_mm"),
    ("[machine]\nie_torque_sign = 2", "machine.ie_torque_sign"),
    ('[machine.springs]\nstiffness_of = "both"', "machine.springs.stiffness_of"),
    ('[machine.freedoms.is]\ndrive = "prescribed"', "machine.freedoms.is.drive"),
    ('[machine.freedoms.yaw]\ndrive = "locked"', "machine.freedoms"),
    ('[machine.flexion]\nwaveform = "iso"', "machine.flexion.waveform"),
    ('[[activity]]\nname = "a"\nshare = 1.0\n[activity.flexion]\nscale = 2.0', "activity.0.flexion"),
    ('[machine.flexion]\nwaveform = "iso-like"\nknots_deg = [[0.0, 1.0]]', "machine.flexion"),
    ('[machine.flexion]\nwaveform = "iso-like"\ncolumn = "a"', "machine.flexion"),
    ("[march]\ncycles = 0", "march.cycles"),
    ('[march]\nupdate = "auto"\nupdates = 3', "march"),
    ('[wear]\nlaw = "archerd"', "wear.law"),
    ('[creep]\nlaw = "lee"', "creep.law"),
    ("[creep]\nrecovering_fraction = 0.5", "creep"),
    ('[activity]\nname = "gait"', "activity"),
    ("[[activity]]\nshare = 1.0", "activity.0"),
    ('[[activity]]\nname = "gait"\nshare = 2.0', "activity.0.share"),
    ('[[activity]]\nname = "gait"\nshare = 1.0\n[activity.flexion]\nwaveform = "iso"', "activity.0.flexion.waveform"),
    ('[time]\nincrements = "200"', "time.increments"),
    ("[accuracy]\nestimate = 1", "accuracy.estimate"),
    ("accuracy = true", "accuracy"),
    ('side = "middle"', "side"),
    ("[geometry]\na = 1", ""),
]

# Unusual cases that are valid.
RIGHT = [
    "[machine.flexion]\nscale = 0.5",
    "",
    "[contact]\nfriction = 0",
    "[insert]\nlayers = 2.0",
    "[machine]\nie_torque_sign = -1.0",
    "[machine.flexion]\nknots_deg = [[0, 0], [50, 60]]\nscale = 0.5",
    '[contact.foundation]\nlaw = "tabulated"\ntable = [[0.0, 0.0], [1.0, 10.0]]',
    '[insert]\nshape = "flat"\nthickness_mm = 8.0\n[femur]\nshape = "sphere"\nradius_mm = 20\n[machine.freedoms.vv]\ndrive = "locked"',
    '[march]\nupdate = "auto"\ndepth_tolerance_fraction = 0.1',
    '[creep]\nlaw = "lee-pienkowski"\nrecovering_fraction = 0.4',
    '[[activity]]\nname = "gait"\nshare = 1\n'
    + "".join(f'[activity.{name}]\nwaveform = "iso-like"\n' for name in ("axial_force", "flexion", "ap_force", "ie_torque")),
]


def wrong_places(validator: Draft202012Validator, text: str) -> list[str]:
    """The paths that the schema rejects in a case."""
    errors = validator.iter_errors(tomllib.loads(text))
    return [".".join(str(step) for step in error.absolute_path) for error in errors]


def checked(condyle: str, arguments: list[str]) -> tuple[int, str]:
    """The exit code and the messages of `condyle check`."""
    done = subprocess.run([condyle, "check", *arguments], capture_output=True, text=True, check=False)
    return done.returncode, done.stderr


def numbers(schema: dict, path: str = "") -> list[tuple[str, dict]]:
    """Every key of a schema with a numeric range, by its dotted path."""
    found = []
    for name, value in schema.get("properties", {}).items():
        found += numbers(value, f"{path}{name}.")
        kinds = value.get("anyOf", [value])
        found += [(path + name, kind) for kind in kinds if "maximum" in kind]
    return found


def beyond(condyle: str, case: str, path: str, kind: dict) -> bool:
    """Returns whether `--set` rejects a value above the range of the schema because of the range."""
    words = [word.strip() for word in kind.get("title", "").split(",") if word]
    table = path.rsplit(".", 1)[0]
    chosen = [f"--set={table}." + words[0].replace(" ", "")] if words else []
    if path.startswith(("machine.ap_motion", "machine.ie_motion")):
        chosen.append("--set=machine.preset=stanmore-displacement")
    if path == "machine.motion_scale":
        chosen.append("--set=machine.preset=pin-on-disc")
    if path.startswith("contact.deformable."):
        chosen.append("--set=contact.model=deformable")
    value = int(kind["maximum"]) + 1 if kind["type"] == "integer" else kind["maximum"] * 1.01 + 1e-9
    code, message = checked(condyle, [case, *chosen, f"--set={path}={value}"])
    return code == 2 and "outside its range" in message


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--condyle", required=True)
    parser.add_argument("cases", nargs="+", type=Path)
    arguments = parser.parse_args()
    condyle = arguments.condyle
    schema = json.loads(subprocess.check_output([condyle, "schema"], text=True))
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    failures = []
    for path in arguments.cases:
        text = path.read_text()
        failures += [f"{path}: the schema rejects {place or 'the top'}" for place in wrong_places(validator, text)]
        if not text.startswith("#:schema "):
            failures.append(f"{path}: its first line does not name the schema")
    with tempfile.TemporaryDirectory() as folder:
        case = str(Path(folder, "case.toml"))
        for text, place in WRONG:
            Path(case).write_text(text)
            if place not in wrong_places(validator, text):
                failures.append(f"{text!r}: {place or 'the top'} is not underlined: {wrong_places(validator, text)}")
            if checked(condyle, [case])[0] != 2:
                failures.append(f"{text!r}: the command accepts it")
        for text in RIGHT:
            Path(case).write_text(text)
            if wrong_places(validator, text):
                failures.append(f"{text!r}: the schema rejects it at {wrong_places(validator, text)}")
            if checked(condyle, [case])[0] != 0:
                failures.append(f"{text!r}: the command rejects it")
        Path(case).write_text("")
        ranges = numbers(schema)
        failures += [
            f"--set {path}: accepted above the range of the schema"
            for path, kind in ranges
            if not beyond(condyle, case, path, kind)
        ]
    print(
        f"{len(arguments.cases)} shipped cases, {len(WRONG)} wrong, {len(RIGHT)} right, "
        f"{len(ranges)} ranges: {len(failures)} failures"
    )
    sys.exit("\n".join(failures) or 0)


if __name__ == "__main__":
    main()
