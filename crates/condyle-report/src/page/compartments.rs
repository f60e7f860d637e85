//! Medial and lateral compared: what the report measures on the last mesh.

use condyle_results::{Side, catalogue::VOLUME_LOSS_MM3};

use serde::Serialize;

use crate::number::{fixed, significant};
use crate::results::{contents::Results, measure::Region, surface::SurfaceFields};

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
        volume_loss_mm3: volume_loss_mm3(results),
    };
    let Some(depth) = surface.field("wear_depth_mm") else {
        return Vec::new();
    };
    let mut all = sides.wear(depth);
    all.extend(sides.load());
    all.extend(sides.thinnest(depth));
    all
}

/// The surface, and its sides in the order of the columns.
struct Sides<'a> {
    surface: &'a SurfaceFields,
    regions: [Region; 3],
    /// What the run says of both sides, mm3.
    volume_loss_mm3: Option<f64>,
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
        const VOLUME: &str = "Volume loss, from depth, shared out by depth and area";
        let surface = self.surface;
        let scar = self.least_scar_depth_mm(depth);
        vec![
            self.compare("Maximum wear depth", "mm", |region| {
                largest(surface, depth, region)
            }),
            self.compare("at x, z", "mm", |region| deepest_at(surface, depth, region)),
            self.compare(VOLUME, "mm\u{b3}", |region| {
                significant(self.volume_mm3(depth, region), 3)
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

    /// Under the scar, which is what thinness is feared for, and anywhere, which may be the rim.
    fn thinnest(&self, depth: &[f64]) -> Vec<Comparison> {
        let Some(thickness) = self.surface.field("thickness_mm") else {
            return Vec::new();
        };
        let scar = self.least_scar_depth_mm(depth);
        let in_scar = |(&left, &worn): (&f64, &f64)| {
            if scar > 0.0 && worn > scar {
                left
            } else {
                f64::NAN
            }
        };
        let under_scar: Vec<f64> = thickness.iter().zip(depth).map(in_scar).collect();
        let least = |values: &[f64], region| thinnest(self.surface, values, region);
        vec![
            self.compare(
                "Thinnest polyethylene left, under the scar",
                "mm",
                |region| least(&under_scar, region),
            ),
            self.compare("Thinnest polyethylene left, anywhere", "mm", |region| {
                least(thickness, region)
            }),
        ]
    }

    /// Depth above which a place is part of the scar, mm.
    fn least_scar_depth_mm(&self, depth: &[f64]) -> f64 {
        let deepest = self.surface.largest(depth, Region::Whole);
        SCAR_SHARE * deepest.map_or(0.0, |found| found.value)
    }

    /// A region's part of the volume loss that the run states.
    ///
    /// Depth times area on the last mesh alone would be a little more: the surface of a dish grows as it
    /// goes down, and the run counts every update's depth on the area that it wore.
    fn volume_mm3(&self, depth: &[f64], region: Region) -> f64 {
        let on_last_mesh = |region| self.surface.integral(depth, region);
        let whole = on_last_mesh(Region::Whole);
        match self.volume_loss_mm3 {
            Some(stated) if whole > 0.0 => stated * on_last_mesh(region) / whole,
            Some(_) | None => on_last_mesh(region),
        }
    }
}

/// As the summary says; of a run that is not finished, as the last row of wear.csv says.
fn volume_loss_mm3(results: &Results) -> Option<f64> {
    let stated = results
        .summary
        .as_ref()
        .and_then(|summary| summary.get(&VOLUME_LOSS_MM3));
    stated.or_else(|| {
        results
            .wear
            .as_ref()?
            .column(VOLUME_LOSS_MM3.key)?
            .last()
            .copied()
    })
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
