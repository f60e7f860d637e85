//! What a case is made of.

use super::axes::Axes;
use super::files::DataFile;
use super::keys::{choice, settings, within};

choice! {
    /// Which knee.
    Side {
        /// A right knee.
        Right = "right",
        /// A left knee, mirrored on the way in and out.
        Left = "left",
    }

    /// Unit of length of a mesh file.
    LengthUnit {
        /// Millimetre.
        Millimetre = "mm",
        /// Centimetre.
        Centimetre = "cm",
        /// Metre.
        Metre = "m",
        /// Inch.
        Inch = "in",
    }

    /// Which form pressure takes against overclosure.
    PressureForm {
        /// p = K d / h.
        Linear = "linear",
        /// p = -K ln(1 - d / h).
        Logarithmic = "logarithmic",
        /// Points of pressure against overclosure.
        Tabulated = "tabulated",
    }

    /// A simulator to start from.
    Preset {
        /// AP and IE free under force and torque, restrained by springs.
        StanmoreForce = "stanmore-force",
        /// AP and IE moved along waveforms.
        StanmoreDisplacement = "stanmore-displacement",
    }

    /// What a stated spring stiffness belongs to.
    StiffnessOf {
        /// Both springs of the pair together: each has half.
        Pair = "pair",
        /// Each spring of the pair.
        Each = "each",
    }

    /// How time is integrated.
    IntegratorWord {
        /// Backward differences and Newton's method.
        Implicit = "implicit",
        /// Central differences, as a cross-check.
        Explicit = "explicit",
    }

    /// What moves a freedom.
    DriveWord {
        /// Held at a position.
        Locked = "locked",
        /// Moved along a waveform of position.
        Prescribed = "prescribed",
        /// Free under a waveform of load, or under none.
        Loaded = "loaded",
    }

    /// When the worn shape is brought up to date.
    UpdateWord {
        /// So many times, evenly over the cycles.
        Fixed = "fixed",
        /// As seldom as a tolerance on the maximum depth allows.
        Auto = "auto",
    }

    /// Which wear law.
    WearLawWord {
        /// Depth per cycle = Kw sum of p |ds|.
        Archard = "archard",
    }
}

impl LengthUnit {
    /// How many mm it has.
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
        }
    }
}

settings! {
    /// What stands above the first table of a case.
    Heading {
        /// One line that says what the case is.
        title: String = "Untitled".to_owned();
        /// Which knee; a left one is mirrored on the way in and out.
        side: Side = Side::Right;
    }

    /// A pair of condyles, each a piece of torus.
    GenericFemur {
        /// Radius of the distal arc, seen from the side.
        distal_radius_mm: f64 = 38.0, in within(5.0, 200.0);
        /// Radius of the posterior arc, seen from the side.
        posterior_radius_mm: f64 = 22.0, in within(5.0, 200.0);
        /// Where the posterior arc takes over, behind straight down.
        transition_deg: f64 = 20.0, in within(0.0, 90.0);
        /// Radius of each condyle, seen from the front.
        coronal_radius_mm: f64 = 24.0, in within(2.0, 200.0);
        /// Distance between the lowest lines of the condyles.
        spacing_mm: f64 = 46.0, in within(10.0, 100.0);
        /// Where the femoral frame starts in the insert frame, [x, z], before it settles; over the dish if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// One sphere, for verification.
    SphereFemur {
        /// Radius of the sphere.
        radius_mm: f64 = 24.0, in within(1.0, 500.0);
        /// Where its centre starts in the insert frame, [x, z], before it settles; over the origin if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// One endless cylinder about the medio-lateral axis, for verification.
    CylinderFemur {
        /// Radius of the cylinder.
        radius_mm: f64 = 24.0, in within(1.0, 500.0);
        /// Where its axis starts in the insert frame, [x, z], before it settles; over the origin if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// A femoral component read from a triangle mesh.
    MeshFemur {
        /// STL, OBJ, PLY or VTP file, relative to the case file.
        file: DataFile;
        /// Unit of length of the file.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Where x, y and z of the file point.
        axes: Axes = Axes::ISB;
        /// Flexion axis [x, y] in the femoral frame; fitted to the posterior condyles if not given.
        flexion_axis_mm: Option<[f64; 2]> = None, in within(-200.0, 200.0);
        /// Where the femoral frame starts in the insert frame, [x, z], before it settles; at the origin if not given.
        start_mm: Option<[f64; 2]> = None, in within(-100.0, 100.0);
    }

    /// Two dishes with an eminence between.
    GenericInsert {
        /// Radius of each dish, seen from the side.
        sagittal_radius_mm: f64 = 55.0, in within(5.0, 10000.0);
        /// Radius of each dish, seen from the front.
        coronal_radius_mm: f64 = 30.0, in within(2.0, 10000.0);
        /// Distance between the lowest lines of the dishes.
        spacing_mm: f64 = 46.0, in within(10.0, 100.0);
        /// Thickness where it is thinnest.
        thickness_mm: f64 = 9.0, in within(1.0, 50.0);
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = 1.05, in within(0.1, 10.0);
        /// Hexahedra through the thickness.
        layers: u64 = 3, in within(1.0, 40.0);
    }

    /// An insert whose triangle mesh is turned into columns of hexahedra.
    MeshInsert {
        /// STL, OBJ, PLY or VTP file, relative to the case file.
        file: DataFile;
        /// Unit of length of the file.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Where x, y and z of the file point.
        axes: Axes = Axes::ISB;
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = 1.05, in within(0.1, 10.0);
        /// Hexahedra through the thickness.
        layers: u64 = 3, in within(1.0, 40.0);
        /// Thickness where it is thinnest: only for an open articulating surface, which has none of its own.
        thickness_mm: Option<f64> = None, in within(1.0, 50.0);
    }

    /// An insert read as hexahedra.
    HexahedralInsert {
        /// Abaqus .inp, Gmsh .msh or .vtu file, relative to the case file.
        file: DataFile;
        /// Unit of length of the file.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Where x, y and z of the file point.
        axes: Axes = Axes::ISB;
        /// Name in the file of the surface that articulates; found from above if not given.
        articulating_surface: Option<String> = None;
        /// Name in the file of the backside; found from below if not given.
        backside: Option<String> = None;
    }

    /// A flat block, for verification.
    FlatInsert {
        /// Thickness.
        thickness_mm: f64 = 9.0, in within(1.0, 50.0);
        /// Edge of a hexahedron, seen from above.
        edge_mm: f64 = 1.05, in within(0.1, 10.0);
        /// Hexahedra through the thickness.
        layers: u64 = 3, in within(1.0, 40.0);
    }

    /// Polyethylene of the insert.
    Material {
        /// Young's modulus.
        youngs_modulus_mpa: f64 = 463.0, in within(1.0, 100_000.0);
        /// Poisson's ratio.
        poissons_ratio: f64 = 0.46, in within(0.0, 0.499);
        /// Density.
        density_mg_per_mm3: f64 = 0.93, in within(0.01, 30.0);
    }

    /// Contact besides the pressure law.
    Friction {
        /// Coulomb coefficient of friction.
        friction: f64 = 0.07, in within(0.0, 2.0);
        /// Sliding speed at which friction is nearly full: smaller is truer and slower.
        slip_tolerance_mm_per_s: f64 = 0.3, in within(1e-6, 1000.0);
    }

    /// The simulator's numbers.
    MachineSettings {
        /// Gait cycles a second.
        frequency_hz: f64 = 1.1, in within(0.001, 100.0);
        /// Added to the flexion waveform: -7 sets the femur 7 degrees towards hyperextension.
        flexion_offset_deg: f64 = -7.0, in within(-45.0, 45.0);
        /// 1 or -1 times the AP force: laboratories dispute its direction.
        ap_force_sign: Sign = Sign::Plus;
        /// 1 or -1 times the IE torque: laboratories dispute its direction.
        ie_torque_sign: Sign = Sign::Plus;
        /// How far medial of the load axis the varus-valgus axis lies.
        vv_axis_medial_mm: f64 = 5.0, in within(-50.0, 50.0);
        /// How far below the dish's lowest point the varus-valgus axis lies.
        vv_axis_below_mm: f64 = 20.0, in within(-100.0, 200.0);
        /// How far anterior of the insert's origin the axis of IE rotation lies.
        ie_axis_anterior_mm: f64 = 0.0, in within(-50.0, 50.0);
    }

    /// The pair of springs that stands for the ligaments.
    Springs {
        /// Stiffness against posterior motion of the insert.
        posterior_n_per_mm: f64 = 33.8, in within(0.0, 10_000.0);
        /// Stiffness against anterior motion of the insert.
        anterior_n_per_mm: f64 = 7.24, in within(0.0, 10_000.0);
        /// Whether the stiffnesses are those of the pair or of each spring: the paper does not say.
        stiffness_of: StiffnessOf = StiffnessOf::Pair;
        /// Motion each way before they engage.
        free_play_mm: f64 = 2.5, in within(0.0, 50.0);
        /// How far each spring lies to the side of the IE axis.
        lateral_offset_mm: f64 = 28.0, in within(0.0, 100.0);
    }

    /// A freedom that translates. Inertia and damping are choices of ours: no source gives them.
    Translation {
        /// What moves it; by the preset if not given.
        drive: Option<DriveWord> = None;
        /// Where it is held when locked.
        locked_at_mm: f64 = 0.0, in within(-100.0, 100.0);
        /// Mass that moves with it.
        inertia_kg: f64 = 5.0, in within(0.0, 1000.0);
        /// Viscous damping.
        damping_n_s_per_mm: f64 = 0.3, in within(0.0, 1000.0);
    }

    /// A freedom that rotates. Inertia and damping are choices of ours: no source gives them.
    Rotation {
        /// What moves it; by the preset if not given.
        drive: Option<DriveWord> = None;
        /// Where it is held when locked.
        locked_at_deg: f64 = 0.0, in within(-180.0, 180.0);
        /// Moment of inertia that moves with it.
        inertia_kg_m2: f64 = 0.01, in within(0.0, 100.0);
        /// Viscous damping.
        damping_nm_s_per_rad: f64 = 0.2, in within(0.0, 1000.0);
    }

    /// The wear law.
    Wear {
        /// Which law.
        law: WearLawWord = WearLawWord::Archard;
        /// Volume worn for each newton of load and metre of sliding.
        wear_factor_mm3_per_nm: f64 = 2.64e-7, in within(0.0, 1e-3);
    }

    /// The whole test.
    WholeTest {
        /// Gait cycles in all.
        cycles: u64 = 5_000_000, in within(1.0, 1e10);
    }

    /// Updates of the worn shape, evenly over the cycles.
    FixedUpdates {
        /// How often the worn shape is brought up to date, evenly over the cycles.
        updates: u64 = 10, in within(1.0, 10_000.0);
    }

    /// Updates of the worn shape as the depth asks for them.
    AutoUpdates {
        /// Error of the maximum depth that one interval may make, as a fraction of the depth expected at the end; it mostly wears away in those that follow.
        depth_tolerance_fraction: f64 = 0.05, in within(1e-5, 0.5);
    }

    /// What a run tells of its own accuracy.
    Accuracy {
        /// Whether discretisation errors are estimated after the run, by solving the unworn cycle more coarsely.
        estimate: bool = true;
    }

    /// Steps and tolerances in time.
    Time {
        /// Increments in a gait cycle.
        increments: u64 = 200, in within(20.0, 100_000.0);
        /// An implicit increment is halved until its own error is estimated below this; rotations on a lever of 10 mm. 0 never halves for that.
        increment_error_mm: f64 = 0.0, in within(0.0, 10.0);
        /// Largest residual force of a converged increment.
        force_tolerance_n: f64 = 0.01, in within(1e-9, 10.0);
        /// Cycles to run at most until one repeats the one before.
        most_cycles_to_repeat: u64 = 10, in within(1.0, 1000.0);
        /// Largest difference of a translation between two cycles that repeat.
        repeat_tolerance_mm: f64 = 0.01, in within(1e-9, 10.0);
        /// Largest difference of a rotation between two cycles that repeat.
        repeat_tolerance_deg: f64 = 0.01, in within(1e-9, 10.0);
        /// How an increment is stepped through: implicit in one step, or explicit in many short ones.
        integrator: IntegratorWord = IntegratorWord::Implicit;
        /// Explicit: inertia is added wherever a stable step would be shorter than this; 0 adds none.
        explicit_step_s: f64 = 0.0, in within(0.0, 1e-3);
    }
}

/// 1 or -1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// 1: as the waveform says.
    Plus,
    /// -1: turned round.
    Minus,
}

impl Sign {
    /// 1.0 or -1.0.
    pub fn factor(self) -> f64 {
        match self {
            Self::Plus => 1.0,
            Self::Minus => -1.0,
        }
    }
}
