//! The wear test over cycles.

use crate::figure::{Axis, Curve, Panel};
use crate::number::significant;
use crate::results::{contents::Results, table::Table};

/// Width and height of a panel, px.
const SIZE: (f64, f64) = (480.0, 232.0);

/// A column of wear.csv as people call it.
struct Quantity {
    column: &'static str,
    title: &'static str,
    unit: &'static str,
    /// Whether it is 0 before the first cycle, by its meaning.
    starts_at_zero: bool,
}

const QUANTITIES: [Quantity; 6] = [
    Quantity {
        column: "mass_loss_mg",
        title: "Mass loss",
        unit: "mg",
        starts_at_zero: true,
    },
    Quantity {
        column: "max_depth_mm",
        title: "Maximum wear depth",
        unit: "mm",
        starts_at_zero: true,
    },
    Quantity {
        column: "max_penetration_mm",
        title: "Deepest penetration, wear and creep",
        unit: "mm",
        starts_at_zero: true,
    },
    Quantity {
        column: "max_unloaded_depth_mm",
        title: "Deepest place of a scan without load",
        unit: "mm",
        starts_at_zero: true,
    },
    Quantity {
        column: "peak_pressure_mpa",
        title: "Peak pressure in the cycle",
        unit: "MPa",
        starts_at_zero: false,
    },
    Quantity {
        column: "peak_contact_area_mm2",
        title: "Largest contact area in the cycle",
        unit: "mm\u{b2}",
        starts_at_zero: false,
    },
];

/// A panel for each quantity that the folder holds, mass loss and depth first.
pub(crate) fn panels(results: &Results) -> Vec<Panel> {
    panels_up_to(results, most_cycles(results))
}

/// The cycles at the last update.
pub(crate) fn most_cycles(results: &Results) -> f64 {
    let table = results.wear.as_ref();
    let cycles = table.and_then(|table| table.column("cycles"));
    cycles
        .unwrap_or_default()
        .iter()
        .copied()
        .fold(0.0, f64::max)
}

/// The same with an axis that goes to so many cycles.
pub(crate) fn panels_up_to(results: &Results, most: f64) -> Vec<Panel> {
    let Some(table) = &results.wear else {
        return Vec::new();
    };
    let panels = QUANTITIES.iter().filter_map(|quantity| {
        let mut panel = panel(quantity, table, most)?;
        if let (MASS, Some(measured)) = (quantity.column, &results.measured_wear) {
            // Below the run's own curve.
            panel
                .curves
                .splice(0..0, weighed(measured, CycleUnit::of(most).size));
        }
        Some(panel)
    });
    panels.collect()
}

/// The column that specimens are weighed for.
const MASS: &str = "mass_loss_mg";

/// What each specimen lost.
fn weighed(measured: &Table, unit: f64) -> Vec<Curve> {
    let Some(cycles) = measured.column("cycles") else {
        return Vec::new();
    };
    let specimens = measured.names().iter().filter(|name| *name != "cycles");
    let columns = specimens.filter_map(|name| measured.column(name));
    columns
        .map(|losses| Curve {
            class: "specimen",
            points: (cycles.iter().map(|cycles| cycles / unit))
                .zip(losses.iter().copied())
                .collect(),
            dots: true,
            end: None,
        })
        .collect()
}

fn panel(quantity: &Quantity, table: &Table, most: f64) -> Option<Panel> {
    let cycles = table.column("cycles")?;
    let unit = CycleUnit::of(most);
    let points = points(quantity, cycles, table.column(quantity.column)?, unit.size);
    let &(_, last) = points.last()?;
    let end = format!("{}\u{a0}{}", significant(last, 3), quantity.unit);
    let desc = format!(
        "{} in {} against cycles, {} points; it ends at {end}.",
        quantity.title,
        quantity.unit,
        points.len()
    );
    Some(Panel {
        id: format!("w-{}", quantity.column),
        title: quantity.title.to_owned(),
        unit: quantity.unit.to_owned(),
        positive: String::new(),
        x: Axis::covering(0.0, most / unit.size, 1e-6, 5),
        x_marks: Vec::new(),
        x_unit: "",
        x_title: unit.name,
        size: SIZE,
        from_zero: true,
        least_span: f64::MIN_POSITIVE,
        curves: vec![Curve {
            class: "last",
            points,
            dots: true,
            end: Some(end),
        }],
        desc,
    })
}

fn points(quantity: &Quantity, cycles: &[f64], values: &[f64], unit: f64) -> Vec<(f64, f64)> {
    let mut points: Vec<_> = cycles
        .iter()
        .zip(values)
        .map(|(c, v)| (c / unit, *v))
        .collect();
    let begins_later = points.first().is_some_and(|point| point.0 > 0.0);
    if quantity.starts_at_zero && begins_later {
        points.insert(0, (0.0, 0.0));
    }
    points
}

/// The unit in which cycles are counted on the axis.
struct CycleUnit {
    size: f64,
    name: &'static str,
}

impl CycleUnit {
    fn of(most: f64) -> Self {
        match most {
            most if most >= 2e5 => Self {
                size: 1e6,
                name: "million cycles",
            },
            most if most >= 2e3 => Self {
                size: 1e3,
                name: "thousand cycles",
            },
            _ => Self {
                size: 1.0,
                name: "cycles",
            },
        }
    }
}
