"""How much friction decides: the same test with five coefficients, side by side."""

from concurrent.futures import ThreadPoolExecutor

import condyle


def mass_loss_mg(case: condyle.Case) -> float:
    return condyle.run(case, fields=False).mass_loss_mg


def main() -> None:
    case = condyle.Case.from_dict({"march": {"updates": 10}, "accuracy": {"estimate": False}})
    frictions = [0.01, 0.04, 0.07, 0.10, 0.13]
    with ThreadPoolExecutor(2) as pool:
        masses = pool.map(mass_loss_mg, [case.replace({"contact.friction": friction}) for friction in frictions])
    for friction, mass in zip(frictions, masses):
        print(f"friction {friction:.2f}: {mass:6.2f} mg")


if __name__ == "__main__":
    main()
