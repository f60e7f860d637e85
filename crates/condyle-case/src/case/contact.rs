//! Model of contact, pressure law, friction, and the search for nodes in contact.

use condyle::contact::{Backside, ContactSettings, FrictionModel, PressureTable, Search};
use condyle_fem::{Hardening, HardeningError};

use super::pressure_table::StrainTable;
use crate::config::*;

words! {
    FrictionModel {
        Regularised = "regularised",
        StickSlip = "stick-slip",
    }
    Search {
        Coherent = "coherent",
        BruteForce = "brute-force",
    }
}

settings! {
    /// Model of contact and friction.
    Contact {
        /// Friction, and the search for nodes in contact.
        [flat] settings: ContactSettings;
        /// The model of the insert.
        [flat] model: ContactModelChoice;
    }

    /// The insert as an elastic foundation, a rigid body with a layer on it, in which neighbouring points do not act on each other.
    FoundationContact {
        /// Pressure against overclosure.
        [flat] law: PressureLawChoice;
    }

    /// The insert as a body of finite elements on its tray.
    DeformableContact {
        /// Friction: regularised, a function of the sliding speed, with slip_tolerance_mm_per_s; or stick-slip, with which the surface deflects tangentially and each node sticks or slides by Coulomb's law, without a tolerance. Stick-slip takes about seven times as long and requires the implicit integrator.
        friction_model: FrictionModel = FrictionModel::Regularised;
        /// Yield of the insert.
        [flat] plasticity: PlasticityChoice;
        /// Support of the backside.
        [flat] backside: BacksideChoice;
    }

    /// Softening of polyethylene under uniaxial stress: strain = e0/2 (stress/s0 + (stress/s0)^3).
    SofteningCurve {
        /// e0, the strain at the softening stress; Young's modulus is then 2 s0/e0, 616 MPa by default, and that of the material is not used. Approximate.
        softening_strain: f64 = 0.0597, in within(1e-4, 10.0);
        /// s0, the stress at which the strain is twice that by the initial modulus. Approximate.
        softening_stress_mpa: f64 = 18.4, in within(0.1, 10_000.0);
    }

    /// Plasticity of von Mises with isotropic and kinematic hardening.
    J2Plasticity [check] {
        /// Von Mises stress at which polyethylene begins to yield. The default is approximate: quoted from memory, not checked at the source.
        yield_stress_mpa: f64 = 14.0, in within(0.1, 10_000.0);
        /// Modulus of linear kinematic hardening: stress of the centre of the yield surface over plastic strain, in tension.
        kinematic_modulus_mpa: f64 = 0.0, in within(0.0, 10_000.0);
        /// Points [plastic strain, yield stress in MPa] of isotropic hardening, rising from [0.0, yield_stress_mpa]; by default those of [0.0099, 23.2], [0.0258, 25.1], [0.0434, 26.2], [0.0619, 26.9] whose stress exceeds yield_stress_mpa, which change little with it, from a model of polyethylene (Bergström and Bischoff 2010). Approximate.
        hardening: Option<Points> = None;
    }

    /// A backside that rests on its tray.
    RestingBackside {
        /// Coulomb coefficient of friction between backside and tray. The default is assumed, not measured.
        backside_friction: f64 = 0.2, in within(0.0, 1000.0);
        /// Spacing of the points at which the motion of the backside is solved; it is interpolated between them.
        backside_spacing_mm: f64 = 5.0, in within(1.0, 50.0);
    }
}

settings_of! {
    ContactSettings {
        /// Coulomb coefficient of friction.
        friction: f64 = 0.07, in within(0.0, 2.0);
        /// Sliding speed at which friction has 71 % of its full value: smaller values are more accurate and slower.
        slip_tolerance_mm_per_s: f64 = 0.3, in within(1e-6, 1000.0);
        /// Search for the nodes that may touch. The results are the same; brute force is the slow reference.
        search: Search = Search::Coherent;
        /// Largest motion over which a sample of the femur is extrapolated, which changes the force by less than 1e-5; 0 computes every sample.
        sample_reuse_mm: f64 = ContactSettings::SAMPLE_REUSE_MM, in within(0.0, 0.02);
    }
}

variants! {
    /// The model of the insert in contact.
    ContactModelChoice by
    /// Model of the insert: a fast elastic foundation, whose pressure follows a law, or a deformable body of finite elements with small strains, which needs no law.
    model = "foundation" {
        /// An elastic foundation: its pressure law.
        Foundation(@table FoundationContact) = "foundation",
        /// A deformable body: its plasticity, friction and backside.
        Deformable(@table DeformableContact) = "deformable",
    }

    /// Pressure against overclosure; the modulus comes from the material.
    PressureLawChoice by
    /// Pressure as a function of overclosure.
    law = "linear" {
        /// p = K d / h.
        Linear = "linear",
        /// p = -K ln(1 - d / h).
        Logarithmic = "logarithmic",
        /// d / h = (p / K) (1 + (p / s)^2), which softens as polyethylene does.
        Softening(SofteningCurve) = "softening",
        /// Points of pressure against overclosure.
        Tabulated(PressureTable) = "tabulated",
        /// Points of pressure against overclosure over thickness.
        TabulatedStrain(StrainTable) = "tabulated-strain",
    }

    /// Yield of a deformable insert.
    PlasticityChoice by
    /// Yield of the insert.
    plasticity = "none" {
        /// It is elastic.
        None = "none",
        /// By von Mises, with hardening.
        J2(J2Plasticity) = "j2",
    }

    /// Support of the backside of a deformable insert.
    BacksideChoice by
    /// Support of the backside: bonded to the tray, or resting on it, with lift and frictional slip. Resting takes about five times as long and requires the implicit integrator.
    backside = "bonded" {
        /// It neither lifts nor slips.
        Bonded = "bonded",
        /// It presses and sticks or slips, or lifts.
        Resting(RestingBackside) = "resting",
    }
}

impl Contact {
    /// Returns the pressure law of a foundation; `None` for a deformable insert, which has none.
    pub fn law(&self) -> Option<&PressureLawChoice> {
        match &self.model {
            ContactModelChoice::Foundation(foundation) => Some(&foundation.law),
            ContactModelChoice::Deformable(_) => None,
        }
    }

    /// Returns the settings of a deformable insert; `None` for a foundation.
    pub fn deformable(&self) -> Option<&DeformableContact> {
        match &self.model {
            ContactModelChoice::Foundation(_) => None,
            ContactModelChoice::Deformable(deformable) => Some(deformable),
        }
    }
}

impl DeformableContact {
    /// An elastic insert with regularised friction that is bonded to its tray.
    pub const ELASTIC: Self = Self {
        friction_model: FrictionModel::Regularised,
        plasticity: PlasticityChoice::None,
        backside: BacksideChoice::Bonded,
    };
}

impl PressureLawChoice {
    /// Error of the peak pressure against the deformable insert that the law was fitted to, %, if it is known.
    pub fn peak_error_percent(&self) -> Option<f64> {
        match self {
            Self::TabulatedStrain(table) => table.error.peak_error_percent,
            Self::Linear | Self::Logarithmic | Self::Softening(_) | Self::Tabulated(_) => None,
        }
    }
}

/// Plastic strain and yield stress, MPa, of ultra-high-molecular-weight polyethylene beyond its first yield: the
/// three-network model of Bergstrom and Bischoff (2010) in compression at 1 % a second, run by us, minus the elastic strain
/// of 463 MPa. Approximate.
const CURVE: [(f64, f64); 4] = [
    (0.0099, 23.2),
    (0.0258, 25.1),
    (0.0434, 26.2),
    (0.0619, 26.9),
];

impl PlasticityChoice {
    pub(crate) fn hardening(&self) -> Option<Hardening> {
        match self {
            Self::None => None,
            Self::J2(j2) => j2.hardening().ok(),
        }
    }
}

impl J2Plasticity {
    fn hardening(&self) -> Result<Hardening, HardeningError> {
        let first_mpa = self.yield_stress_mpa;
        let points = match &self.hardening {
            Some(points) => points.0.clone(),
            None => {
                let beyond = CURVE.into_iter().filter(|point| point.1 > first_mpa);
                [(0.0, first_mpa)].into_iter().chain(beyond).collect()
            }
        };
        Hardening::new(points, self.kinematic_modulus_mpa)
    }

    fn check(&self, section: &Section<'_>, log: &mut Log<'_>) {
        let mut report = |point, message: String| {
            let fault = Fault::new(format!("`hardening`{message}"), "");
            log.problem(section.item_span("hardening", point), fault);
        };
        let yield_stress_mpa = self.yield_stress_mpa;
        let first = self.hardening.as_ref().and_then(|points| points.0.first());
        match (self.hardening(), first) {
            (Err(error), _) => report(error.point, format!(": {error}")),
            (Ok(_), Some(&(_, found))) if found != yield_stress_mpa => {
                let message = format!(
                    " starts at {found} MPa, and yield_stress_mpa is {yield_stress_mpa}: its first point must be [0.0, {yield_stress_mpa:?}]"
                );
                report(0, message);
            }
            (Ok(_), _) => {}
        }
    }
}

impl BacksideChoice {
    /// Returns the support of the backside.
    pub fn backside(&self) -> Backside {
        match self {
            Self::Bonded => Backside::Bonded,
            Self::Resting(resting) => Backside::Resting {
                friction: resting.backside_friction,
                spacing_mm: resting.backside_spacing_mm,
            },
        }
    }

    pub(crate) fn is_resting(&self) -> bool {
        matches!(self, Self::Resting(_))
    }
}
