//! Names of sets, surfaces and amplitudes in the file.

/// Hexahedra of the insert.
pub(super) const INSERT: &str = "INSERT";
/// Nodes of the insert.
pub(super) const INSERT_NODES: &str = "INSERT-NODES";
/// Nodes of the insert's backside.
pub(super) const BACKSIDE: &str = "BACKSIDE";
/// The articulating surface of the insert.
pub(super) const ARTICULATING: &str = "ARTICULATING";
/// Triangles of the femur.
pub(super) const FEMUR: &str = "FEMUR";
/// Nodes of the femur.
pub(super) const FEMUR_NODES: &str = "FEMUR-NODES";
/// The outer side of the femur.
pub(super) const FEMUR_SURFACE: &str = "FEMUR-SURFACE";
/// Polyethylene.
pub(super) const MATERIAL: &str = "UHMWPE";
/// The femur's, where its elements need one.
pub(super) const METAL: &str = "METAL";

/// Reference node of the femur, on the flexion axis.
pub(super) const FEMUR_REF: &str = "FEMUR-REF";
/// Reference node of the carriage, on the IE axis.
pub(super) const CARRIAGE: &str = "CARRIAGE";
/// Nodes that ride on the carriage.
pub(super) const CARRIAGE_NODES: &str = "CARRIAGE-NODES";
/// Reference node of the insert, on the VV axis.
pub(super) const INSERT_REF: &str = "INSERT-REF";
/// x anterior, y superior, z lateral of the simulator's frame.
pub(super) const FRAME: &str = "FRAME";
/// Connector from the ground to the carriage.
pub(super) const CARRIAGE_JOINT: &str = "CARRIAGE-JOINT";
/// Connector from the ground to the femur.
pub(super) const FEMUR_JOINT: &str = "FEMUR-JOINT";
/// Connector from the carriage to the insert.
pub(super) const HINGE: &str = "VV-HINGE";

/// Pressure law and friction.
pub(super) const BEARING: &str = "BEARING";

/// 1 all the time.
pub(super) const HOLD: &str = "HOLD";
/// From 0 to 1 over the step START.
pub(super) const RAMP: &str = "RAMP";
/// How the axial force comes on in the step SETTLE.
pub(super) const LOADING: &str = "LOADING";
