"""The distribution of the computing time of a test over the parts of the program, as a table in Markdown.

`perf` samples the program, `addr2line` lists the functions inlined at each address, and the first part whose pattern matches one
of them gets the sample.
"""

import collections
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# The load address of a program without address randomisation.
BASE = 0x555555554000

# Patterns match "function file".
PARTS = [
    (
        "femur: its distance field, once",
        r"condyle-mesh/src/curved_mesh|(closest_point|weighted) .*condyle-mesh/src/triangle|(new|in_cell|with_neighbours) .*geometry/smooth_field|geometry/smooth_field/grid",
    ),
    ("contact: broad phase", r"contact/broad_phase"),
    (
        "contact: samples of the femur",
        r"contact_patch/near_blocks|geometry/(smooth_field|surface_sample|generic_femur|torus|femoral_surface)",
    ),
    ("contact: tangent", r"(tangent|pair|load_change_n|add|total) .*contact_patch/"),
    ("contact: pressure and sliding at the nodes", r"(touched|nodes) .*contact_patch/|(contact_patch|foundation)/peak"),
    ("contact: pressure and friction", r"contact_patch/traction|foundation/mean_overclosure|tractions .*foundation/mod"),
    ("contact: rest", r"contact/(contact_patch|foundation)"),
    (
        "histories and wear",
        r"contact/history|condyle/src/wear/|evolve/(rates|step|step_rules|next_step|comparison_laws|accumulated_error)|record .*machine/simulator",
    ),
    ("surface: normals, areas and averages", r"geometry/(articulating_surface|share|connectivity)"),
    ("mesh: quality and volume", r"condyle-fem/src/"),
    ("insert: made, worn, its thickness", r"geometry/|condyle-mesh/|condyle-case/"),
    ("Newton's method, machine and chain", r"condyle/src/machine/"),
    ("placing and marching", r"evolve/"),
]
REST = "allocation, kernel and rest"
TIMES = 12


def sampled(program, case, folder):
    """The number of samples at each address."""
    data = folder / "perf.data"
    run = ["setarch", "-R", "perf", "record", "-q", "-F", "4000", "-o", data, program, "solve", case, str(TIMES)]
    subprocess.run(run, check=True, stdout=subprocess.DEVNULL)
    script = subprocess.run(["perf", "script", "-i", data, "-F", "ip"], check=True, capture_output=True, text=True)
    return collections.Counter(int(line, 16) - BASE for line in script.stdout.split())


def frames(program, addresses):
    """The functions inlined at every address, each with its file."""
    queries = "\n".join(hex(address) for address in addresses)
    command = ["addr2line", "-a", "-f", "-i", "-C", "-e", program]
    output = subprocess.run(command, input=queries, check=True, capture_output=True, text=True).stdout
    found = {}
    lines = iter(output.splitlines())
    for line in lines:
        if line.startswith("0x"):
            here = found.setdefault(int(line, 16), [])
        else:
            here.append(f"{line} {next(lines, '')}")
    return found


def part_of(functions):
    for part, pattern in PARTS:
        if any(re.search(pattern, function) for function in functions):
            return part
    return REST


def main():
    program, case = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        samples = sampled(program, case, Path(folder))
    inside = [address for address in samples if 0 <= address < 1 << 32]
    found = frames(program, inside)
    shares = collections.Counter()
    for address, count in samples.items():
        shares[part_of(found.get(address, []))] += count
    print("| part | share |\n| --- | ---: |")
    for part, count in shares.most_common():
        print(f"| {part} | {100 * count / samples.total():.1f} % |")


if __name__ == "__main__":
    main()
