//! The charts of a run: wear over the test, motions and loads over the cycle.
//!
//! Every chart is declared here once, as a [`Panel`]. Page and pictures draw it as SVG; the scene carries it to the page's
//! program, which draws it with a cursor and zoom.

use std::{borrow::Cow, sync::LazyLock};

use condyle_results::{
    CycleQuantity, JointKind, KNEE, MotionColumn,
    catalogue::{LAST_CYCLE_CONTACT_AREA_MM2, LAST_CYCLE_PEAK_PRESSURE_MPA},
    split_unit,
};

use crate::figure::{Axis, Curve, MEASURED, Panel};
use crate::number::{cycles_in_words, first_letter_large, printed_unit, significant};
use crate::results::{Results, Table};

const CYCLE_SIZE: (f64, f64) = (340.0, 206.0);
const TEST_SIZE: (f64, f64) = (480.0, 232.0);

/// A column of kinematics.csv as it is plotted.
#[derive(Clone)]
pub(crate) struct Channel {
    pub(crate) column: Cow<'static, str>,
    pub(crate) title: Cow<'static, str>,
    pub(crate) unit: &'static str,
    positive: Cow<'static, str>,
    from_zero: bool,
    pub(crate) min_span: f64,
}

/// The columns of kinematics.csv of a knee, in their order, for results without [`MotionColumn`]s, and measured ones.
static CHANNELS: LazyLock<Vec<Channel>> =
    LazyLock::new(|| KNEE.columns.iter().copied().map(Channel::of).collect());

impl Channel {
    fn of(quantity: CycleQuantity) -> Self {
        let column = KNEE.column(quantity);
        let from_zero = |title, unit, min_span| Self {
            column: Cow::Borrowed(column),
            title: Cow::Borrowed(title),
            unit,
            positive: Cow::Borrowed(""),
            from_zero: true,
            min_span,
        };
        match quantity {
            CycleQuantity::Position(index) => {
                let joint = KNEE.joint(index);
                Self {
                    unit: match joint.kind() {
                        JointKind::Rotation => "degrees",
                        JointKind::Translation => "mm",
                    },
                    positive: Cow::Borrowed(joint.positive),
                    from_zero: false,
                    ..from_zero(joint.title, "", joint.least_span)
                }
            }
            CycleQuantity::AxialForce => Self {
                positive: Cow::Borrowed("compression"),
                ..from_zero("Axial force", "N", 10.0)
            },
            CycleQuantity::ContactArea => from_zero("Contact area", "mm\u{b2}", 1.0),
            CycleQuantity::PeakPressure => from_zero("Peak pressure", "MPa", 1.0),
            CycleQuantity::RegionForce(region) => from_zero(KNEE.regions[region].title, "N", 10.0),
        }
    }

    /// Returns the column called `column`: a joint of the machine, or a load or contact.
    pub(crate) fn find(column: &str, motions: &[MotionColumn]) -> Option<Self> {
        let motion = motions.iter().find(|motion| motion.column == column);
        if let Some(MotionColumn {
            title, positive, ..
        }) = motion
        {
            let joint = Self::of_joint(column)?;
            return Some(Self {
                title: Cow::Owned(first_letter_large(title)),
                positive: Cow::Owned(positive.clone()),
                ..joint
            });
        }
        let known = CHANNELS.iter().find(|channel| channel.column == column);
        known.cloned().or_else(|| Self::of_joint(column))
    }

    /// Returns the column of a joint, or of a ligament's tension, by its name and unit.
    fn of_joint(column: &str) -> Option<Self> {
        let (name, _) = split_unit(column);
        let (unit, min_span) = match column.strip_prefix(name) {
            Some("_deg") => ("degrees", 1.0),
            Some("_mm") => ("mm", 0.1),
            Some("_n") => ("N", 10.0),
            _ => return None,
        };
        Some(Self {
            column: Cow::Owned(column.to_owned()),
            title: Cow::Owned(match unit {
                "N" => format!("Tension of {}", name.replace('_', " ")),
                _ => first_letter_large(&name.replace('_', " ")),
            }),
            unit,
            positive: Cow::Borrowed(""),
            from_zero: unit == "N",
            min_span,
        })
    }

    /// Returns the columns of a table of a cycle, in their order.
    pub(crate) fn all_of(table: &Table, motions: &[MotionColumn]) -> impl Iterator<Item = Self> {
        let names = table.names().iter();
        names.filter_map(|name| Self::find(name, motions))
    }

    pub(crate) fn panel(&self, curves: Vec<Curve>) -> Panel {
        Panel {
            id: format!("k-{}", self.column),
            group: "cycle".to_owned(),
            title: self.title.clone().into_owned(),
            unit: self.unit.to_owned(),
            positive: self.positive.clone(),
            x: Axis::PERCENT,
            x_unit: "%",
            size: CYCLE_SIZE,
            from_zero: self.from_zero,
            min_span: self.min_span,
            curves,
            desc: format!(
                "{} in {} against percent of the cycle; the table of ranges gives its extremes.",
                self.title, self.unit
            ),
            ..Panel::default()
        }
    }
}

/// The rows of one cycle in a table, and the number of cycles before it.
pub(crate) struct Cycle {
    pub(crate) cycles_before: f64,
    pub(crate) rows: Vec<usize>,
}

/// Returns the first and the last cycle of a table; one entry where it holds only one.
pub(crate) fn first_and_last(table: &Table) -> Vec<Cycle> {
    let rows = 0..table.rows();
    let Some(counts) = table.column("cycles") else {
        return vec![Cycle {
            cycles_before: 0.0,
            rows: rows.collect(),
        }];
    };
    let first = counts.iter().copied().fold(f64::INFINITY, f64::min);
    let last = counts.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let cycle = |cycles_before: f64| Cycle {
        cycles_before,
        rows: rows
            .clone()
            .filter(|&row| counts[row] == cycles_before)
            .collect(),
    };
    let mut ends = vec![first, last];
    ends.dedup();
    ends.into_iter().map(cycle).collect()
}

/// Captions of the first and of the last cycle; `None` without two cycles.
pub(crate) fn cycle_captions(table: &Table) -> Option<[String; 2]> {
    let ends = first_and_last(table);
    let caption = |cycle: &Cycle| match cycle.cycles_before {
        0.0 => String::from("unworn"),
        cycles => format!("after {} cycles", cycles_in_words(cycles)),
    };
    let [first, last] = ends.as_slice() else {
        return None;
    };
    Some([first, last].map(caption))
}

pub(crate) fn all(results: &Results) -> Vec<Panel> {
    let mut charts = wear(results);
    charts.extend(cycle(results));
    for (activity, table) in results.activities.iter().skip(1) {
        let table = table.iter();
        charts.extend(table.flat_map(|table| cycle_of(table, &activity.name, results.motions())));
    }
    charts
}

/// Motions and loads over the cycle of the first activity, with those measured.
pub(crate) fn cycle(results: &Results) -> Vec<Panel> {
    let table = results.kinematics.as_ref();
    let mut panels = table.map_or_else(Vec::new, |table| cycle_of(table, "", results.motions()));
    if let Some(measured) = &results.measured_kinematics {
        for panel in &mut panels {
            let column = panel.id.trim_start_matches("k-");
            let pairs = measured.column("percent").zip(measured.column(column));
            panel.curves.extend(pairs.map(|(percents, values)| {
                Curve::new(MEASURED, in_unit(percents, values, 1.0)).named("measured".to_owned())
            }));
        }
    }
    panels
}

/// Motions and loads over the cycle of a table; `activity` distinguishes its charts from those of others.
pub(crate) fn cycle_of(table: &Table, activity: &str, motions: &[MotionColumn]) -> Vec<Panel> {
    let Some(percent) = table.column("percent") else {
        return Vec::new();
    };
    let ends = first_and_last(table);
    let styles = match cycle_captions(table) {
        Some([first, last]) => vec![
            ("first", format!("first cycle, {first}")),
            ("last", format!("last cycle, {last}")),
        ],
        None => vec![("last", "cycle".to_owned())],
    };
    let panel = |channel: Channel| {
        let values = table.column(&channel.column)?;
        let curve = |(cycle, (class, name)): (&Cycle, &(&'static str, String))| {
            let rows = cycle.rows.iter();
            let points = rows.map(|&row| (percent[row], values[row])).collect();
            Curve::new(class, points).named(name.clone())
        };
        let panel = channel.panel(ends.iter().zip(&styles).map(curve).collect());
        let is_known = values.iter().any(|value| value.is_finite());
        is_known.then(|| Panel {
            id: format!("{}{activity}", panel.id),
            group: format!("{}{activity}", panel.group),
            ..panel
        })
    };
    Channel::all_of(table, motions).filter_map(panel).collect()
}

/// The columns of wear.csv that are plotted, with their titles.
const TEST_COLUMNS: [(&str, &str); 6] = [
    (MASS, "Mass loss"),
    ("max_depth_mm", "Maximum wear depth"),
    ("max_penetration_mm", "Deepest penetration, wear and creep"),
    ("max_unloaded_depth_mm", "Deepest place of an unloaded scan"),
    ("peak_pressure_mpa", "Peak pressure in the cycle"),
    ("peak_contact_area_mm2", "Largest contact area in the cycle"),
];

/// The column that specimens are weighed for.
const MASS: &str = "mass_loss_mg";

pub(crate) fn wear(results: &Results) -> Vec<Panel> {
    wear_up_to(results, cycles_of(results))
}

pub(crate) fn cycles_of(results: &Results) -> f64 {
    let table = results.wear.as_ref();
    let cycles = table.and_then(|table| table.column("cycles"));
    let cycles = cycles.unwrap_or_default().iter();
    cycles.copied().fold(0.0, f64::max)
}

/// Returns the points of a column of `wear.csv` in cycles, from the first cycle on; none if the table lacks it.
fn points_of(results: &Results, column: &str) -> Option<Vec<(f64, f64)>> {
    let table = results.wear.as_ref()?;
    let (ends, values) = (table.column("cycles")?, table.column(column)?);
    let last = match column {
        "peak_pressure_mpa" => &LAST_CYCLE_PEAK_PRESSURE_MPA,
        "peak_contact_area_mm2" => &LAST_CYCLE_CONTACT_AREA_MM2,
        _ => {
            // Wear is 0 before the first cycle.
            let is_later = ends.first().is_some_and(|end| *end > 0.0);
            let rows = ends.iter().copied().zip(values.iter().copied());
            return Some(
                is_later
                    .then_some((0.0, 0.0))
                    .into_iter()
                    .chain(rows)
                    .collect(),
            );
        }
    };
    // An update solves its cycle on the surface before it; only the summary has that of the last surface.
    let summary = results.summary.as_ref().filter(|_| !ends.is_empty());
    let last = summary
        .map(|summary| summary[last])
        .filter(|last| last.is_finite());
    let places = [0.0].into_iter().chain(ends.iter().copied());
    Some(places.zip(values.iter().copied().chain(last)).collect())
}

/// [`wear`] with an axis that ends at `cycles`.
pub(crate) fn wear_up_to(results: &Results, cycles: f64) -> Vec<Panel> {
    let (cycles_per_x, x_title) = match cycles {
        cycles if cycles >= 2e5 => (1e6, "million cycles"),
        cycles if cycles >= 2e3 => (1e3, "thousand cycles"),
        _ => (1.0, "cycles"),
    };
    let panel = |(column, title): (&'static str, &str)| {
        let unit = printed_unit(column);
        let points = points_of(results, column)?.into_iter();
        let points: Vec<_> = points.map(|(x, y)| (x / cycles_per_x, y)).collect();
        let end = format!("{}\u{a0}{unit}", significant(points.last()?.1, 3));
        let desc = format!(
            "{title} in {unit} against cycles, {} points; it ends at {end}.",
            points.len()
        );
        let mut curves = match column {
            MASS => weighed(results, cycles_per_x).unwrap_or_default(),
            _ => Vec::new(),
        };
        curves.push(Curve {
            name: title.to_owned(),
            end: Some(end),
            ..Curve::new("last", points).dotted()
        });
        Some(Panel {
            id: format!("w-{column}"),
            group: "wear".to_owned(),
            title: title.to_owned(),
            unit,
            x: Axis::covering(0.0, cycles / cycles_per_x, 1e-6, 5),
            x_title: x_title.to_owned(),
            cycles_per_x,
            size: TEST_SIZE,
            from_zero: true,
            min_span: f64::MIN_POSITIVE,
            curves,
            desc,
            ..Panel::default()
        })
    };
    TEST_COLUMNS.into_iter().filter_map(panel).collect()
}

fn weighed(results: &Results, cycles_per_x: f64) -> Option<Vec<Curve>> {
    let table = results.measured_wear.as_ref()?;
    let cycles = table.column("cycles")?;
    let specimens = table.names().iter().filter(|name| *name != "cycles");
    let curve = |(number, name): (usize, &String)| {
        let points = in_unit(cycles, table.column(name)?, cycles_per_x);
        let curve = Curve::new(MEASURED, points).dotted();
        Some(curve.named(format!("specimen {number}, weighed")))
    };
    Some((1..).zip(specimens).filter_map(curve).collect())
}

fn in_unit(xs: &[f64], values: &[f64], unit: f64) -> Vec<(f64, f64)> {
    let xs = xs.iter().map(|x| x / unit);
    xs.zip(values.iter().copied()).collect()
}
