"""Holds `condyle check` and `condyle run` against every pairing of the 24 orientations of two bodies.

Usage: orientations.py CONDYLE FOLDER, where FOLDER contains femur.stl and insert.stl of the generic pair.
Each body is judged by its own shape, so it is checked in its 24 orientations with the other one in its right orientation. A pairing
is detected if `condyle check` names the `axes` line to write for one of its bodies. Wrong pairings that are not detected are run,
and their mass is compared with that of the right pairing.
"""

import itertools
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

WORDS = ["anterior", "posterior", "superior", "inferior", "right", "left"]
VECTORS = {
    "anterior": (1, 0, 0),
    "posterior": (-1, 0, 0),
    "superior": (0, 1, 0),
    "inferior": (0, -1, 0),
    "right": (0, 0, 1),
    "left": (0, 0, -1),
}
DATA = Path("../shared/data").resolve()
# Name, femur, insert, unit, axes of both, where the femur starts.
IMPLANTS = [
    (
        "dm-knee",
        DATA / "dm-knee/femoral-component.stl",
        DATA / "dm-knee/tibial-insert.stl",
        "m",
        ("posterior", "superior", "left"),
        [7.4, 1.0],
    ),
    (
        "cams-knee",
        DATA / "cams-knee/femur_implant_Mplus_JWI_meters_reduce.stl",
        DATA / "cams-knee/tibia_inlay_JWI_meters.stl",
        "m",
        ("right", "anterior", "superior"),
        [-10.8, 0.1],
    ),
    ("generic", None, None, "mm", ("anterior", "superior", "right"), [-7.3, 0.0]),
]
# A coarser insert, which halves the time of a check and does not affect the detection.
CHECKED = "edge_mm = 3.0\nlayers = 1\n"


def determinant(words):
    a, b, c = (VECTORS[word] for word in words)
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])


def orientations():
    return [words for words in itertools.permutations(WORDS, 3) if determinant(words) == 1]


def case(implant, femur_axes, insert_axes, mesh):
    _, femur, insert, unit, _, start = implant
    return (
        f'[femur]\nshape = "mesh"\nfile = "{femur}"\nlength_unit = "{unit}"\n'
        f"axes = {json.dumps(femur_axes)}\nstart_mm = {start}\n"
        f'[insert]\nshape = "mesh"\nfile = "{insert}"\nlength_unit = "{unit}"\n'
        f"axes = {json.dumps(insert_axes)}\n{mesh}"
    )


def checked(condyle, folder, implant, pairing):
    """The detection of a pairing: error, warning, or not."""
    path = folder / f"{implant[0]}-{'-'.join(pairing[0] + pairing[1])}.toml"
    path.write_text(case(implant, *pairing, CHECKED))
    done = subprocess.run([condyle, "check", path], capture_output=True, text=True, check=False)
    path.unlink()
    # A wrapped line continues behind a bar.
    said = " ".join(done.stderr.replace("|", " ").split())
    if "write axes =" not in said:
        return "not"
    return "error" if done.returncode != 0 else "warning"


def detection_of_bodies(condyle, folder, implant):
    """The detection of each body in each orientation, femur and insert."""
    right = implant[4]
    femurs = [(axes, right) for axes in orientations()]
    inserts = [(right, axes) for axes in orientations()]
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        detected = list(threads.map(lambda p: checked(condyle, folder, implant, p), femurs + inserts))
    return dict(zip(orientations(), detected[:24])), dict(zip(orientations(), detected[24:]))


def detection_of_pairing(of_femur, of_insert):
    return next(how for how in ("error", "warning", "not") if how in (of_femur, of_insert))


def mass_mg(condyle, folder, implant, pairing):
    path, out = folder / "run.toml", folder / "out"
    path.write_text(case(implant, *pairing, "") + "[accuracy]\nestimate = false\n")
    command = [condyle, "run", path, "--out", out, "--force", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return json.loads(done.stdout)["mass_loss_mg"] if done.returncode == 0 else None


def row(condyle, folder, implant):
    right = (implant[4], implant[4])
    femur, insert = detection_of_bodies(condyle, folder, implant)
    detected = {(f, i): detection_of_pairing(femur[f], insert[i]) for f in femur for i in insert}
    wrong = [how for pairing, how in detected.items() if pairing != right]
    undetected = [p for p, how in detected.items() if how == "not" and p != right]
    changes = []
    if undetected:
        true_mg = mass_mg(condyle, folder, implant, right)
        masses = [mass_mg(condyle, folder, implant, pairing) for pairing in undetected]
        changes = [100 * (mass / true_mg - 1) for mass in masses if mass is not None]
    largest = max(changes, key=abs, default=None)
    change = "" if largest is None else f"{largest:+.2f} %"
    accused = "no" if detected[right] == "not" else f"yes, {detected[right]}"
    counts = [wrong.count(how) for how in ("error", "warning", "not")]
    cells = [implant[0], len(wrong), *counts, change, accused]
    return "| " + " | ".join(map(str, cells)) + " |"


HEAD = [
    "implant",
    "wrong pairings",
    "detected: error",
    "detected: warning",
    "not detected",
    "effect on the mass",
    "false alarm",
]


def main():
    condyle, folder = sys.argv[1], Path(sys.argv[2])
    print("| " + " | ".join(HEAD) + " |")
    print("| --- " * len(HEAD) + "|")
    for implant in IMPLANTS:
        name, femur, insert, *rest = implant
        generic = (name, femur or folder / "femur.stl", insert or folder / "insert.stl", *rest)
        print(row(condyle, folder, generic), flush=True)


main()
