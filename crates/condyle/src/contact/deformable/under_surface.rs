//! What is below the surface of a deformable insert.

use std::collections::BTreeMap;

use condyle_fem::{PlasticPoint, Stress};

use super::{
    elastic_surface::ElasticSurface,
    plastic::{Remembered, strains_of},
};
use crate::contact::under_surface::{PlasticUnderSurface, Regime, UnderSurface};

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
