//! The results of each update.

use serde::{Deserialize, Serialize};

use super::{Depths, rates::Rates};
use crate::{
    Vec3,
    contact::{BacksideAtRest, PlasticUnderSurface, Regime, UnderSurface},
    geometry::{ArticulatingSurface, Insert},
    machine::CycleRow,
    wear::MeanCycle,
};

/// Progress of a march.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Number of the update in progress, from 1.
    pub update: usize,
    /// Cycles solved for it.
    pub cycles_solved: f64,
    /// Cycles of the test done, including the solved part of the present interval.
    pub cycles: f64,
}

/// Results of one update.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UpdateRecord {
    /// Cycles done after it.
    pub cycles: f64,
    /// Volume worn so far, from depth times area, mm3.
    pub volume_loss_mm3: f64,
    /// Volume worn so far, from the change of the mesh without the volume of creep, mm3.
    pub volume_loss_mesh_mm3: f64,
    /// Mass worn so far, mg.
    pub mass_loss_mg: f64,
    /// Maximum depth of wear so far, mm.
    pub max_depth_mm: f64,
    /// Extremes of its cycles.
    pub peaks: CyclePeaks,
    /// Smallest scaled Jacobian of the worn mesh.
    pub worst_quality: f64,
    /// Creep so far, if the insert creeps.
    pub creep: Option<CreepRecord>,
}

/// Extremes of one solved cycle of every activity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CyclePeaks {
    /// Highest pressure, also between nodes, MPa.
    pub peak_pressure_mpa: f64,
    /// Largest contact area, mm2.
    pub contact_area_mm2: f64,
    /// Stress below the surface at the highest pressure, if the insert is a solid.
    pub under_surface: Option<UnderSurfaceRecord>,
}

/// The motions and loads of one solved cycle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleRecord {
    /// Cycles done before it.
    pub cycles: f64,
    /// One row per increment.
    pub rows: Vec<CycleRow>,
}

/// Results of an update at every node of the articulating surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeFields {
    /// Depth worn so far, mm.
    pub wear_depth_mm: Vec<f64>,
    /// Depth worn per cycle, mm.
    pub depth_per_cycle_mm: Vec<f64>,
    /// Highest pressure of the cycles, mean over the node's share, MPa.
    pub peak_pressure_mpa: Vec<f64>,
    /// Sliding distance under pressure per cycle, mm: S = sum of A'/A |ds|, with A' the loaded part of the
    /// node's share A; the mean over all activities by their shares.
    pub sliding_distance_mm: Vec<f64>,
    /// Cross-shear ratio of the mean cycle: part of pressure times slip across the principal direction, from 0
    /// for straight paths to 0.5.
    pub cross_shear: Vec<f64>,
    /// The principal direction, a unit vector along the surface in the insert frame that points anteriorly; 0
    /// where nothing slid, or equally in every direction.
    pub principal_direction: Vec<[f64; 3]>,
    /// Remaining thickness, mm.
    pub thickness_mm: Vec<f64>,
}

impl NodeFields {
    /// Creates the fields before the first update.
    pub(super) fn unworn(insert: &Insert, depths: &Depths) -> Self {
        let none = vec![0.0; insert.surface_nodes().len()];
        Self {
            wear_depth_mm: depths.wear_mm.clone(),
            depth_per_cycle_mm: none.clone(),
            peak_pressure_mpa: none.clone(),
            sliding_distance_mm: none.clone(),
            principal_direction: vec![[0.0; 3]; none.len()],
            cross_shear: none,
            thickness_mm: insert.thickness_mm().to_vec(),
        }
    }

    pub(super) fn new(
        cycles: &[MeanCycle<'_>],
        surface: &ArticulatingSurface,
        rates: &Rates,
        insert: &Insert,
        depths: &Depths,
    ) -> Self {
        let each = |value: fn(&MeanCycle<'_>) -> f64| cycles.iter().map(value).collect();
        let direction = |(node, cycle)| principal_direction(surface, node, cycle);
        Self {
            wear_depth_mm: depths.wear_mm.clone(),
            depth_per_cycle_mm: rates.depth_per_cycle_mm.clone(),
            peak_pressure_mpa: each(|cycle| cycle.peak_pressure_mpa),
            sliding_distance_mm: each(|cycle| cycle.pressed_distance_mm),
            cross_shear: each(|cycle| cycle.slip_work.cross_shear()),
            principal_direction: cycles.iter().enumerate().map(direction).collect(),
            thickness_mm: insert.thickness_mm().to_vec(),
        }
    }
}

fn principal_direction(
    surface: &ArticulatingSurface,
    node: usize,
    cycle: &MeanCycle<'_>,
) -> [f64; 3] {
    let Some([forwards, aside]) = cycle.slip_work.principal_direction() else {
        return [0.0; 3];
    };
    let [anterior, lateral] = surface.directions(node);
    (anterior * forwards + lateral * aside).into()
}

/// Creep so far, and the place of the deepest penetration by wear and creep together.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CreepRecord {
    /// Volume of creep, from depth times area, mm3; no mass is lost.
    pub volume_mm3: f64,
    /// Maximum depth of creep, mm.
    pub max_depth_mm: f64,
    /// Maximum penetration, wear and creep together, mm.
    pub max_penetration_mm: f64,
    /// Wear at that place, mm.
    pub wear_there_mm: f64,
    /// Creep at that place, mm.
    pub creep_there_mm: f64,
    /// Maximum depth in a scan after long rest without load, mm: wear and the permanent part of creep.
    pub max_unloaded_depth_mm: f64,
}

impl CreepRecord {
    /// Creates the record for these depths at every surface node and the volume of creep; `left_mm` remains on an
    /// unloaded insert.
    pub(super) fn new(volume_mm3: f64, wear_mm: &[f64], creep_mm: &[f64], left_mm: &[f64]) -> Self {
        let penetration = |node: usize| wear_mm[node] + creep_mm[node];
        let unloaded = |node: usize| wear_mm[node] + left_mm[node];
        let nodes = || 0..wear_mm.len();
        let deepest = nodes().max_by(|a, b| penetration(*a).total_cmp(&penetration(*b)));
        let at = |values: &[f64]| deepest.map_or(0.0, |node| values[node]);
        Self {
            volume_mm3,
            max_depth_mm: creep_mm.iter().copied().fold(0.0, f64::max),
            max_penetration_mm: deepest.map_or(0.0, penetration),
            wear_there_mm: at(wear_mm),
            creep_there_mm: at(creep_mm),
            max_unloaded_depth_mm: nodes().map(unloaded).fold(0.0, f64::max),
        }
    }
}

/// Stress below the surface at the increment with the highest pressure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnderSurfaceRecord {
    /// Number of the activity, from 0.
    pub activity: usize,
    /// Place in its cycle, %.
    pub percent: f64,
    /// Largest equivalent stress of von Mises, at the centre of an element, MPa.
    pub von_mises_mpa: f64,
    /// Depth of that centre below the surface, mm.
    pub von_mises_depth_mm: f64,
    /// Largest shear stress, at the centre of an element, MPa.
    pub max_shear_mpa: f64,
    /// Depth of that centre below the surface, mm.
    pub max_shear_depth_mm: f64,
    /// Plastic strain, if the insert yields.
    pub plastic: Option<PlasticRecord>,
    /// Motion of the backside in the last cycles, if it rests on its tray.
    pub backside: Option<BacksideAtRest>,
}

/// Plastic strain of an insert after its last solved cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlasticRecord {
    /// Maximum permanent deflection of the surface, mm.
    pub max_permanent_set_mm: f64,
    /// Largest accumulated plastic strain.
    pub max_plastic_strain: f64,
    /// Elements that have yielded.
    pub yielded_elements: usize,
    /// Elements that still yield in every cycle.
    pub ratcheting_elements: usize,
}

impl UnderSurfaceRecord {
    /// Creates the record of the stresses at a place in the cycle of an activity.
    pub(super) fn new(
        under: &UnderSurface,
        insert: &Insert,
        surface: &ArticulatingSurface,
        (activity, percent): (usize, f64),
    ) -> Self {
        // Depth of an element's centre below the surface at the nearest node.
        let depth_mm = |element: usize| {
            let centre = insert.mesh().corners(element).iter().sum::<Vec3>() / 8.0;
            let apart = |place: &Vec3| (place - centre).norm_squared();
            let places = surface.positions.iter().zip(&surface.normals);
            let nearest = places.min_by(|a, b| apart(a.0).total_cmp(&apart(b.0)));
            nearest.map_or(0.0, |(place, normal)| (place - centre).dot(normal))
        };
        let deepest = |values: &[f64]| {
            let most = values.iter().enumerate();
            let most = most.max_by(|a, b| a.1.total_cmp(b.1));
            most.map_or((0.0, 0.0), |(element, &value)| (value, depth_mm(element)))
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
            plastic: under.plastic.as_ref().map(PlasticRecord::new),
            backside: under.backside,
        }
    }
}

impl PlasticRecord {
    fn new(plastic: &PlasticUnderSurface) -> Self {
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
