//! Medial and lateral compared: what the report measures on the last mesh.

use serde::Serialize;

use crate::number::{fixed, significant};
use crate::results::{Region, Results, Side, SurfaceFields};

/// Depth above which a face counts as part of the scar, as a share of the largest depth.
const SCAR_SHARE: f64 = 0.05;

/// A row: what, its unit, and its values for medial, lateral, both.
#[derive(Serialize)]
pub(super) struct Row {
    name: &'static str,
    unit: &'static str,
    values: [String; 3],
}

/// The rows of the table; none without a mesh that carries the wear depth.
pub(super) fn rows(results: &Results) -> Vec<Row> {
    let Some(surface) = &results.surface else {
        return Vec::new();
    };
    let Some(depth) = surface.field("wear_depth_mm") else {
        return Vec::new();
    };
    let regions = medial_lateral_both(results);
    let measure = |name, unit, of: &dyn Fn(Region) -> String| Row {
        name,
        unit,
        values: regions.map(of),
    };
    let scar = SCAR_SHARE
        * surface
            .largest(depth, Region::Whole)
            .map_or(0.0, |found| found.value);
    let mut rows = vec![
        measure("Maximum wear depth", "mm", &|region| {
            largest(surface, depth, region)
        }),
        measure("at x, z", "mm", &|region| place(surface, depth, region)),
        measure("Worn volume", "mm\u{b3}", &|region| {
            significant(surface.integral(depth, region), 3)
        }),
        measure(
            "Area of the wear scar, deeper than 5\u{a0}% of the maximum",
            "mm\u{b2}",
            &|region| fixed(surface.area_above(depth, scar, region), 0),
        ),
    ];
    for (field, name, unit) in [
        (
            "peak_pressure_mpa",
            "Highest pressure of a node in the last cycle",
            "MPa",
        ),
        (
            "sliding_distance_mm",
            "Longest sliding distance in a cycle",
            "mm",
        ),
    ] {
        if let Some(values) = surface.field(field) {
            rows.push(measure(name, unit, &|region| {
                largest(surface, values, region)
            }));
        }
    }
    if let Some(values) = surface.field("thickness_mm") {
        let thinnest = |region| thinnest(surface, values, region);
        rows.push(measure("Thinnest polyethylene left", "mm", &thinnest));
    }
    rows
}

fn thinnest(surface: &SurfaceFields, values: &[f64], region: Region) -> String {
    let found = surface.smallest_positive(values, region);
    found.map_or_else(String::new, |value| significant(value, 3))
}

fn medial_lateral_both(results: &Results) -> [Region; 3] {
    match results.side {
        Side::Right => [Region::Left, Region::Right, Region::Whole],
        Side::Left => [Region::Right, Region::Left, Region::Whole],
    }
}

fn largest(surface: &SurfaceFields, values: &[f64], region: Region) -> String {
    surface
        .largest(values, region)
        .map_or_else(String::new, |found| significant(found.value, 3))
}

fn place(surface: &SurfaceFields, values: &[f64], region: Region) -> String {
    let found = surface
        .largest(values, region)
        .filter(|found| found.value > 0.0);
    found.map_or_else(String::new, |found| {
        format!(
            "{}, {}",
            fixed(found.position.x, 1),
            fixed(found.position.z, 1)
        )
    })
}
