"""The entries of ``summary.json``; written by ``cargo run -p condyle-results --example result_types``."""

from __future__ import annotations

from typing import Any

__all__ = ["Summary"]


class Summary:
    """The entries of ``summary.json`` as attributes; a run does not have all of them."""

    cycles: float
    """Cycles of the test."""
    mass_loss_mg: float
    """Worn mass. In mg."""
    volume_loss_mm3: float
    """Worn volume, from depth. In mm3."""
    volume_loss_mesh_mm3: float
    """Worn volume, from the mesh. In mm3."""
    max_depth_mm: float
    """Wear depth at the deepest node. In mm."""
    wear_over_conventional: float
    """Wear of cross-linked relative to conventional polyethylene."""
    max_penetration_mm: float
    """Deepest penetration. In mm."""
    wear_at_max_penetration_mm: float
    """Wear at the deepest penetration. In mm."""
    creep_at_max_penetration_mm: float
    """Creep at the deepest penetration. In mm."""
    max_creep_mm: float
    """Deepest creep. In mm."""
    creep_volume_mm3: float
    """Volume of creep. In mm3."""
    max_unloaded_depth_mm: float
    """Deepest place of a scan without load. In mm."""
    million_penetration_mm: float
    """Deepest penetration after a million cycles. In mm."""
    million_wear_mm: float
    """Wear at the deepest penetration after a million cycles. In mm."""
    million_creep_mm: float
    """Creep at the deepest penetration after a million cycles. In mm."""
    scan_rise_mm_per_million_cycles: float
    """Rise of the deepest place of scans without load. In mm per million cycles."""
    scan_at_no_cycles_mm: float
    """Deepest place of unloaded scans, extrapolated to no cycles. In mm."""
    peak_pressure_mpa: float
    """Highest contact pressure. In MPa."""
    peak_pressure_cycle: float
    """Cycles before the cycle with the peak pressure."""
    first_cycle_peak_pressure_mpa: float
    """Peak pressure of the first cycle. In MPa."""
    last_cycle_peak_pressure_mpa: float
    """Peak pressure of the last cycle. In MPa."""
    pressure_law_peak_error_percent: float
    """Error of the peak pressure of the fitted pressure law. In %."""
    peak_contact_area_mm2: float
    """Largest contact area. In mm2."""
    peak_contact_area_cycle: float
    """Cycles before the cycle with the largest contact area."""
    first_cycle_contact_area_mm2: float
    """Largest contact area of the first cycle. In mm2."""
    last_cycle_contact_area_mm2: float
    """Largest contact area of the last cycle. In mm2."""
    peak_von_mises_mpa: float
    """Largest von Mises stress. In MPa."""
    peak_von_mises_depth_mm: float
    """Depth of the largest von Mises stress. In mm."""
    peak_max_shear_mpa: float
    """Largest shear stress. In MPa."""
    peak_max_shear_depth_mm: float
    """Depth of the largest shear stress. In mm."""
    peak_max_shear_cycle: float
    """Cycles before the cycle with the largest shear stress."""
    peak_max_shear_percent: float
    """Instant of the largest shear stress in its cycle. In %."""
    first_cycle_max_shear_mpa: float
    """Largest shear stress of the first cycle. In MPa."""
    first_cycle_max_shear_depth_mm: float
    """Depth of the largest shear stress of the first cycle. In mm."""
    max_permanent_set_mm: float
    """Largest permanent set. In mm."""
    first_cycle_permanent_set_mm: float
    """Largest permanent set of the first cycle. In mm."""
    max_plastic_strain: float
    """Largest accumulated plastic strain."""
    yielded_elements: int
    """Elements that have yielded."""
    ratcheting_elements: int
    """Elements that still yield in every cycle."""
    backside_lift_mm: float
    """Largest lift of the backside off the tray. In mm."""
    backside_lifted_percent: float
    """Largest part of the backside that is lifted at the same time. In %."""
    backside_slip_mm: float
    """Longest slip of the backside in a cycle. In mm."""
    backside_lock_force_n: float
    """Largest force on the lock. In N."""
    backside_lock_moment_nm: float
    """Largest moment on the lock. In N m."""
    ap_range_mm: float
    """Range of AP in the first cycle. In mm."""
    ie_range_deg: float
    """Range of IE in the first cycle. In degrees."""
    medial_load_share: float
    """Medial part of the axial force."""
    deepest_from_load_deg: float
    """Angle between the load and the deepest wear. In degrees."""
    deepest_around_load_deg: float
    """Direction of the deepest wear around the load. In degrees."""
    updates: int
    """Updates of the geometry."""
    increments: int
    """Increments per cycle."""
    cycles_solved: float
    """Number of cycles solved."""
    cycles_not_repeating: int
    """Updates, and the final cycle, whose motion did not become periodic within the tolerance."""
    newton_iterations: int
    """Number of Newton iterations."""
    contact_evaluations: int
    """Number of contact evaluations."""
    newton_iterations_per_cycle: float
    """Mean number of Newton iterations per solved cycle."""
    contact_evaluations_per_cycle: float
    """Mean number of contact evaluations per solved cycle."""
    step_halvings: int
    """Halved steps in time."""
    explicit_steps: int
    """Steps of central differences."""
    added_inertia: float
    """Largest inertia added by the explicit integrator."""
    hexahedra: int
    """Hexahedra of the insert's mesh."""
    articulating_nodes: int
    """Nodes of the articulating surface."""
    worst_quality: float
    """Smallest scaled Jacobian of the mesh at any update."""
    wall_s: float
    """Time of the solver. In s."""
    plausibility: list[dict[str, Any]]
    """Findings that make the numbers doubtful, the worst first, each with ``message`` and ``advice``."""
    notes: list[dict[str, Any]]
    """Remarks on the physics that do not make the numbers doubtful, each with ``message`` and its effect in ``advice``."""
    prediction: dict[str, Any]
    """Predicted results of laboratories: medians and 90 % intervals of mass and depth, and the sources of their width."""
    error: dict[str, Any] | None
    """Estimated discretisation errors by their parts; null if the case does not ask for them."""
    wear_laws: list[dict[str, Any]]
    """Wear by every law for the same histories, that of the run first; only this law moves the surface."""
    activities: list[dict[str, Any]]
    """Motion, loads and wear of each activity."""
    joint: str
    """The joint whose replacement the machine tests, such as ``hip``."""
    motions: list[dict[str, Any]]
    """The joints of the machine: ``column`` of ``kinematics.csv``, ``title``, and the ``positive`` direction."""
    neutral_pose: dict[str, Any]
    """Pose of the settled femur in the insert frame: there AP, ML and IS of a knee read zero."""
    axes: str
    """The place that the machine's axes pass through: the ball or socket found in the mesh of the counterface, or its origin."""
    warnings: list[str]
    """Corrections of the input, and doubts about it."""
    version: str
    """Version of condyle."""
    inputs_blake3: str
    """Hash of case and meshes."""
