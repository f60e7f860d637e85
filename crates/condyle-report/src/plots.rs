//! Plots of lines that stand alone, for studies over runs.

use crate::figure::{Axis, Curve, Panel, sheet};

/// Width and height of a plot, px.
const SIZE: (f64, f64) = (480.0, 232.0);
/// Plots beside each other.
const COLUMNS: usize = 2;
/// Steps of the horizontal axis, at most.
const MAX_INTERVALS: usize = 5;

/// A plot of one line with a dot at every point, and of another to hold it against.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What is plotted.
    pub title: String,
    /// Its unit.
    pub unit: String,
    /// What the horizontal axis shows; may be empty.
    pub x_title: &'static str,
    /// Ticks of the horizontal axis, where and their texts; round numbers if empty.
    pub x_marks: Vec<(f64, String)>,
    /// Whether the vertical axis starts at 0.
    pub from_zero: bool,
    /// The least that the vertical axis spans, so that noise does not fill the picture.
    pub least_span: f64,
    /// The line to hold it against, (x, y); may be empty.
    pub reference: Vec<(f64, f64)>,
    /// The line itself, (x, y).
    pub line: Vec<(f64, f64)>,
}

/// The text of an SVG file with `plots` two in a row; `keys` says what the reference and the line are.
pub fn plots_svg(title: &str, plots: &[Plot], keys: [&str; 2]) -> String {
    let panels: Vec<Panel> = plots.iter().enumerate().map(panel).collect();
    let names: Vec<&str> = plots.iter().map(|plot| plot.title.as_str()).collect();
    let desc = format!("{}: {}", title, names.join(", "));
    let key = [("first", keys[0]), ("last", keys[1])];
    let used = usize::from(plots.iter().all(|plot| plot.reference.is_empty()));
    sheet(title, &desc, &panels, COLUMNS, &key[used..])
}

fn panel((index, plot): (usize, &Plot)) -> Panel {
    Panel {
        id: format!("plot-{index}"),
        title: plot.title.clone(),
        unit: plot.unit.clone(),
        positive: String::new(),
        x: horizontal(plot),
        x_marks: plot.x_marks.clone(),
        x_unit: "",
        x_title: plot.x_title.to_owned(),
        size: SIZE,
        from_zero: plot.from_zero,
        least_span: plot.least_span,
        curves: vec![
            curve("first", &plot.reference, false),
            curve("last", &plot.line, true),
        ],
        desc: format!("{} in {}.", plot.title, plot.unit),
    }
}

fn curve(class: &'static str, points: &[(f64, f64)], dots: bool) -> Curve {
    Curve {
        class,
        points: points.to_vec(),
        dots,
        end: None,
    }
}

/// Round numbers around all points; with marks of its own, the tightest range with a little room.
fn horizontal(plot: &Plot) -> Axis {
    const ROOM: f64 = 0.04;
    let points = || plot.line.iter().chain(&plot.reference).map(|point| point.0);
    let low = points().fold(f64::INFINITY, f64::min);
    let high = points().fold(f64::NEG_INFINITY, f64::max);
    if plot.x_marks.is_empty() {
        return Axis::covering(low, high, 1e-6, MAX_INTERVALS);
    }
    let room = ROOM * (high - low).max(1e-6);
    let (low, high) = (low - room, high + room);
    Axis {
        low,
        high,
        step: high - low,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(x_marks: Vec<(f64, String)>) -> Plot {
        Plot {
            title: "Depth & more".to_owned(),
            unit: "mm".to_owned(),
            x_title: "million cycles",
            x_marks,
            from_zero: true,
            least_span: 1e-6,
            reference: vec![(0.0, 1.0), (5.0, 2.0)],
            line: vec![(0.0, 0.0), (2.5, 1.2), (5.0, 2.0)],
        }
    }

    #[test]
    fn every_point_of_the_line_has_a_dot_and_text_is_escaped() {
        let svg = plots_svg("A study", &[plot(Vec::new())], ["reference", "ours"]);
        assert_eq!(svg.matches("<circle").count(), 3);
        assert!(svg.contains("Depth &amp; more") && !svg.contains("Depth & more"));
        assert!(svg.contains(">reference<") && svg.contains(">ours<"));
        assert!(roxmltree::Document::parse(&svg).is_ok());
    }

    #[test]
    fn marks_take_the_place_of_round_numbers() {
        let marks = vec![(0.0, "ten".to_owned()), (5.0, "twenty".to_owned())];
        let svg = plots_svg("A study", &[plot(marks)], ["a", "b"]);
        assert!(svg.contains(">ten<") && svg.contains(">twenty<") && !svg.contains(">3<"));
    }
}
