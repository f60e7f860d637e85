//! The tables of the page that are computed from the results.

use std::borrow::Cow;

use super::numbers::unit_of;
use super::sentences::{not_estimated, reached};
use condyle_results::{ActivitySummary, ErrorParts, LawWear, Part, catalogue::VOLUME_LOSS_MM3};

use crate::charts::{Channel, first_and_last};
use crate::number::{first_letter_large, fixed, significant};
use crate::results::{Region, Results, SurfaceFields};

/// Depth above which a place counts as part of the scar, as a share of the largest depth.
const SCAR_SHARE: f64 = 0.05;

/// The fields of a cycle whose largest values are compared, with their names and units.
const LARGEST_OF_CYCLE: [(&str, &str, &str); 2] = [
    (
        "peak_pressure_mpa",
        "Highest pressure of a node in the last cycle",
        "MPa",
    ),
    (
        "sliding_distance_mm",
        "Longest sliding distance in the last cycle, mean of all activities by their shares",
        "mm",
    ),
];

/// The regions of the surface, compared.
pub(super) struct Regions {
    pub names: Vec<&'static str>,
    pub rows: Vec<Row>,
}

/// A quantity with its values, one a column.
pub(super) struct Row {
    pub name: String,
    pub unit: String,
    pub values: Vec<String>,
}

/// Ranges of a channel.
pub(super) struct Range {
    pub title: Cow<'static, str>,
    pub unit: &'static str,
    /// For the first and the last cycle: smallest value, its percent of the cycle, largest value, its percent.
    pub ends: Vec<[String; 4]>,
}

/// The table of discretisation errors, and its notes.
pub(super) struct Accuracy {
    pub parts: Vec<String>,
    pub rows: Vec<Row>,
    pub remedies: String,
    pub missing: Vec<String>,
}

/// Returns the regions of the surface compared on the last mesh; `None` without a mesh that has the wear depth.
pub(super) fn regions(results: &Results) -> Option<Regions> {
    let surface = results.surface.as_ref()?;
    let depth = surface.field("wear_depth_mm")?;
    let mut regions = Region::all_of(results.directions());
    // Medial comes first on both sides.
    regions.sort_by_key(|(_, name)| *name == "Lateral");
    match regions.len() {
        1 => regions[0].1 = "Value",
        _ => regions.push((Region::Whole, "Both")),
    }
    let deepest = surface.largest(depth, Region::Whole);
    let scar_mm = SCAR_SHARE * deepest.map_or(0.0, |found| found.value);
    let compare = |name: &str, unit: &str, value: &dyn Fn(Region) -> Option<String>| {
        let values = regions.iter().map(|(region, _)| value(*region));
        Row {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: values.map(Option::unwrap_or_default).collect(),
        }
    };
    let largest = |name: &str, unit: &str, values: &[f64]| {
        compare(name, unit, &|region| {
            let found = surface.largest(values, region)?;
            Some(significant(found.value, 3))
        })
    };
    let mut rows = vec![
        largest("Maximum wear depth", "mm", depth),
        compare("at x, z", "mm", &|region| {
            let found = surface.largest(depth, region)?;
            let (x, z) = (fixed(found.position.x, 1), fixed(found.position.z, 1));
            (found.value > 0.0).then(|| format!("{x}, {z}"))
        }),
        compare(
            "Volume loss from depth, divided between the regions by depth and area",
            "mm\u{b3}",
            &|region| Some(significant(volume_mm3(results, surface, depth, region), 3)),
        ),
        compare(
            "Area of the wear scar, deeper than 5\u{a0}% of the maximum",
            "mm\u{b2}",
            &|region| Some(fixed(surface.area_above(depth, scar_mm, region), 0)),
        ),
    ];
    for (field, name, unit) in LARGEST_OF_CYCLE {
        rows.extend(
            surface
                .field(field)
                .map(|values| largest(name, unit, values)),
        );
    }
    for (name, values) in thickness(surface, depth, scar_mm) {
        rows.push(compare(name, "mm", &|region| {
            Some(significant(surface.smallest_positive(&values, region)?, 3))
        }));
    }
    let names = regions.iter().map(|(_, name)| *name).collect();
    Some(Regions { names, rows })
}

/// Returns the thickness under the scar, where thinness matters, and anywhere, where the thinnest place may be the
/// rim.
fn thickness(
    surface: &SurfaceFields,
    depth: &[f64],
    scar_mm: f64,
) -> Vec<(&'static str, Vec<f64>)> {
    let Some(thickness) = surface.field("thickness_mm") else {
        return Vec::new();
    };
    let is_scar = |worn: f64| scar_mm > 0.0 && worn > scar_mm;
    let under = thickness.iter().zip(depth);
    let under = under.map(|(&left, &worn)| if is_scar(worn) { left } else { f64::NAN });
    vec![
        (
            "Thinnest polyethylene left, under the scar",
            under.collect(),
        ),
        ("Thinnest polyethylene left, anywhere", thickness.to_vec()),
    ]
}

/// Returns a region's part of the volume loss that the run states.
///
/// Depth times area on the last mesh alone would be a little more: the surface of a dish grows as it is worn, and the run
/// counts the depth of every update on the area that it wore.
fn volume_mm3(results: &Results, surface: &SurfaceFields, depth: &[f64], region: Region) -> f64 {
    let on_last_mesh = |region| surface.integral(depth, region);
    let whole = on_last_mesh(Region::Whole);
    match reached(results, &VOLUME_LOSS_MM3) {
        Some(stated) if whole > 0.0 => stated * on_last_mesh(region) / whole,
        _ => on_last_mesh(region),
    }
}

/// Returns the range of every channel in the first and in the last cycle; none without motions.
pub(super) fn ranges(results: &Results) -> Option<Vec<Range>> {
    let table = results.kinematics.as_ref()?;
    let percent = table.column("percent")?;
    let ends = first_and_last(table);
    let rows = Channel::all_of(table, results.motions()).filter_map(|channel| {
        let values = table.column(&channel.column)?;
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let ends = ends.iter().map(|cycle| {
            let rows = cycle.rows.iter().copied();
            let finite = rows.filter(|&row| values[row].is_finite());
            let low = finite.clone().min_by(by_value)?;
            let high = finite.max_by(by_value)?;
            Some([
                significant(values[low], 3),
                fixed(percent[low], 0),
                significant(values[high], 3),
                fixed(percent[high], 0),
            ])
        });
        Some(Range {
            ends: ends.collect::<Option<_>>()?,
            title: channel.title,
            unit: channel.unit,
        })
    });
    Some(rows.collect())
}

/// Returns cycles and wear in percent, wear, pressure, area and force of each activity; for knees its ranges and medial
/// share, too.
pub(super) fn activities(results: &Results) -> Vec<(&str, Vec<String>)> {
    let activities = results.activities.iter().map(|(activity, _)| activity);
    let mass_mg: f64 = activities.clone().map(|one| one.mass_loss_mg).sum();
    let row = |one: &ActivitySummary| {
        let of_all = [
            significant(100.0 * one.share_of_cycles, 3),
            significant(100.0 * one.mass_loss_mg / mass_mg, 3),
            significant(one.mass_loss_mg, 3),
            significant(one.peak_pressure_mpa, 3),
            fixed(one.peak_contact_area_mm2, 0),
            fixed(one.peak_axial_force_n, 0),
        ];
        let of_knees = one.knee.iter().flat_map(|knee| {
            [
                significant(knee.ap_range_mm, 3),
                significant(knee.ie_range_deg, 3),
                fixed(100.0 * knee.medial_load_share, 1),
            ]
        });
        of_all.into_iter().chain(of_knees).collect()
    };
    activities
        .map(|one| (one.name.as_str(), row(one)))
        .collect()
}

/// Returns each wear law with mass in a million cycles, mass, volume, depth, and the part outside of its fit.
pub(super) fn wear_laws(results: &Results) -> Vec<(&LawWear, [String; 5])> {
    let summary = results.summary.iter();
    let laws = summary.flat_map(|summary| &summary.wear_laws);
    let row = |law: &LawWear| {
        let outside = law.outside_of_fit_percent;
        let outside = outside.map(|percent| fixed(percent, 0));
        [
            significant(law.mass_loss_mg_per_million_cycles, 3),
            significant(law.mass_loss_mg, 3),
            significant(law.volume_loss_mm3, 3),
            significant(law.max_depth_mm, 3),
            outside.unwrap_or_else(|| "not known".to_owned()),
        ]
    };
    laws.map(|law| (law, row(law))).collect()
}

/// Returns the errors that the summary estimates; none if it has no estimate.
pub(super) fn accuracy(results: &Results) -> Option<Accuracy> {
    let error = results.summary.as_ref()?.error.as_ref()?;
    let parts = ErrorParts::default().parts().map(|(part, _)| part);
    let rows = error.quantities().flat_map(|quantity| {
        let name = first_letter_large(quantity.scalar.label);
        [
            row(&name, "%", quantity.percent),
            row(&name, &unit_of(quantity.scalar), quantity.in_unit),
        ]
    });
    let name = |part: Part| part.name().replace('_', " ");
    let names = parts
        .map(|part| first_letter_large(&name(part)))
        .into_iter();
    let remedies = parts.map(|part| {
        let remedy = match part {
            Part::Increments => "finer increments of the cycle",
            Part::Updates => "more updates of the shape",
            Part::Mesh => "shorter edges of the mesh",
            Part::SlipTolerance => "friction that sticks rather than creeps",
        };
        format!("{} by {remedy}", name(part))
    });
    Some(Accuracy {
        parts: names.chain(["Together".to_owned()]).collect(),
        rows: rows.collect(),
        remedies: remedies.join(", "),
        missing: not_estimated(results),
    })
}

fn row(name: &str, unit: &str, error: &ErrorParts) -> Row {
    let digits = |value: f64| match value.abs() {
        // The rounding of a part that is zero.
        size if size < 1e-9 => "0".to_owned(),
        size if size >= 0.1 && unit == "%" => fixed(value, 2),
        _ => significant(value, 2),
    };
    let parts = error.parts().into_iter().map(|(_, part)| part);
    let values = parts.chain([Some(error.total)]);
    let values = values.map(|value| value.map_or_else(|| String::from("unknown"), digits));
    Row {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: values.collect(),
    }
}
