//! The keys of `[machine]` and of the tables inside it.

use condyle::machine::knee;
use toml::Spanned;
use toml::de::DeValue;

use crate::config::{Key, Kind, Log, Setting, choice, number, settings, within, wrong_type};

choice! {
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

    /// What moves a freedom.
    DriveWord {
        /// Held at a position.
        Locked = "locked",
        /// Moved along a waveform of position.
        Prescribed = "prescribed",
        /// Free under a waveform of load, or under none.
        Loaded = "loaded",
    }
}

settings! {
    /// The simulator that a machine starts from.
    Start {
        /// The simulator it starts from: which freedoms are free and which are moved.
        preset: Preset = Preset::StanmoreForce;
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

    /// A freedom that translates. No source gives inertia and damping: the book says why they are so.
    Translation {
        /// What moves it; by the preset if not given.
        drive: Option<DriveWord> = None;
        /// Where it is held when locked.
        locked_at_mm: f64 = 0.0, in within(-100.0, 100.0);
        /// Mass that moves with it.
        inertia_kg: f64 = 1e3 * knee::MASS_TONNE, in within(0.0, 1000.0);
        /// Viscous damping.
        damping_n_s_per_mm: f64 = knee::DAMPING_N_S_PER_MM, in within(0.0, 1000.0);
    }

    /// A freedom that rotates. No source gives inertia and damping: the book says why they are so.
    Rotation {
        /// What moves it; by the preset if not given.
        drive: Option<DriveWord> = None;
        /// Where it is held when locked.
        locked_at_deg: f64 = 0.0, in within(-180.0, 180.0);
        /// Moment of inertia that moves with it.
        inertia_kg_m2: f64 = 1e-3 * knee::MOMENT_OF_INERTIA_TONNE_MM2, in within(0.0, 100.0);
        /// Viscous damping.
        damping_nm_s_per_rad: f64 = 1e-3 * knee::DAMPING_NMM_S_PER_RAD, in within(0.0, 1000.0);
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

impl Setting for Sign {
    fn kind() -> Kind {
        Kind::Sign
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        match number(value.get_ref()) {
            Some(1.0) => Some(Self::Plus),
            Some(-1.0) => Some(Self::Minus),
            _ => {
                wrong_type(value, key, log);
                None
            }
        }
    }

    fn text(&self) -> Option<String> {
        Some(format!("{:.0}", self.factor()))
    }
}
