"""Which of two inserts wears less under the same scatter of friction and load, and how sure that is."""

from concurrent.futures import ThreadPoolExecutor

import condyle


def main() -> None:
    case = condyle.Case.from_dict({"march": {"updates": 1}, "insert": {"edge_mm": 3.0}})
    study = condyle.Study.from_dict(
        {
            "design": {"kind": "sobol", "size": 8},
            "vary": [
                {"key": "contact.friction", "low": 0.04, "high": 0.1},
                {"key": "machine.axial_force.scale", "distribution": "normal", "standard_deviation": 0.02},
            ],
            "alternative": [
                {"name": "flat", "set": ["insert.sagittal_radius_mm=70"]},
                {"name": "dished", "set": ["insert.sagittal_radius_mm=45"]},
            ],
        },
        case=case,
    )
    # Any executor will do, such as that of a Dask client: study.run(..., client=client).
    with ThreadPoolExecutor(2) as executor:
        result = study.run("conformity", executor=executor)
    best, other = result.answers["ranking"]["designs"]
    print(f"{best['name']} {best['mean']:.1f} mg, {other['name']} {other['mean']:.1f} mg")
    print(f"{best['name']} wears less in {best['beats'][1]:.0%} of the tests; see {result.folder / 'study.html'}")


if __name__ == "__main__":
    main()
