"""Prints contact force, area and time of an evaluation of OpenSim, Drake and condyle side by side.

python peers.py DATA_FOLDER POSES.csv CONDYLE.csv INSERT.vtk

CONDYLE.csv is what condyle's example contact_at_poses printed, INSERT.vtk what insert_tetrahedra did.
"""

import csv
import statistics
import sys
import tempfile
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np
import opensim_contact

from meshes import read_stl, write_obj

ROUNDS = 11


def condyle(path):
    """Rows of condyle's own output, and those of the second look at the same pose."""
    with open(path, newline="", encoding="ascii") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def table(time):
        return [
            (r["percent"], np.array([r["force_x_n"], r["force_y_n"], r["force_z_n"]]), r["area_mm2"], r[time] / 1e3)
            for r in rows
        ]

    return table("first_us"), table("again_us")


def drake(data, poses, insert_vtk):
    """Drake's rows; none, and a word on why, where it is not installed."""
    try:
        import drake_contact
    except ImportError as error:
        print(f"Drake is left out: {error}", file=sys.stderr)
        return None
    with tempfile.TemporaryDirectory() as folder:
        femur = Path(folder) / "femur.obj"
        write_obj(femur, *read_stl(Path(data) / "femoral-component.stl"))
        tetrahedra = Path(folder) / "insert.vtk"
        tetrahedra.write_text(in_metres(Path(insert_vtk).read_text(encoding="ascii")), encoding="ascii")
        placed = [
            (percent, rotation @ opensim_contact.TO_FILE, origin_mm / 1000.0)
            for percent, rotation, origin_mm in opensim_contact.read_poses(poses)
        ]
        return list(drake_contact.measure(femur, tetrahedra, placed, opensim_contact.PA_PER_M, ROUNDS))


def in_metres(vtk):
    """A legacy VTK file with its points in m instead of mm."""
    lines = vtk.split("\n")
    header = next(i for i, line in enumerate(lines) if line.startswith("POINTS"))
    for i in range(header + 1, header + 1 + int(lines[header].split()[1])):
        lines[i] = " ".join("%.12g" % (float(word) / 1000.0) for word in lines[i].split())
    return "\n".join(lines)


def named(name, package):
    """The name with its version."""
    try:
        return f"{name} {version(package)}"
    except PackageNotFoundError:
        return name


def main():
    data, poses, ours, insert_vtk = sys.argv[1:]
    first, again = condyle(ours)
    programs = {
        named("OpenSim", "opensim"): list(opensim_contact.measure(data, poses, 0, ROUNDS)),
        named("Drake", "drake"): drake(data, poses, insert_vtk),
        "condyle, femur jumped": first,
        "condyle, asked again": again,
    }
    programs = {name: rows for name, rows in programs.items() if rows}
    print("axial force on the insert, N; contact area, mm2; time of one evaluation, ms")
    print("        |", " | ".join(f"{name:>25}" for name in programs))
    for number, (percent, *_) in enumerate(first):
        cells = [f"{-rows[number][1][1]:8.1f} {rows[number][2]:6.1f} {rows[number][3]:9.4f}" for rows in programs.values()]
        print(f"{percent:5.1f} % |", " | ".join(cells))
    for name, rows in programs.items():
        time_ms = statistics.median(row[3] for row in rows)
        force_n = statistics.mean(-row[1][1] for row in rows)
        area_mm2 = statistics.mean(row[2] for row in rows)
        print(f"{name:24} median time {time_ms:9.4f} ms, mean force {force_n:7.1f} N, mean area {area_mm2:6.1f} mm2")


if __name__ == "__main__":
    main()
