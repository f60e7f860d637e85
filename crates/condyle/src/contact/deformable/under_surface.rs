//! What is below the surface of a deformable insert.

use std::collections::BTreeMap;

use condyle_fem::{PlasticPoint, Stress};

use super::{
    backside::{BacksideMemory, Tray, rest},
    elastic_surface::ElasticSurface,
    plastic::{Remembered, strains_of},
};
use crate::contact::under_surface::{BacksideAtRest, PlasticUnderSurface, Regime, UnderSurface};

/// Stress under loads on nodes of the surface along the inward normals, N, and what has yielded, if the insert does.
pub(super) fn under_surface(
    surface: &ElasticSurface,
    remembered: Option<Remembered>,
    loads: &[(u32, f64)],
) -> UnderSurface {
    let points = remembered.as_ref().map(|remembered| &remembered.points);
    let strains = points.map_or_else(BTreeMap::new, strains_of);
    let moved_mm = surface.moved_by(loads, &strains);
    let stresses = surface.solid().stresses_with(&moved_mm, &strains);
    UnderSurface {
        von_mises_mpa: stresses.iter().map(Stress::von_mises).collect(),
        max_shear_mpa: stresses.iter().map(Stress::max_shear).collect(),
        plastic: remembered.map(|remembered| plastic(surface, &remembered)),
        backside: None,
    }
}

/// The same of an insert that rests on its tray, its backside at rest under the loads from where the activity of that
/// number left it; where it tips off, as if the backside stayed there.
pub(super) fn above_tray(
    surface: &ElasticSurface,
    tray: &Tray,
    friction: f64,
    memory: &BacksideMemory,
    (activity, loads): (usize, &[(u32, f64)]),
) -> UnderSurface {
    let left_mm = memory.start(activity, tray.freedoms());
    let forces_n = surface.forces_on_tray(tray, loads);
    let found = rest(tray, friction, &left_mm, &forces_n, &left_mm.clone().into());
    let moved_mm = found.map_or(left_mm, |rest| rest.moved_mm);
    let moved_mm = surface.moved_with_tray(loads, tray, &moved_mm);
    let stresses = surface.solid().stresses(&moved_mm);
    let cycle = &memory.last_cycles;
    UnderSurface {
        von_mises_mpa: stresses.iter().map(Stress::von_mises).collect(),
        max_shear_mpa: stresses.iter().map(Stress::max_shear).collect(),
        plastic: None,
        backside: Some(BacksideAtRest {
            lift_mm: cycle.lift_mm,
            lifted_part: cycle.lifted_part,
            slip_mm: cycle.slip_mm,
            lock_force_n: cycle.lock.force_n,
            lock_moment_nmm: cycle.lock.moment_nmm,
        }),
    }
}

fn plastic(surface: &ElasticSurface, remembered: &Remembered) -> PlasticUnderSurface {
    let elements = surface.solid().mesh().hexes.len();
    let mut plastic_strain = vec![0.0; elements];
    let mut regime = vec![Regime::Elastic; elements];
    for (&element, points) in &remembered.points {
        let largest = |largest: f64, point: &PlasticPoint| largest.max(point.accumulated);
        plastic_strain[element as usize] = points.iter().fold(0.0, largest);
        let flow = remembered.flow_in_cycle.get(&element).copied();
        regime[element as usize] = Regime::of_flow(flow.unwrap_or_default());
    }
    let set_mm = if remembered.points.is_empty() {
        vec![0.0; surface.along_normals(&surface.solid().mesh().nodes).len()]
    } else {
        surface.along_normals(&surface.moved_by(&[], &strains_of(&remembered.points)))
    };
    PlasticUnderSurface {
        permanent_set_mm: set_mm,
        plastic_strain,
        regime,
    }
}
