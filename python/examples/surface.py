"""The deepest place of the insert, its pressure through the updates, and the motion of the first cycle."""

import condyle


def main() -> None:
    result = condyle.run({"march": {"updates": 4}, "accuracy": {"estimate": False}})
    depth_mm = result.fields["wear_depth_mm"]
    node = int(depth_mm[-1].argmax())
    x, _, z = result.points_mm[0, node]
    print(f"deepest at x {x:.1f}, z {z:.1f} mm: {depth_mm[-1, node]:.3f} mm")
    # The cycle repeated up to each update begins at the update before; the last one is the final cycle.
    cycles = [*result.update_cycles[:-2], result.update_cycles[-1]]
    for done, pressure_mpa in zip(cycles, result.fields["peak_pressure_mpa"][1:, node]):
        print(f"after {done / 1e6:.2f} million cycles: {pressure_mpa:.1f} MPa")
    first = result.kinematics["cycles"] == 0
    ap_mm = result.kinematics["ap_mm"][first]
    print(f"AP from {ap_mm.min():.1f} to {ap_mm.max():.1f} mm")


if __name__ == "__main__":
    main()
