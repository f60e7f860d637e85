#!/usr/bin/env python3
"""Kills runs, convergence studies and studies at random instants, resumes them until they are done, and compares every byte.

kill_and_resume.py CONDYLE [--kills N] [--seed N]

Prints a table of kills a case. A run that differs from one that nobody stopped is kept, and the exit code is 1.
"""

import argparse
import json
import math
import os
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# Times, and what is made of them; the page says none.
TIMES = ("wall_s",)
# Tests are stored in the order in which they end; the table has that of their numbers.
UNORDERED = ("study.db", "study.db-wal", "study.db-shm")


def sphere(radius, centre_z, steps=36):
    """Triangles of a ball about (0, 0, centre_z), facing outwards."""

    def place(i, j):
        polar, around = math.pi * i / steps, 2 * math.pi * (j % (2 * steps)) / (2 * steps)
        ring = radius * math.sin(polar) if 0 < i < steps else 0.0
        return (ring * math.cos(around), radius * math.cos(polar), centre_z - ring * math.sin(around))

    for i in range(steps):
        for j in range(2 * steps):
            a, b, c, d = place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)
            if i < steps - 1:
                yield a, b, c
            if i > 0:
                yield a, c, d


def write_stl(path, triangles):
    """Binary STL."""
    packed = [struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles]
    path.write_bytes(bytes(80) + struct.pack("<I", len(packed)) + b"".join(packed))


def cases(folder):
    """Names and texts of cases of every model, each of some updates and of some tenths of a second or a few seconds."""
    balls = [triangle for z in (-23.0, 23.0) for triangle in sphere(20.0, z)]
    write_stl(folder / "balls.stl", balls)
    insert = "[insert]\nedge_mm = 2.0\n"
    deformable = '[insert]\nedge_mm = 3.0\nlayers = 2\n[march]\nupdates = 4\n[contact]\nmodel = "deformable"\n'
    waveforms = ("axial_force", "flexion", "ap_force", "ie_torque")
    activities = "".join(
        f'[[activity]]\nname = "{kind}"\nshare = {share}\n'
        + "".join(f'[activity.{waveform}]\nwaveform = "{kind}-like"\n' for waveform in waveforms)
        for kind, share in (("iso", 0.8), ("stairs", 0.2))
    )
    creep = '[creep]\nlaw = "lee-pienkowski"\n'
    return {
        "force": insert + "[march]\nupdates = 12\n",
        "displacement": '[machine]\npreset = "stanmore-displacement"\n' + insert + "[march]\nupdates = 12\n",
        "auto": insert + '[march]\nupdate = "auto"\n',
        "mesh, with cache": '[femur]\nshape = "mesh"\nfile = "balls.stl"\nflexion_axis_mm = [0.0, 0.0]\n'
        + insert
        + "[march]\nupdates = 8\n",
        "explicit": "[insert]\nedge_mm = 1.5\n[march]\ncycles = 1_000_000\nupdates = 4\n[contact]\nfriction = 0.02\n"
        '[time]\nintegrator = "explicit"\nincrements = 100\n',
        "creep, activities": insert + "[march]\nupdates = 6\n" + creep + activities,
        "hip, creep": '[femur]\nshape = "sphere"\nradius_mm = 14.0\n[insert]\nshape = "cup"\nradius_mm = 14.1\nedge_mm = 2.0\n'
        '[machine]\npreset = "iso-14242-1-like"\n[march]\nupdates = 6\n' + creep,
        "deformable": deformable,
        "yields": deformable + '[contact.deformable]\nplasticity = "j2"\n',
        "rests": deformable + '[contact.deformable]\nbackside = "resting"\n',
        "sticks and slips": deformable + '[contact.deformable]\nfriction_model = "stick-slip"\n',
        "deformable, creep, activities": deformable + creep + activities,
    }


def studies(file):
    """Names and texts of studies of the case in `file`: of both kinds whose tests depend on others, and of one that does not."""
    vary = "".join(
        f'[[vary]]\nkey = "{key}"\nlow = {low}\nhigh = {high}\n'
        for key, low, high in (("contact.friction", 0.02, 0.12), ("insert.thickness_mm", 8, 12))
    )
    designs = {
        "study, Sobol": 'kind = "sobol"\nsize = 24',
        "study, search": 'kind = "optimise"\nsize = 24',
        "study, adaptive": 'kind = "adaptive"\nuntil = "mass_loss_mg known to 0.01 %"\nsize = 24',
    }
    return {name: f'case = "{file.name}"\n[design]\n{design}\n{vary}' for name, design in designs.items()}


def trials(folder):
    """Name, file and arguments of everything that is killed."""
    for index, (name, text) in enumerate(cases(folder).items()):
        file = folder / f"case-{index}.toml"
        file.write_text(text)
        yield name, ["run", str(file)], True
    small = folder / "small.toml"
    small.write_text("[insert]\nedge_mm = 3.0\n[march]\nupdates = 4\n")
    yield "converge", ["converge", str(small), "--over", "insert.edge_mm=4,3,2,1.5"], True
    for index, (name, text) in enumerate(studies(small).items()):
        file = folder / f"study-{index}.toml"
        file.write_text(text)
        yield name, ["study", str(file)], False


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(inner) for key, inner in value.items() if key not in TIMES}
    if isinstance(value, list):
        return [without_times(inner) for inner in value]
    return value


def content(folder):
    """Every file of a results folder by its path, without times."""
    paths = [path for path in sorted(folder.rglob("*")) if path.is_file() and path.name not in UNORDERED]
    return {
        str(path.relative_to(folder)): without_times(json.loads(path.read_bytes()))
        if path.suffix == ".json"
        else path.read_bytes()
        for path in paths
    }


class Case:
    def __init__(self, condyle, arguments, has_resume, folder):
        self.condyle, self.arguments, self.has_resume, self.folder = condyle, arguments, has_resume, folder
        self.kills = self.runs = self.resumed = 0
        self.differ = []
        began = time.monotonic()
        whole = folder / "whole"
        self.start(whole, folder / "cache-whole").communicate()
        self.seconds = time.monotonic() - began
        self.expected = content(whole)

    def start(self, out, cache):
        # A study resumes whatever it finds in its folder.
        resume = ["--resume"] if self.has_resume and out.exists() else []
        command = [self.condyle, *self.arguments, "--out", str(out), *resume]
        return subprocess.Popen(
            command, env=dict(os.environ, CONDYLE_CACHE=str(cache)), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )

    def kill_until_done(self, chance, kills):
        """One run, killed up to `kills` times."""
        self.runs += 1
        out = self.folder / f"killed-{self.runs}"
        cache = self.folder / f"cache-{self.runs}"
        left = kills
        while True:
            self.resumed += out.exists()
            process = self.start(out, cache)
            if left > 0:
                time.sleep(chance.uniform(0, self.seconds))
                if process.poll() is None:
                    process.kill()
                    self.kills += 1
                    left -= 1
            _, said = process.communicate()
            if process.returncode == 0:
                break
            if process.returncode != -9:
                self.differ.append(f"run {self.runs} ended with {process.returncode}: {said.decode()[:500]}")
                return
        self.compare(out, cache)

    def compare(self, out, cache):
        found = content(out)
        names = sorted(set(found) | set(self.expected))
        wrong = [name for name in names if found.get(name) != self.expected.get(name)]
        if wrong:
            self.differ.append(f"run {self.runs}, kept in {out}: {', '.join(wrong)}")
        else:
            shutil.rmtree(out)
            shutil.rmtree(cache, ignore_errors=True)


def main():
    words = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    words.add_argument("condyle")
    words.add_argument("--kills", type=int, default=500)
    words.add_argument("--seed", type=int, default=1)
    asked = words.parse_args()
    chance = random.Random(asked.seed)
    folder = Path(tempfile.mkdtemp(prefix="condyle-kills-"))
    print("| case | seconds a run | kills | starts again | runs | that differ |")
    print("| --- | --- | --- | --- | --- | --- |")
    all_trials = list(trials(folder))
    differ, killed = [], 0
    for index, (name, arguments, has_resume) in enumerate(all_trials):
        own = folder / f"{index}"
        own.mkdir()
        case = Case(asked.condyle, arguments, has_resume, own)
        end = asked.kills * (index + 1) // len(all_trials)
        while killed + case.kills < end and not case.differ:
            # A run that is never killed more than a few times ends; one that is killed at once starts over.
            case.kill_until_done(chance, min(12, end - killed - case.kills))
        killed += case.kills
        differ += [f"{name}: {what}" for what in case.differ]
        print(f"| {name} | {case.seconds:.2f} | {case.kills} | {case.resumed} | {case.runs} | {len(case.differ)} |", flush=True)
    print(f"| all | | {killed} | | | {len(differ)} |")
    for what in differ:
        print(what, file=sys.stderr)
    if not differ:
        shutil.rmtree(folder)
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
