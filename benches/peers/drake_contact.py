"""Drake's hydroelastic contact of the DM implant: rigid femur, compliant insert of tetrahedra."""

import statistics
import time

import numpy as np
from pydrake.common.value import AbstractValue
from pydrake.geometry import (
    AddCompliantHydroelasticProperties,
    AddRigidHydroelasticProperties,
    FramePoseVector,
    GeometryFrame,
    GeometryInstance,
    HydroelasticContactRepresentation,
    Mesh,
    ProximityProperties,
    SceneGraph,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.systems.framework import DiagramBuilder

ANY_MODULUS_PA = 1e9


class Knee:
    """The femur over the insert in a scene graph; metres, the insert in condyle's frame."""

    def __init__(self, femur_obj, insert_vtk, modulus_pa):
        builder = DiagramBuilder()
        scene = builder.AddSystem(SceneGraph())
        source = scene.RegisterSource("knee")
        self.frame = scene.RegisterFrame(source, GeometryFrame("femur"))
        rigid, compliant = ProximityProperties(), ProximityProperties()
        AddRigidHydroelasticProperties(rigid)
        AddCompliantHydroelasticProperties(0.01, modulus_pa, compliant)
        scene.RegisterGeometry(source, self.frame, instance(femur_obj, "femur", rigid))
        scene.RegisterAnchoredGeometry(source, instance(insert_vtk, "insert", compliant))
        builder.ExportInput(scene.get_source_pose_port(source), "poses")
        builder.ExportOutput(scene.get_query_output_port(), "query")
        self.diagram = builder.Build()
        self.context = self.diagram.CreateDefaultContext()

    def surfaces(self, rotation, origin_m):
        """Contact surfaces at a pose."""
        pose = RigidTransform(RotationMatrix.ProjectToRotationMatrix(rotation), origin_m)
        poses = FramePoseVector()
        poses.set_value(self.frame, pose)
        self.diagram.get_input_port(0).FixValue(self.context, AbstractValue.Make(poses))
        query = self.diagram.get_output_port(0).Eval(self.context)
        return query.ComputeContactSurfaces(HydroelasticContactRepresentation.kTriangle)


def instance(path, name, properties):
    """A geometry of a mesh file."""
    geometry = GeometryInstance(RigidTransform(), Mesh(str(path)), name)
    geometry.set_proximity_properties(properties)
    return geometry


def force_n(surfaces):
    """Pressure times area over all contact triangles, on the insert."""
    total = np.zeros(3)
    for surface in surfaces:
        mesh, pressure = surface.tri_mesh_W(), surface.tri_e_MN()
        at_vertex = np.array([pressure.EvaluateAtVertex(i) for i in range(mesh.num_vertices())])
        for i in range(mesh.num_triangles()):
            corners = [mesh.element(i).vertex(j) for j in range(3)]
            total -= at_vertex[corners].mean() * mesh.area(i) * mesh.face_normal(i)
    return total


def gradient_pa_per_m(surfaces):
    """Median slope of the insert's pressure field where it touches."""
    slopes = []
    for surface in surfaces:
        ask = surface.EvaluateGradE_M_W if surface.HasGradE_M() else surface.EvaluateGradE_N_W
        slopes += [np.linalg.norm(ask(i)) for i in range(surface.num_faces())]
    return statistics.median(slopes)


def measure(femur_obj, insert_vtk, poses, stiffness_pa_per_m, rounds):
    """Rows of (percent, force on the insert, area_mm2, time_ms); `poses` in metres.

    Drake's pressure is modulus x depth / greatest depth, so its slope is uniform below the
    surface: the modulus is chosen to make that slope the stiffness of the others.
    """
    knee = Knee(femur_obj, insert_vtk, ANY_MODULUS_PA)
    _, rotation, origin_m = poses[0]
    slope = gradient_pa_per_m(knee.surfaces(rotation, origin_m))
    knee = Knee(femur_obj, insert_vtk, ANY_MODULUS_PA * stiffness_pa_per_m / slope)
    for percent, rotation, origin_m in poses:
        times = []
        for _ in range(rounds):
            start = time.perf_counter()
            surfaces = knee.surfaces(rotation, origin_m)
            times.append(1e3 * (time.perf_counter() - start))
        area_mm2 = 1e6 * sum(surface.total_area() for surface in surfaces)
        yield percent, force_n(surfaces), area_mm2, statistics.median(times)
