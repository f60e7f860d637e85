//! Plots of studies over runs: a line over a reference or over a cloud of points.

use std::iter::once;

use crate::figure::{Axis, Curve, MEASURED, Panel, finite_range, run_class, sheet};
use crate::number::path_in_words;

/// A plot of one line with a dot at every point, of a reference line and of clouds of points; each may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plot {
    /// Title of the vertical axis.
    pub title: String,
    /// Unit of the vertical axis.
    pub unit: String,
    /// Title of the horizontal axis; may be empty.
    pub x_title: String,
    /// Ticks of the horizontal axis with their texts; round numbers if empty.
    pub x_marks: Vec<(f64, String)>,
    /// True if the vertical axis starts at 0.
    pub from_zero: bool,
    /// Minimum span of the vertical axis, so that noise does not fill the picture.
    pub min_span: f64,
    /// Points (x, y) of the reference line.
    pub reference: Vec<(f64, f64)>,
    /// Clouds of unconnected points (x, y), each in a colour of its own.
    pub clouds: Vec<Vec<(f64, f64)>>,
    /// Points (x, y) of the line.
    pub line: Vec<(f64, f64)>,
}

impl Plot {
    fn all(&self) -> impl Iterator<Item = &(f64, f64)> + Clone {
        let points = self.clouds.iter().flatten();
        self.reference.iter().chain(points).chain(&self.line)
    }

    /// Returns the panel; `span` is the minimum span of its vertical axis.
    fn panel(&self, columns: usize, span: f64) -> Panel {
        // More than two plots in a row are small, with few ticks, and their marks need room at the ends.
        let (size, intervals, room) = match columns {
            0 | 1 => ((480.0, 300.0), 5, 0.04),
            2 => ((480.0, 232.0), 5, 0.04),
            _ => ((236.0, 206.0), 4, 0.15),
        };
        let x = self.all().map(|point| point.0);
        let (low, high) = finite_range(x.clone()).unwrap_or((0.0, 1.0));
        let clouds = self.clouds.iter().enumerate().map(|(place, points)| {
            // A point with NaN after each keeps a line from joining the points.
            let points = points.iter().flat_map(|&(x, y)| [(x, y), (x, f64::NAN)]);
            Curve::new(cloud(place, self.clouds.len()), points.collect()).dotted()
        });
        let reference = Curve::new("first", self.reference.clone());
        let line = Curve::new("last", self.line.clone()).dotted();
        Panel {
            title: self.title.clone(),
            unit: self.unit.clone(),
            x: match self.x_marks.as_slice() {
                [] => Axis::covering(
                    low,
                    high,
                    // Round-off of a constant result must not fill the axis.
                    1e-9 * low.abs().max(high.abs()).max(1e-9),
                    intervals,
                ),
                _ => Axis::around(x, room),
            },
            x_marks: self.x_marks.clone(),
            x_title: short(&self.x_title),
            size,
            from_zero: self.from_zero,
            min_span: span,
            curves: once(reference).chain(clouds).chain([line]).collect(),
            ..Panel::default()
        }
    }
}

/// Returns the style of one of `clouds`.
fn cloud(place: usize, clouds: usize) -> &'static str {
    if clouds > 1 {
        run_class(place)
    } else {
        MEASURED
    }
}

/// Draws an SVG file of plots in rows of `columns`; `keys` names the reference, each cloud of points and the line.
///
/// Plots of the same title have vertical axes of the same length, so that small effects look small.
pub fn plots_svg(title: &str, plots: &[Plot], columns: usize, keys: &[&str]) -> String {
    let span = |plot: &Plot| {
        let same = plots.iter().filter(|other| other.title == plot.title);
        let ranges = same.filter_map(|one| finite_range(one.all().map(|point| point.1)));
        let largest = plot.all().map(|point| point.1.abs()).fold(0.0, f64::max);
        let span = ranges
            .map(|(low, high)| high - low)
            .fold(plot.min_span, f64::max);
        span.max(1e-6 * largest.max(1e-6))
    };
    let panels: Vec<Panel> = plots
        .iter()
        .map(|plot| plot.panel(columns, span(plot)))
        .collect();
    let name = |plot: &Plot| match plot.x_title.as_str() {
        "" => plot.title.clone(),
        across => format!("{} over {across}", plot.title),
    };
    let names: Vec<String> = plots.iter().map(name).collect();
    let clouds = keys.len() - 2;
    let of_clouds = (0..clouds).map(|own| cloud(own, clouds));
    let classes = once("first").chain(of_clouds).chain(["last"]);
    let is_used = |class: &str| {
        let mut curves = panels.iter().flat_map(|panel| &panel.curves);
        curves.any(|curve| curve.class == class && !curve.points.is_empty())
    };
    let key = classes.zip(keys.iter().copied());
    let key: Vec<_> = key.filter(|(class, _)| is_used(class)).collect();
    sheet(title, &names.join("; "), &panels, columns.max(1), &key)
}

/// Returns a key in words, cut to fit under a small picture.
fn short(key: &str) -> String {
    const MAX_LETTERS: usize = 32;
    let whole = path_in_words(key);
    if whole.chars().count() <= MAX_LETTERS {
        return whole;
    }
    whole
        .chars()
        .take(MAX_LETTERS - 1)
        .chain(['\u{2026}'])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(x_marks: Vec<(f64, String)>) -> Plot {
        Plot {
            title: "Depth & more".to_owned(),
            unit: "mm".to_owned(),
            x_title: "million cycles".to_owned(),
            x_marks,
            from_zero: true,
            min_span: 1e-6,
            reference: vec![(0.0, 1.0), (5.0, 2.0)],
            line: vec![(0.0, 0.0), (2.5, 1.2), (5.0, 2.0)],
            ..Plot::default()
        }
    }

    #[test]
    fn every_point_of_the_line_has_a_dot_and_text_is_escaped() {
        let svg = plots_svg(
            "A study",
            &[plot(Vec::new())],
            2,
            &["reference", "tests", "ours"],
        );
        // One more is in the key.
        assert_eq!(svg.matches("<circle").count(), 3 + 1);
        assert!(svg.contains("Depth &amp; more") && !svg.contains("Depth & more"));
        assert!(svg.contains(">reference<") && svg.contains(">ours<") && !svg.contains(">tests<"));
        assert!(roxmltree::Document::parse(&svg).is_ok());
    }

    #[test]
    fn marks_take_the_place_of_round_numbers() {
        let marks = vec![(0.0, "ten".to_owned()), (5.0, "twenty".to_owned())];
        let svg = plots_svg("A study", &[plot(marks)], 2, &["a", "b", "c"]);
        assert!(svg.contains(">ten<") && svg.contains(">twenty<") && !svg.contains(">3<"));
    }

    #[test]
    fn every_point_has_a_dot_and_no_line_joins_the_points() {
        let plot = Plot {
            title: "mass".to_owned(),
            unit: "mg".to_owned(),
            x_title: "friction & more".to_owned(),
            clouds: vec![vec![(1e-7, 2.0), (2e-7, 3.0), (3e-7, 1.0)]],
            ..Plot::default()
        };
        let svg = plots_svg("A study", &[plot], 3, &["", "tests", ""]);
        assert_eq!(svg.matches("<circle").count(), 3 + 1);
        assert!(roxmltree::Document::parse(&svg).is_ok());
        let points = svg
            .split("class=\"specimen\" d=\"")
            .nth(1)
            .unwrap_or_default();
        assert!(!points.split('"').next().unwrap_or_default().contains('l'));
    }

    #[test]
    fn several_clouds_have_colours_of_their_own_and_names() {
        let plot = Plot {
            clouds: vec![vec![(1.0, 2.0), (2.0, 3.0)], vec![(1.0, 4.0)]],
            ..Plot::default()
        };
        let svg = plots_svg("A study", &[plot], 1, &["", "flat", "deep", ""]);
        assert_eq!(svg.matches("class=\"dot run-1\"").count(), 2 + 1);
        assert_eq!(svg.matches("class=\"dot run-2\"").count(), 1 + 1);
        assert!(svg.contains(">flat<") && svg.contains(">deep<"));
    }
}
