//! Scatter plots of tests: scatter matrix, main effects, Pareto front.

use crate::figure::{Axis, Curve, Panel, sheet};

const MAX_INTERVALS: usize = 4;

/// A scatter plot with a line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    /// Title of the vertical axis.
    pub title: String,
    /// Unit of the vertical axis.
    pub unit: String,
    /// Title of the horizontal axis.
    pub across: String,
    /// Places and texts of the ticks of the horizontal axis; round numbers if empty.
    pub marks: Vec<(f64, String)>,
    /// The points; may be empty.
    pub points: Vec<(f64, f64)>,
    /// The line; may be empty.
    pub line: Vec<(f64, f64)>,
}

/// Returns the text of an SVG file with the clouds in rows of `columns`; `keys` names points and line.
pub fn clouds_svg(title: &str, clouds: &[Cloud], columns: usize, keys: [&str; 2]) -> String {
    let size = if columns > 2 {
        (236.0, 206.0)
    } else {
        (480.0, 300.0)
    };
    let panels: Vec<Panel> = clouds
        .iter()
        .enumerate()
        .map(|(index, one)| panel(index, one, span_of(clouds, &one.title), size))
        .collect();
    let names: Vec<String> = clouds
        .iter()
        .map(|one| format!("{} over {}", one.title, one.across))
        .collect();
    let key = [("specimen", keys[0]), ("last", keys[1])];
    let used: Vec<(&str, &str)> = key
        .into_iter()
        .filter(|(_, meaning)| !meaning.is_empty())
        .collect();
    sheet(title, &names.join("; "), &panels, columns.max(1), &used)
}

/// Returns the largest vertical span of the plots of one output: on axes of that length, small effects look small.
fn span_of(clouds: &[Cloud], title: &str) -> f64 {
    let own = clouds.iter().filter(|cloud| cloud.title == title);
    let span = |cloud: &Cloud| {
        let up = cloud.all().map(|point| point.1);
        let (low, high) = up.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), up| {
            (low.min(up), high.max(up))
        });
        (high - low).max(0.0)
    };
    own.map(span).fold(0.0, f64::max)
}

impl Cloud {
    fn all(&self) -> impl Iterator<Item = &(f64, f64)> {
        self.points.iter().chain(&self.line)
    }
}

fn panel(index: usize, cloud: &Cloud, span: f64, size: (f64, f64)) -> Panel {
    let all = || cloud.all();
    let low = all().map(|point| point.0).fold(f64::INFINITY, f64::min);
    let high = all().map(|point| point.0).fold(f64::NEG_INFINITY, f64::max);
    let (low, high) = if low <= high { (low, high) } else { (0.0, 1.0) };
    let up = all().map(|point| point.1.abs()).fold(0.0, f64::max);
    Panel {
        id: format!("cloud-{index}"),
        title: cloud.title.clone(),
        unit: cloud.unit.clone(),
        x: across(cloud, low, high),
        x_marks: cloud.marks.clone(),
        x_title: short(&cloud.across),
        size,
        from_zero: false,
        min_span: span.max(1e-6 * up.max(1e-6)),
        curves: vec![
            Curve::new("specimen", apart(&cloud.points)).dotted(),
            Curve::new("last", cloud.line.clone()).dotted(),
        ],
        desc: format!("{} over {}.", cloud.title, cloud.across),
        ..Panel::default()
    }
}

/// Returns the last word of a key, or two where the last is common to many keys, cut to fit under a small picture.
fn short(across: &str) -> String {
    const LONGEST: usize = 28;
    let mut words = across.rsplit('.');
    let last = words.next().unwrap_or(across);
    let whole = match words.next() {
        Some(before) if matches!(last, "scale" | "offset") => format!("{before}.{last}"),
        _ => last.to_owned(),
    };
    if whole.chars().count() <= LONGEST {
        return whole;
    }
    whole
        .chars()
        .take(LONGEST - 1)
        .chain(['\u{2026}'])
        .collect()
}

/// Returns an axis of round numbers, or of the marks with some room around them.
fn across(cloud: &Cloud, low: f64, high: f64) -> Axis {
    if cloud.marks.is_empty() {
        let span = 1e-9 * low.abs().max(high.abs()).max(1e-9);
        return Axis::covering(low, high, span, MAX_INTERVALS);
    }
    let room = 0.15 * (high - low).max(1e-6);
    Axis {
        low: low - room,
        high: high + room,
        step: high - low + 2.0 * room,
    }
}

/// Returns the points with a gap after each, so that no line connects them.
fn apart(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    points
        .iter()
        .flat_map(|point| [*point, (point.0, f64::NAN)])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_has_a_dot_and_no_line_joins_the_cloud() {
        let cloud = Cloud {
            title: "mass".to_owned(),
            unit: "mg".to_owned(),
            across: "friction & more".to_owned(),
            marks: Vec::new(),
            points: vec![(1e-7, 2.0), (2e-7, 3.0), (3e-7, 1.0)],
            line: Vec::new(),
        };
        let svg = clouds_svg("A study", &[cloud], 3, ["tests", ""]);
        assert_eq!(svg.matches("<circle").count(), 3);
        assert!(roxmltree::Document::parse(&svg).is_ok());
        let specimen = svg
            .split("class=\"specimen\" d=\"")
            .nth(1)
            .unwrap_or_default();
        assert!(!specimen.split('"').next().unwrap_or_default().contains('l'));
    }
}
