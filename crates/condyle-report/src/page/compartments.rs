//! Medial and lateral compared: what the report measures on the last mesh.

use serde::Serialize;

use crate::number::{fixed, significant};
use crate::results::{contents::Results, measure::Region, side::Side, surface::SurfaceFields};

/// Depth above which a face counts as part of the scar, as a share of the largest depth.
const SCAR_SHARE: f64 = 0.05;

/// A quantity of both sides: its unit, and its values for medial, lateral, both.
#[derive(Serialize)]
pub(super) struct Comparison {
    name: &'static str,
    unit: &'static str,
    values: [String; 3],
}

/// What the table compares; none without a mesh that carries the wear depth.
pub(super) fn comparisons(results: &Results) -> Vec<Comparison> {
    let Some(surface) = &results.surface else {
        return Vec::new();
    };
    let sides = Sides {
        surface,
        regions: medial_lateral_both(results),
    };
    let Some(depth) = surface.field("wear_depth_mm") else {
        return Vec::new();
    };
    let mut all = sides.wear(depth);
    all.extend(sides.load());
    all.extend(sides.thinnest());
    all
}

/// The surface, and its sides in the order of the columns.
struct Sides<'a> {
    surface: &'a SurfaceFields,
    regions: [Region; 3],
}

impl Sides<'_> {
    fn compare(
        &self,
        name: &'static str,
        unit: &'static str,
        measure: impl Fn(Region) -> String,
    ) -> Comparison {
        Comparison {
            name,
            unit,
            values: self.regions.map(measure),
        }
    }

    fn wear(&self, depth: &[f64]) -> Vec<Comparison> {
        const SCAR: &str = "Area of the wear scar, deeper than 5\u{a0}% of the maximum";
        let surface = self.surface;
        let deepest = surface.largest(depth, Region::Whole);
        let scar = SCAR_SHARE * deepest.map_or(0.0, |found| found.value);
        vec![
            self.compare("Maximum wear depth", "mm", |region| {
                largest(surface, depth, region)
            }),
            self.compare("at x, z", "mm", |region| deepest_at(surface, depth, region)),
            self.compare("Worn volume", "mm\u{b3}", |region| {
                significant(surface.integral(depth, region), 3)
            }),
            self.compare(SCAR, "mm\u{b2}", |region| {
                fixed(surface.area_above(depth, scar, region), 0)
            }),
        ]
    }

    fn load(&self) -> impl Iterator<Item = Comparison> {
        const FIELDS: [(&str, &str, &str); 2] = [
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
        ];
        FIELDS.into_iter().filter_map(|(field, name, unit)| {
            let values = self.surface.field(field)?;
            Some(self.compare(name, unit, |region| largest(self.surface, values, region)))
        })
    }

    fn thinnest(&self) -> Option<Comparison> {
        let values = self.surface.field("thickness_mm")?;
        let measure = |region| thinnest(self.surface, values, region);
        Some(self.compare("Thinnest polyethylene left", "mm", measure))
    }
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

fn deepest_at(surface: &SurfaceFields, values: &[f64], region: Region) -> String {
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
