"""OpenSim's contact force and area of the DM implant at given poses.

python opensim_contact.py DATA_FOLDER POSES.csv ROUNDINGS > opensim.csv

ROUNDINGS is how often the facets of both meshes are rounded before OpenSim gets them; 0 is the
meshes as they are.
"""

import csv
import statistics
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
import opensim

from meshes import read_stl, rounded, write_obj

STIFFNESS_MPA_PER_MM = 268.0
PA_PER_M = STIFFNESS_MPA_PER_MM * 1e9
# From condyle's frame (x anterior, z lateral) to that of the files (x posterior, z medial).
TO_FILE = np.diag([-1.0, 1.0, -1.0])
# Step of the difference quotient that gives the area, m.
STEP_M = 1e-6
ROUNDS = 5

# With a stiffness for each of two meshes OpenSim puts springs on the triangles of both and halves
# them. Springs on the insert alone, as condyle has them: twice the stiffness there, none on the femur.
MODEL = """<?xml version="1.0" encoding="UTF-8" ?>
<OpenSimDocument Version="40000"><Model name="knee"><gravity>0 0 0</gravity>
<BodySet><objects><Body name="femur"><mass>1</mass><inertia>1 1 1 0 0 0</inertia></Body></objects></BodySet>
<JointSet><objects><FreeJoint name="joint"><socket_parent_frame>/ground</socket_parent_frame>
<socket_child_frame>/bodyset/femur</socket_child_frame></FreeJoint></objects></JointSet>
<ContactGeometrySet><objects>
<ContactMesh name="insert_mesh"><socket_frame>/ground</socket_frame><filename>{insert}</filename></ContactMesh>
<ContactMesh name="femur_mesh"><socket_frame>/bodyset/femur</socket_frame><filename>{femur}</filename></ContactMesh>
</objects></ContactGeometrySet>
<ForceSet><objects><ElasticFoundationForce name="contact">
<ElasticFoundationForce::ContactParametersSet name="contact_parameters"><objects>
{insert_springs}{femur_springs}</objects></ElasticFoundationForce::ContactParametersSet>
</ElasticFoundationForce></objects></ForceSet></Model></OpenSimDocument>
"""
SPRINGS = """<ElasticFoundationForce::ContactParameters><geometry>{mesh}</geometry>
<stiffness>{stiffness}</stiffness><dissipation>0</dissipation><static_friction>0</static_friction>
<dynamic_friction>0</dynamic_friction><viscous_friction>0</viscous_friction>
</ElasticFoundationForce::ContactParameters>
"""


def read_poses(path):
    """Rows of (percent, rotation, origin in mm) in condyle's frames."""
    with open(path, newline="", encoding="ascii") as file:
        for row in csv.DictReader(file):
            rotation = np.array([[float(row[i + j]) for j in "xyz"] for i in "xyz"])
            origin_mm = np.array([float(row[i + "_mm"]) for i in "xyz"])
            yield float(row["percent"]), rotation, origin_mm


class Knee:
    """Femur and insert in OpenSim, in metres and in the axes of their files."""

    def __init__(self, data, roundings, folder):
        files = {}
        for name in ("tibial-insert", "femoral-component"):
            mesh = read_stl(Path(data) / f"{name}.stl")
            for _ in range(roundings):
                mesh = rounded(*mesh)
            files[name] = Path(folder) / f"{name}.obj"
            write_obj(files[name], *mesh)
        model_file = Path(folder) / "knee.osim"
        model_file.write_text(
            MODEL.format(
                insert=files["tibial-insert"],
                femur=files["femoral-component"],
                insert_springs=SPRINGS.format(mesh="insert_mesh", stiffness=2.0 * PA_PER_M),
                femur_springs=SPRINGS.format(mesh="femur_mesh", stiffness=0.0),
            ),
            encoding="utf-8",
        )
        self.model = opensim.Model(str(model_file))
        self.state = self.model.initSystem()
        self.contact = self.model.getForceSet().get(0)
        self.joint = opensim.FreeJoint.safeDownCast(self.model.getJointSet().get(0))

    def place(self, rotation, origin_m):
        """Moves the femur; both in the axes of the files."""
        matrix = opensim.Mat33(*map(float, rotation.flatten()))
        angles = opensim.Rotation(matrix).convertRotationToBodyFixedXYZ()
        values = [float(angles.get(i)) for i in range(3)] + [float(x) for x in origin_m]
        for i, value in enumerate(values):
            self.joint.upd_coordinates(i).setValue(self.state, value, False)
        self.model.realizeVelocity(self.state)

    def force_n(self):
        """Force on the insert (the ground) at the present pose, N, and its computing time, s.

        Reading the force back sums the springs again and is not timed.
        """
        start = time.perf_counter()
        self.model.realizeDynamics(self.state)
        seconds = time.perf_counter() - start
        record = self.contact.getRecordValues(self.state)
        return np.array([record.get(i) for i in range(3)]), seconds

    def area_mm2(self, rotation, origin_m):
        """Area of the triangles in contact, mm2.

        A spring's force -k A d n on the insert has the derivative dF/dx = k A n n' for a motion x of the femur, whose trace
        is k A.
        """
        slope = 0.0
        for step in STEP_M * np.eye(3):
            self.place(rotation, origin_m + step)
            ahead, _ = self.force_n()
            self.place(rotation, origin_m - step)
            behind, _ = self.force_n()
            slope += (ahead - behind) @ step / (2.0 * STEP_M**2)
        return slope / PA_PER_M * 1e6


def measure(data, poses, roundings, rounds=ROUNDS):
    """Rows of (percent, force on the insert in condyle's axes, area_mm2, time_ms)."""
    opensim.Logger.setLevelString("warn")
    with tempfile.TemporaryDirectory() as folder:
        knee = Knee(data, roundings, folder)
        for percent, rotation, origin_mm in read_poses(poses):
            turned, origin_m = TO_FILE @ rotation @ TO_FILE, TO_FILE @ origin_mm / 1000.0
            answers = []
            for _ in range(rounds):
                knee.place(turned, origin_m)
                answers.append(knee.force_n())
            force_n = TO_FILE @ answers[0][0]
            time_ms = 1e3 * statistics.median(seconds for _, seconds in answers)
            yield percent, force_n, knee.area_mm2(turned, origin_m), time_ms


def main():
    data, poses, roundings = sys.argv[1:]
    print(f"# OpenSim {opensim.GetVersion()} (PyPI opensim {version('opensim')}), facets rounded {roundings} times")
    print("percent,force_x_n,force_y_n,force_z_n,area_mm2")
    for percent, force, area_mm2, _ in measure(data, poses, int(roundings), rounds=1):
        print(f"{percent:.1f},{force[0]:.3f},{force[1]:.3f},{force[2]:.3f},{area_mm2:.3f}", flush=True)


if __name__ == "__main__":
    main()
