#!/usr/bin/env python3
"""Runs a case of two STL meshes with the defects of other programs' exports put in, beside the clean one.

with_defects.py CONDYLE CASE [--seed N] [--set KEY=VALUE ...]

Prints a table: what was put into which body, the exit code, the mass, its difference from that of the clean run, and what
condyle said of it. Ends with 1 if a run ends well with a mass more than 0.5 % off.
"""

import argparse
import json
import random
import struct
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

MAX_PERCENT = 0.5


def read_stl(path):
    data = Path(path).read_bytes()
    count = struct.unpack_from("<I", data, 80)[0]
    rows = (struct.unpack_from("<12f", data, 84 + 50 * i) for i in range(count))
    return [[tuple(row[3 + 3 * k : 6 + 3 * k]) for k in range(3)] for row in rows]


def write_stl(path, triangles):
    """Text, with all digits: single precision would round away what is put in."""
    with open(path, "w", encoding="ascii") as out:
        out.write("solid\n")
        for triangle in triangles:
            corners = "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in triangle)
            out.write(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
        out.write("endsolid\n")


def turned(triangles, by):
    """The same with the axes of the file named anew, round and round, which keeps it right-handed."""
    return [[corner[by:] + corner[:by] for corner in triangle] for triangle in triangles]


def mix(a, b, share):
    return tuple(p + (q - p) * share for p, q in zip(a, b))


def middle(triangle):
    return tuple(sum(corner[k] for corner in triangle) / 3 for k in range(3))


def normal(triangle):
    a, b, c = triangle
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = sum(x * x for x in n) ** 0.5 or 1.0
    return [x / length for x in n]


class Defects:
    """Each takes triangles in metres, y up, and gives them with one kind of defect."""

    def __init__(self, chance, is_insert):
        self.chance = chance
        self.is_insert = is_insert

    def far_from_contact(self, triangles):
        """Triangles of the backside of an insert, or of the inner side of a femur."""
        low = min(corner[1] for t in triangles for corner in t)
        if self.is_insert:
            return [i for i, t in enumerate(triangles) if normal(t)[1] < -0.9 and middle(t)[1] < low + 1e-3]
        return [i for i, t in enumerate(triangles) if normal(t)[1] > 0.9 and 6e-3 < middle(t)[1] - low < 15e-3]

    def noise(self, triangles, by):
        return [[tuple(x + self.chance.uniform(-by, by) for x in corner) for corner in t] for t in triangles]

    def noise_1e_6_mm(self, triangles):
        return self.noise(triangles, 1e-9)

    def noise_1e_3_mm(self, triangles):
        return self.noise(triangles, 1e-6)

    def doubled_faces(self, triangles):
        return triangles + [[t[1], t[0], t[2]] for t in self.chance.sample(triangles, 300)]

    def t_junctions(self, triangles):
        found = list(triangles)
        for i in self.chance.sample(range(len(triangles)), 200):
            a, b, c = triangles[i]
            at = mix(a, b, self.chance.uniform(0.2, 0.8))
            found[i] = [a, at, c]
            found.append([at, b, c])
        return found

    def slivers(self, triangles):
        """Edges cut a hundred-thousandth of their length from an end, on both sides."""
        of_edge = {}
        for i, t in enumerate(triangles):
            for k in range(3):
                of_edge.setdefault(frozenset((t[k], t[(k + 1) % 3])), []).append(i)
        found, touched = list(triangles), set()
        for edge in self.chance.sample([edge for edge, on in of_edge.items() if len(on) == 2], 200):
            on = of_edge[edge]
            if touched & set(on):
                continue
            touched |= set(on)
            a, b = edge
            at = mix(a, b, 1e-5)
            for i in on:
                found[i] = [at if corner == a else corner for corner in triangles[i]]
                found.append([at if corner == b else corner for corner in triangles[i]])
        return found

    def inner_walls(self, triangles):
        inward = 2e-3 if self.is_insert else -2e-3
        walls = []
        for i in self.chance.sample(self.far_from_contact(triangles), 20):
            a, b, _ = triangles[i]
            x, y, z = mix(a, b, 0.5)
            walls.append([a, b, (x, y + inward, z)])
        return triangles + walls

    def holes_away_from_contact(self, triangles):
        gone = set()
        for i in self.chance.sample(self.far_from_contact(triangles), 8):
            corners = set(triangles[i])
            gone |= {k for k in self.far_from_contact(triangles) if corners & set(triangles[k])}
        return [t for i, t in enumerate(triangles) if i not in gone]

    def crossing_away_from_contact(self, triangles):
        """A bar through the body, away from contact."""
        i = self.chance.choice(self.far_from_contact(triangles))
        x, y, z = middle(triangles[i])
        return triangles + box((x - 1e-3, y - 1.5e-3, z - 1e-3), (x + 1e-3, y + 1.5e-3, z + 1e-3))

    def hole_under_contact(self, triangles):
        low = min(corner[1] for t in triangles for corner in t)
        facing = [
            i
            for i, t in enumerate(triangles)
            if (normal(t)[1] > 0.98) == self.is_insert
            and abs(normal(t)[1]) > 0.98
            and (middle(t)[1] > low + 4e-3 if self.is_insert else middle(t)[1] < low + 1e-3)
        ]
        corners = set(triangles[self.chance.choice(facing)])
        return [t for t in triangles if not corners & set(t)]


def box(low, high):
    def corner(i):
        return tuple((low, high)[i >> axis & 1][axis] for axis in range(3))

    quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
    return [[corner(i) for i in t] for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def on_a_tray(triangles):
    """A tray with a stem below and around the insert, and the height to cut at, mm."""
    lows = [min(c[k] for t in triangles for c in t) for k in range(3)]
    highs = [max(c[k] for t in triangles for c in t) for k in range(3)]
    x, z = (lows[0] + highs[0]) / 2, (lows[2] + highs[2]) / 2
    tray = box((lows[0] - 2e-3, lows[1] - 4e-3, lows[2] - 2e-3), (highs[0] + 2e-3, lows[1] + 5e-5, highs[2] + 2e-3))
    stem = box((x - 7e-3, lows[1] - 40e-3, z - 7e-3), (x + 7e-3, lows[1] - 3e-3, z + 7e-3))
    return triangles + tray + stem, (lows[1] + 1e-4) * 1e3


KINDS = [
    "noise_1e_6_mm",
    "noise_1e_3_mm",
    "doubled_faces",
    "t_junctions",
    "slivers",
    "inner_walls",
    "holes_away_from_contact",
    "crossing_away_from_contact",
    "hole_under_contact",
]


class Runs:
    def __init__(self, condyle, case, sets, folder):
        self.condyle, self.sets, self.folder = condyle, sets, folder
        text = case.read_text()
        keys = tomllib.loads(text)
        self.meshes = {body: (case.parent / keys[body]["file"]).resolve() for body in ("femur", "insert")}
        self.text = text
        # From the file's axes to those with the second one up.
        self.turns = {body: (keys[body]["axes"].index("superior") - 1) % 3 for body in self.meshes}
        for body, path in self.meshes.items():
            self.text = self.text.replace(f'"{keys[body]["file"]}"', f'"{path}"')

    def run(self, body=None, triangles=None, more=()):
        text = self.text
        if triangles:
            path = self.folder / f"{body}.stl"
            write_stl(path, turned(triangles, -self.turns[body] % 3))
            text = text.replace(str(self.meshes[body]), str(path))
        case, out = self.folder / "case.toml", self.folder / "out"
        case.write_text(text)
        sets = [word for one in (*self.sets, *more) for word in ("--set", one)]
        done = subprocess.run(
            [self.condyle, "run", str(case), "--force", "--out", str(out), *sets], capture_output=True, text=True, check=False
        )
        if done.returncode != 0:
            return done.returncode, None, done.stderr
        summary = json.loads((out / "summary.json").read_text())
        return 0, summary["mass_loss_mg"], "; ".join(summary["warnings"])


def main():
    words = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    words.add_argument("condyle")
    words.add_argument("case", type=Path)
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--set", dest="sets", action="append", default=[])
    asked = words.parse_args()
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(asked.condyle, asked.case, asked.sets, Path(folder))
        _, clean, _ = runs.run()
        print(f"`{asked.case}`, clean: {clean:.4f} mg\n")
        print("| body | defects | exit | mass, mg | off | said |\n| --- | --- | --- | --- | --- | --- |")
        bodies = {body: turned(read_stl(path), runs.turns[body]) for body, path in runs.meshes.items()}
        tray, height = on_a_tray(bodies["insert"])
        todo = [(body, kind, None) for body in bodies for kind in KINDS] + [("insert", "on a tray, cut", height)]
        for body, kind, clip in todo:
            defects = Defects(random.Random(asked.seed), body == "insert")
            triangles = tray if clip else getattr(defects, kind)(bodies[body])
            code, mass, said = runs.run(body, triangles, [f"insert.clip_below_mm={clip:.4f}"] if clip else ())
            off = (mass / clean - 1) * 100 if mass else 0.0
            wrong += abs(off) > MAX_PERCENT
            shown = " ".join(said.replace(f"{folder}/", "").split())[:400].replace("|", "/")
            numbers = f"{mass:.4f} | {off:+.3f} %" if mass else " | "
            print(f"| {body} | {kind.replace('_', ' ')} | {code} | {numbers} | {shown} |", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
