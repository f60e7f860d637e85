//! Maps of two runs on one mesh: how far apart they are.

use serde::Serialize;

use super::run::Run;
use crate::page::MAPS;
use crate::results::{measure::Region, surface::SurfaceFields};

/// How far two maps are apart, in the unit of the field.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MapDifference {
    /// Name of the point data.
    pub field: &'static str,
    /// What people call it.
    pub title: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The difference, second less first, that is largest in size.
    pub largest: f64,
    /// Where it is, mm.
    pub x_mm: f64,
    /// Where it is, mm.
    pub z_mm: f64,
    /// Mean of its size over the surface.
    pub mean_absolute: f64,
    /// The largest in percent of the first map's largest value; none where that is 0.
    pub largest_percent: Option<f64>,
}

/// Every map that differs, the largest by its own largest value first; none where maps cannot be subtracted.
pub(super) fn maps(first: &Run, second: &Run) -> Vec<MapDifference> {
    if first.maps_apart(second).is_some() {
        return Vec::new();
    }
    let (Some(one), Some(two)) = (&first.results.surface, &second.results.surface) else {
        return Vec::new();
    };
    let map = |map: &crate::page::MapOf| map_apart(map, one, two);
    let mut maps: Vec<_> = MAPS.iter().filter_map(map).collect();
    let rank = |map: &MapDifference| map.largest_percent.map_or(f64::INFINITY, f64::abs);
    maps.sort_by(|one, two| rank(two).total_cmp(&rank(one)));
    maps
}

/// Second less first at every node.
pub(super) fn apart(one: &SurfaceFields, two: &SurfaceFields, field: &str) -> Option<Vec<f64>> {
    let pairs = two.field(field)?.iter().zip(one.field(field)?);
    Some(pairs.map(|(two, one)| two - one).collect())
}

fn map_apart(
    map: &crate::page::MapOf,
    one: &SurfaceFields,
    two: &SurfaceFields,
) -> Option<MapDifference> {
    let apart = apart(one, two, map.field)?;
    let sizes: Vec<f64> = apart.iter().map(|value| value.abs()).collect();
    let node = (0..sizes.len()).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b]))?;
    let everywhere = vec![1.0; sizes.len()];
    let area = one.integral(&everywhere, Region::Whole);
    let of = one.largest(one.field(map.field)?, Region::Whole)?.value;
    (sizes[node] > 0.0).then(|| MapDifference {
        field: map.field,
        title: map.title,
        unit: map.unit,
        largest: apart[node],
        x_mm: one.nodes[node].x,
        z_mm: one.nodes[node].z,
        mean_absolute: one.integral(&sizes, Region::Whole) / area,
        largest_percent: (of != 0.0).then(|| 100.0 * apart[node] / of),
    })
}
