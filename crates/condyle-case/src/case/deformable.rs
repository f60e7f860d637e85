//! Settings of a deformable insert: plasticity, and the support of its backside.

use condyle::contact::{Backside, Deformable};
use condyle_fem::{Elastic, ElasticPlastic, Hardening, HardeningError};
use thiserror::Error;

use crate::config::{
    Key, Kind, Log, Reason, Section, Settings, WhereSilent, Writer, pairs, settings, variants,
    within,
};

/// Points of the hardening curve.
const HARDENING: &str = "hardening";

/// Plastic strain and yield stress, MPa, of ultra-high-molecular-weight polyethylene beyond its first yield: the
/// three-network model of Bergstrom and Bischoff (2010) in compression at 1 % a second, run by us, less the elastic strain
/// of 463 MPa. Approximate.
const CURVE: [(f64, f64); 4] = [
    (0.0099, 23.2),
    (0.0258, 25.1),
    (0.0434, 26.2),
    (0.0619, 26.9),
];

settings! {
    /// Where polyethylene begins to yield.
    FirstYield {
        /// Equivalent stress (von Mises) at which polyethylene begins to yield. The default is approximate: remembered rather than read.
        yield_stress_mpa: f64 = 14.0, in within(0.1, 10_000.0);
        /// Modulus of linear kinematic hardening: stress of the centre of the yield surface over plastic strain, in tension.
        kinematic_modulus_mpa: f64 = 0.0, in within(0.0, 10_000.0);
    }
}

/// Plasticity of von Mises with a table of isotropic hardening, and kinematic hardening beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct J2Plasticity {
    /// Yield stress and kinematic modulus.
    pub first: FirstYield,
    /// Points of the curve; none where the file gives none.
    pub hardening: Option<Vec<(f64, f64)>>,
}

/// A hardening curve that is none.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PlasticityReason {
    /// The points are no curve.
    #[error("`hardening`: {0}")]
    Hardening(HardeningError),
    /// The curve does not begin with the yield stress.
    #[error(
        "`hardening` starts at {found} MPa, and yield_stress_mpa is {yield_stress_mpa}: its first point must be [0.0, {yield_stress_mpa:?}]"
    )]
    NotFromYield {
        /// Stress of its first point, MPa.
        found: f64,
        /// The yield stress, MPa.
        yield_stress_mpa: f64,
    },
}

impl Reason for PlasticityReason {
    fn advice(&self) -> Option<String> {
        None
    }
}

variants! {
    /// Whether and how a deformable insert yields.
    PlasticityChoice by
    /// Whether a deformable insert yields.
    plasticity = "none" {
        /// It is elastic.
        None = "none",
        /// By von Mises, with hardening.
        J2(J2Plasticity) = "j2",
    }
}

impl PlasticityChoice {
    /// Returns the law with the insert's material: each choice creates its own.
    pub(crate) fn with_material(&self, law: Deformable, elastic: Elastic) -> Deformable {
        match self.hardening() {
            Some(hardening) => law.with_material(ElasticPlastic { elastic, hardening }),
            None => law.with_material(elastic),
        }
    }

    /// The yield stress, if the insert yields.
    pub(crate) fn hardening(&self) -> Option<Hardening> {
        match self {
            Self::None => None,
            Self::J2(j2) => j2.hardening().ok(),
        }
    }
}

impl J2Plasticity {
    fn hardening(&self) -> Result<Hardening, HardeningError> {
        let first_mpa = self.first.yield_stress_mpa;
        let points = self.hardening.clone().unwrap_or_else(|| {
            let beyond = CURVE.into_iter().filter(|point| point.1 > first_mpa);
            [(0.0, first_mpa)].into_iter().chain(beyond).collect()
        });
        Hardening::new(points, self.first.kinematic_modulus_mpa)
    }
}

impl Settings for J2Plasticity {
    fn keys() -> Vec<Key> {
        let hardening = Key {
            name: HARDENING,
            doc: "Points [plastic strain, yield stress in MPa] of isotropic hardening, rising from [0.0, yield_stress_mpa]; left out, what of [0.0099, 23.2], [0.0258, 25.1], [0.0434, 26.2], [0.0619, 26.9] is above the yield stress, from a model of polyethylene [bergstrom2010]. Approximate.".into(),
            kind: Kind::Pairs,
            silent: WhereSilent::LeftOut,
            limits: None,
        };
        [FirstYield::keys(), vec![hardening]].concat()
    }

    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let first = FirstYield::read(section, log)?;
        let Some(value) = section.value(HARDENING) else {
            return Some(Self {
                first,
                hardening: None,
            });
        };
        let placed = pairs(value, HARDENING, log)?;
        let points: Vec<(f64, f64)> = placed.iter().map(|&([p, s], _)| (p, s)).collect();
        let read = Self {
            hardening: Some(points),
            first,
        };
        let reason = read.checked().err();
        if let Some((point, reason)) = reason {
            let at = placed.get(point).map(|(_, span)| span.clone());
            log.problem(at.unwrap_or(value.span()), reason);
            return None;
        }
        Some(read)
    }

    fn write(&self, out: &mut Writer) {
        self.first.write(out);
        let Some(points) = &self.hardening else {
            return;
        };
        for key in Self::keys().iter().filter(|key| key.name == HARDENING) {
            out.comment(&key.doc);
            out.pairs(key.name, points);
        }
    }
}

impl J2Plasticity {
    /// Which point is wrong, and why.
    fn checked(&self) -> Result<(), (usize, PlasticityReason)> {
        let curve = self.hardening();
        curve.map_err(|error| (error.point, PlasticityReason::Hardening(error)))?;
        let first = self.hardening.as_ref().and_then(|points| points.first());
        let yield_stress_mpa = self.first.yield_stress_mpa;
        match first {
            Some(&(_, found)) if found != yield_stress_mpa => {
                let reason = PlasticityReason::NotFromYield {
                    found,
                    yield_stress_mpa,
                };
                Err((0, reason))
            }
            Some(_) | None => Ok(()),
        }
    }
}

settings! {
    /// How a backside rests on its tray.
    RestingBackside {
        /// Coulomb coefficient of friction between backside and tray. Assumed: the default is no measured one.
        backside_friction: f64 = 0.2, in within(0.0, 1000.0);
        /// Spacing of the points at which the motion of the backside is told; between them it is interpolated.
        backside_spacing_mm: f64 = 5.0, in within(1.0, 50.0);
    }
}

variants! {
    /// What holds the backside of a deformable insert on its tray.
    BacksideChoice by
    /// What holds the backside of a deformable insert on its tray: a bond, or the tray alone, off which it lifts and along which it slips with friction; some ten times the time, and the implicit integrator alone.
    backside = "bonded" {
        /// It neither lifts nor slips.
        Bonded = "bonded",
        /// It presses and sticks or slips, or lifts.
        Resting(RestingBackside) = "resting",
    }
}

impl BacksideChoice {
    /// What it stands for.
    pub fn backside(&self) -> Backside {
        match self {
            Self::Bonded => Backside::Bonded,
            Self::Resting(resting) => Backside::Resting {
                friction: resting.backside_friction,
                spacing_mm: resting.backside_spacing_mm,
            },
        }
    }

    /// Whether it rests.
    pub(crate) fn is_resting(&self) -> bool {
        matches!(self, Self::Resting(_))
    }
}
