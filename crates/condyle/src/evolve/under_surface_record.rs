//! What is below the surface of the insert at an increment of an update.

use serde::{Deserialize, Serialize};

use crate::{
    Vec3,
    contact::{BacksideAtRest, PlasticUnderSurface, Regime, UnderSurface},
    geometry::{ArticulatingSurface, Insert},
};

/// What is below the surface at the increment of an update with the highest pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnderSurfaceRecord {
    /// Which of the activities has it, from 0.
    pub activity: usize,
    /// Place in its cycle, %.
    pub percent: f64,
    /// Largest equivalent stress of von Mises, at the centre of an element, MPa.
    pub von_mises_mpa: f64,
    /// How deep below the surface that centre is, mm.
    pub von_mises_depth_mm: f64,
    /// Largest shear stress, at the centre of an element, MPa.
    pub max_shear_mpa: f64,
    /// How deep below the surface that centre is, mm.
    pub max_shear_depth_mm: f64,
    /// What has yielded, if the insert does.
    pub plastic: Option<PlasticRecord>,
    /// What the backside did in the last cycles, if it rests on its tray.
    pub backside: Option<BacksideAtRest>,
}

/// What of an insert has yielded after an update.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlasticRecord {
    /// How far the surface has given way for good at most, mm.
    pub max_permanent_set_mm: f64,
    /// Largest accumulated plastic strain.
    pub max_plastic_strain: f64,
    /// Elements that have yielded.
    pub yielded_elements: usize,
    /// Elements that yield in every cycle still.
    pub ratcheting_elements: usize,
}

impl UnderSurfaceRecord {
    /// What is most, at a place in the cycle of an activity; `surface` is that of the insert.
    pub(super) fn of(
        under: &UnderSurface,
        insert: &Insert,
        surface: &ArticulatingSurface,
        (activity, percent): (usize, f64),
    ) -> Self {
        let deepest = |values: &[f64]| {
            let most = values.iter().enumerate();
            let most = most.max_by(|a, b| a.1.total_cmp(b.1));
            most.map_or((0.0, 0.0), |(element, &value)| {
                (value, depth_mm(insert, surface, element))
            })
        };
        let (von_mises_mpa, von_mises_depth_mm) = deepest(&under.von_mises_mpa);
        let (max_shear_mpa, max_shear_depth_mm) = deepest(&under.max_shear_mpa);
        Self {
            activity,
            percent,
            von_mises_mpa,
            von_mises_depth_mm,
            max_shear_mpa,
            max_shear_depth_mm,
            plastic: under.plastic.as_ref().map(PlasticRecord::of),
            backside: under.backside,
        }
    }
}

impl PlasticRecord {
    fn of(plastic: &PlasticUnderSurface) -> Self {
        let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let in_regimes = |least: Regime| {
            let regimes = plastic.regime.iter();
            regimes.filter(|regime| **regime >= least).count()
        };
        Self {
            max_permanent_set_mm: most(&plastic.permanent_set_mm),
            max_plastic_strain: most(&plastic.plastic_strain),
            yielded_elements: in_regimes(Regime::ShakenDown),
            ratcheting_elements: in_regimes(Regime::Ratcheting),
        }
    }
}

/// How deep the centre of an element is below the surface at the node that is nearest, mm.
fn depth_mm(insert: &Insert, surface: &ArticulatingSurface, element: usize) -> f64 {
    let centre = insert.mesh().corners(element).iter().sum::<Vec3>() / 8.0;
    let apart = |place: &Vec3| (place - centre).norm_squared();
    let places = surface.positions.iter().zip(&surface.normals);
    let nearest = places.min_by(|a, b| apart(a.0).total_cmp(&apart(b.0)));
    nearest.map_or(0.0, |(place, normal)| (place - centre).dot(normal))
}
