//! Histograms of outputs with their percentiles and limits.

use crate::figure::{Axis, Curve, Panel, sheet};

const SIZE: (f64, f64) = (480.0, 232.0);
const COLUMNS: usize = 2;
const MAX_INTERVALS: usize = 6;
/// Largest number of slices.
const MAX_SLICES: usize = 60;

/// The distribution of an output.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    /// The output.
    pub title: String,
    /// Its unit.
    pub unit: String,
    /// All values, smallest first.
    pub sorted: Vec<f64>,
    /// Marked percentiles.
    pub marks: Vec<f64>,
    /// Its limits.
    pub limits: Vec<f64>,
}

/// Returns the text of an SVG file with one panel per output.
pub fn distributions_svg(all: &[Distribution]) -> String {
    let panels: Vec<Panel> = all.iter().enumerate().map(panel).collect();
    let names: Vec<&str> = all.iter().map(|one| one.title.as_str()).collect();
    let desc = format!("How {} are distributed over the tests.", names.join(", "));
    let has_limits = all.iter().any(|one| !one.limits.is_empty());
    let key = [
        ("last", "tests"),
        ("specimen", "5, 50 and 95 %"),
        ("first", "limit"),
    ];
    let shown = if has_limits { 3 } else { 2 };
    sheet("Distributions", &desc, &panels, COLUMNS, &key[..shown])
}

fn panel((index, one): (usize, &Distribution)) -> Panel {
    let (low, high) = ends(one);
    let outline = outline(&one.sorted);
    let most = outline.iter().map(|point| point.1).fold(0.0, f64::max);
    let upright = |class, at: &f64| Curve::new(class, vec![(*at, 0.0), (*at, most)]);
    let mut curves: Vec<Curve> = one.limits.iter().map(|at| upright("first", at)).collect();
    curves.extend(one.marks.iter().map(|at| upright("specimen", at)));
    curves.push(Curve::new("last", outline));
    let desc = format!("Percent of the tests in slices of {}.", one.title);
    Panel {
        id: format!("distribution-{index}"),
        title: if one.unit.is_empty() {
            one.title.clone()
        } else {
            format!("{}, {}", one.title, one.unit)
        },
        unit: "% of tests".to_owned(),
        x: Axis::covering(low, high, 1e-9 * high.abs().max(1e-9), MAX_INTERVALS),
        size: SIZE,
        from_zero: true,
        min_span: 1e-6,
        curves,
        desc,
        ..Panel::default()
    }
}

/// Returns the ends of the axis around all values and limits.
fn ends(one: &Distribution) -> (f64, f64) {
    let ends = [one.sorted.first(), one.sorted.last()]
        .into_iter()
        .flatten();
    let all: Vec<f64> = ends.chain(&one.limits).copied().collect();
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if low <= high { (low, high) } else { (0.0, 1.0) }
}

/// Returns the outline of a histogram, % of the values in each slice; the number of slices is the root of the number
/// of values.
fn outline(sorted: &[f64]) -> Vec<(f64, f64)> {
    let (Some(low), Some(high)) = (sorted.first(), sorted.last()) else {
        return Vec::new();
    };
    let slices = ((sorted.len() as f64).sqrt().ceil() as usize).clamp(1, MAX_SLICES);
    let width = ((high - low) / slices as f64).max(1e-12 * high.abs().max(1e-300));
    let mut counts = vec![0.0; slices];
    for value in sorted {
        let slice = ((value - low) / width) as usize;
        counts[slice.min(slices - 1)] += 100.0 / sorted.len() as f64;
    }
    let mut points = vec![(*low, 0.0)];
    for (slice, count) in counts.into_iter().enumerate() {
        let left = low + slice as f64 * width;
        points.extend([(left, count), (left + width, count)]);
    }
    points.push((low + slices as f64 * width, 0.0));
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_all_tests_are_in_the_outline() {
        let sorted: Vec<f64> = (0..100).map(f64::from).collect();
        let outline = outline(&sorted);
        let sum: f64 = outline[1..outline.len() - 1]
            .iter()
            .step_by(2)
            .map(|point| point.1)
            .sum();
        assert!((sum - 100.0).abs() < 1e-9);
    }

    #[test]
    fn one_value_alone_and_none_are_drawn() {
        let of = |sorted| Distribution {
            title: "a".to_owned(),
            unit: String::new(),
            sorted,
            marks: Vec::new(),
            limits: vec![2.0],
        };
        let svg = distributions_svg(&[of(vec![1.0, 1.0]), of(Vec::new())]);
        assert!(roxmltree::Document::parse(&svg).is_ok() && !svg.contains("NaN"));
    }
}
