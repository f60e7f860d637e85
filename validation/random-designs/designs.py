"""Random designs: generic implants, and real ones misplaced, under random loads and settings.

Half of them are like implants that are built; the ranges of the others are wider than anybody would build, since
what is tried is whether a bad design says that it is bad.
"""

import random

REAL_IMPLANTS = {
    "dm-knee": {
        "femur": "dm-knee/femoral-component.stl",
        "insert": "dm-knee/tibial-insert.stl",
        "axes": ["posterior", "superior", "left"],
        "start_mm": [7.4, 1.0],
    },
    "cams-knee": {
        "femur": "cams-knee/femur_implant_Mplus_JWI_meters_reduce.stl",
        "insert": "cams-knee/tibia_inlay_JWI_meters.stl",
        "axes": ["right", "anterior", "superior"],
        "start_mm": [-8.2, 0.0],
    },
}
# Designs from this number on vary the models too.
FIRST_WITH_MODELS = 1000
# Designs from this number on are hips, discs, ankles and pins.
FIRST_OF_OTHER_JOINTS = 10_000
AXIAL_FORCE = [(0, 0.1), (3, 1.126), (7, 0.7), (13, 1.55), (25, 0.5), (45, 1.45), (60, 0.1), (80, 0.1), (97, 0.194)]
FLEXION_DEG = [(0, 0), (15, 16), (40, 5), (70, 58)]
AP_FORCE = [(0, 0), (5, -0.3), (15, 0.125), (50, -0.19), (60, 0)]
IE_TORQUE = [(0, 0), (10, -0.17), (50, 1.0), (60, 0)]


class Draw(random.Random):
    """The random numbers of one design, of which every second one is sober."""

    def __init__(self, number):
        super().__init__(f"condyle random designs {number}")
        self.sober = number % 2 == 0

    def between(self, low, high):
        """A number of a range; of the middle two fifths of it for a sober design."""
        part = 0.3 + 0.4 * self.random() if self.sober else self.random()
        return round(low + (high - low) * part, 4)

    def factor(self, most):
        """From 1/most to most, its logarithm evenly spread; nearer to 1 for a sober design."""
        return most ** (0.3 * self.uniform(-1, 1) if self.sober else self.uniform(-1, 1))

    def sign(self):
        """1 or -1; 1 for a sober design."""
        return 1 if self.sober else self.choice([1, -1])


def design(number, data):
    """The case of one design, as tables of keys and values; the same for the same number, on any machine."""
    draw = Draw(number)
    case = {"": {"title": f"design {number}"}}
    if number >= FIRST_OF_OTHER_JOINTS:
        _other_joint(draw, case)
        return case
    if draw.random() < 0.1:
        _real_implant(draw, case, data)
    else:
        _generic_implant(draw, case)
    _contact_and_material(draw, case)
    _machine(draw, case)
    _march(draw, case)
    if number >= FIRST_WITH_MODELS:
        _models(draw, case)
    return case


def _other_joint(draw, case):
    """A hip, a disc, an ankle or a pin, with the models of the knees."""
    preset = draw.choice(
        ["iso-14242-1-like", "iso-14242-3-like", "iso-14242-4-like"] * 2
        + ["iso-18192-1-lumbar-like", "iso-18192-1-cervical-like", "iso-22622-like", "pin-on-disc"]
    )
    case["machine"] = {"preset": preset}
    if preset == "pin-on-disc":
        case["femur"] = {"shape": "plane"}
        case["insert"] = {"shape": "pin", "radius_mm": draw.between(1.5, 8), "thickness_mm": draw.between(3, 15)}
    elif preset == "iso-22622-like":
        radius_mm = draw.between(15, 32)
        case["femur"] = {"shape": "cylinder", "radius_mm": radius_mm}
        case["insert"] = {"shape": "trough", "radius_mm": round(radius_mm + 0.5 * draw.factor(10), 4)}
    else:
        is_hip = preset.startswith("iso-14242")
        radius_mm = draw.between(11, 24) if is_hip else draw.between(7, 18)
        case["femur"] = {"shape": "sphere", "radius_mm": radius_mm}
        case["insert"] = {
            "shape": "cup",
            "radius_mm": round(radius_mm + 0.1 * draw.factor(8), 4),
            "thickness_mm": draw.between(3, 14),
            "inclination_deg": draw.between(0, 65) if is_hip else 0.0,
        }
        if not is_hip:
            case["insert"]["opening_deg"] = draw.between(50, 88)
    case["insert"]["edge_mm"] = draw.between(0.8, 2.2)
    case["insert"]["layers"] = draw.randint(1, 5)
    _contact_and_material(draw, case)
    _march(draw, case)
    _models(draw, case)


def _models(draw, case):
    """Another model of the insert, of creep, of wear and of the integration; deformable inserts are coarse, to be quick."""
    model = draw.choice(["foundation", "foundation", "deformable", "plastic", "resting", "stick-slip"])
    if model != "foundation":
        del case["contact"]["law"]
        case["contact"]["model"] = "deformable"
        case["insert"].update(edge_mm=draw.between(2.0, 3.0), layers=draw.randint(1, 3))
        case["march"] = {"cycles": 1_000_000, "updates": draw.randint(1, 5)}
        case["time"]["increments"] = min(case["time"]["increments"], 80)
        case["contact.deformable"] = {
            "deformable": {},
            "plastic": {"plasticity": "j2"},
            "resting": {"backside": "resting"},
            "stick-slip": {"friction_model": "stick-slip"},
        }[model]
    elif draw.random() < 0.3:
        case["time"]["integrator"] = "explicit"
        case["insert"]["edge_mm"] = draw.between(2.0, 3.0)
        case["march"] = {"cycles": 1_000_000, "updates": draw.randint(1, 3)}
    if draw.random() < 0.3:
        case["creep"] = {"law": "lee-pienkowski"}
    if draw.random() < 0.5:
        case["wear"] = {"law": draw.choice(["power-law", "kang", "contact-area", "unified", "directional"])}


def refined(case):
    """The same design with twice the increments and updates, half the edge and half the slip tolerance."""
    finer = {table: dict(keys) for table, keys in case.items()}
    finer["insert"]["edge_mm"] = case["insert"]["edge_mm"] / 2
    finer["time"]["increments"] = case["time"]["increments"] * 2
    finer["contact"]["slip_tolerance_mm_per_s"] = 0.15
    if case["march"].get("update", "fixed") == "fixed":
        finer["march"]["updates"] = case["march"]["updates"] * 2
    return finer


def perturbed(case):
    """The same design with a Young's modulus that is larger by 1e-12 of it."""
    material = case["material"]
    modulus_mpa = material["youngs_modulus_mpa"] * (1 + 1e-12)
    return case | {"material": material | {"youngs_modulus_mpa": modulus_mpa}}


def toml(case):
    """The text of a case file. Numbers and lists are written by Python as TOML writes them."""
    lines = []
    for table, keys in case.items():
        lines += [f"[{table}]"] if table else []
        lines += [f"{key} = {_value(value)}" for key, value in keys.items()]
    return "\n".join(lines) + "\n"


def _value(value):
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(_value, value)) + "]"
    return repr(value)


def _generic_implant(draw, case):
    distal, coronal = draw.between(20, 60), draw.between(8, 40)
    spacing = draw.between(30, 56)
    case["femur"] = {
        "shape": "generic",
        "distal_radius_mm": distal,
        "posterior_radius_mm": round(distal * draw.between(0.4, 1.0), 4),
        "transition_deg": draw.between(5, 40),
        "coronal_radius_mm": coronal,
        "spacing_mm": spacing,
    }
    # Conformity from flat to almost that of the femur; some have another spacing than their femur.
    sagittal = min(round(distal / draw.between(0.1, 0.98), 4), 10000.0)
    case["insert"] = {
        "shape": "generic",
        "sagittal_radius_mm": sagittal,
        "coronal_radius_mm": min(round(coronal / draw.between(0.4, 0.98), 4), sagittal),
        "spacing_mm": spacing if draw.sober or draw.random() < 0.8 else draw.between(30, 56),
        "thickness_mm": draw.between(1, 16),
        "edge_mm": draw.between(0.9, 2.4),
        "layers": draw.randint(1, 5),
    }
    if not draw.sober and draw.random() < 0.4:
        case["femur"]["start_mm"] = [draw.between(-20, 20), draw.between(-8, 8)]


def _real_implant(draw, case, data):
    implant = REAL_IMPLANTS[draw.choice(sorted(REAL_IMPLANTS))]
    along, across = implant["start_mm"]
    mesh = {"shape": "mesh", "length_unit": "m", "axes": implant["axes"]}
    case["femur"] = {
        **mesh,
        "file": f"{data}/{implant['femur']}",
        "start_mm": [round(along + draw.between(-12, 12), 4), round(across + draw.between(-6, 6), 4)],
    }
    case["insert"] = {
        **mesh,
        "file": f"{data}/{implant['insert']}",
        "edge_mm": draw.between(1.0, 2.0),
        "layers": draw.randint(1, 4),
    }


def _contact_and_material(draw, case):
    case["contact"] = {
        "law": draw.choice(["linear", "linear", "logarithmic"]),
        "friction": draw.choice([0.07, draw.between(0, 0.25)]),
        "slip_tolerance_mm_per_s": 0.3,
    }
    case["material"] = {"youngs_modulus_mpa": round(463 * draw.factor(3), 2)}


def _machine(draw, case):
    case["machine"] = {
        "preset": draw.choice(["stanmore-force"] * 4 + ["stanmore-displacement"]),
        "frequency_hz": draw.choice([1.1, draw.between(0.5, 2)]),
        "flexion_offset_deg": draw.between(-10, 10),
        "vv_axis_medial_mm": draw.between(-10, 10),
    }
    scale_n = round(2065 * draw.factor(2.5), 1)
    if case["machine"]["preset"] == "stanmore-force":
        springs = draw.factor(20) if draw.random() < 0.4 else 1.0
        case["machine.springs"] = {
            "posterior_n_per_mm": round(33.8 * springs, 3),
            "anterior_n_per_mm": round(7.24 * springs, 3),
            "free_play_mm": draw.choice([2.5, draw.between(0, 6)]),
        }
        case["machine.ap_force"] = {"knots_n": _curve(AP_FORCE, 900 * draw.factor(4) * draw.sign())}
        case["machine.ie_torque"] = {"knots_nm": _curve(IE_TORQUE, 5.9 * draw.factor(4) * draw.sign())}
    else:
        case["machine.ap_motion"] = {"waveform": "iso-like", "scale": round(draw.factor(4), 3)}
        case["machine.ie_motion"] = {"waveform": "iso-like", "scale": round(draw.factor(4), 3)}
    case["machine.axial_force"] = {"knots_n": _curve(AXIAL_FORCE, scale_n)}
    case["machine.flexion"] = {"knots_deg": _curve(FLEXION_DEG, draw.choice([1.0, draw.between(0.3, 2.0)]))}


def _curve(points, scale):
    return [[percent, round(value * scale, 3)] for percent, value in points]


def _march(draw, case):
    case["wear"] = {"law": "archard", "wear_factor_mm3_per_nm": round(2.64e-7 * draw.factor(8), 12)}
    case["march"] = {"cycles": draw.choice([1_000_000, 5_000_000, 5_000_000, 20_000_000])}
    if draw.random() < 0.2:
        case["march"]["update"] = "auto"
    else:
        case["march"]["updates"] = draw.randint(1, 25)
    case["time"] = {"increments": round(200 * draw.factor(3))}
