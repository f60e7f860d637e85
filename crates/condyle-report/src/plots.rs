//! Plots of lines as a file, for studies over runs.

use crate::figure::{Axis, Curve, Panel, sheet};

/// Width and height of a plot, px.
const SIZE: (f64, f64) = (480.0, 232.0);
/// Plots in a row.
const COLUMNS: usize = 2;
/// Most steps of the horizontal axis.
const MAX_INTERVALS: usize = 5;

/// A plot of one line with a dot at every point, and of a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The quantity.
    pub title: String,
    /// Its unit.
    pub unit: String,
    /// Title of the horizontal axis; may be empty.
    pub x_title: &'static str,
    /// Ticks of the horizontal axis with their texts; round numbers if empty.
    pub x_marks: Vec<(f64, String)>,
    /// Whether the vertical axis starts at 0.
    pub from_zero: bool,
    /// The smallest span of the vertical axis, so that noise does not fill the picture.
    pub least_span: f64,
    /// The reference line, (x, y); may be empty.
    pub reference: Vec<(f64, f64)>,
    /// The line itself, (x, y).
    pub line: Vec<(f64, f64)>,
}

/// Draws an SVG file with `plots` two in a row; `keys` names the reference and the line.
pub fn plots_svg(title: &str, plots: &[Plot], keys: [&str; 2]) -> String {
    let panels: Vec<Panel> = plots.iter().map(panel).collect();
    let names: Vec<&str> = plots.iter().map(|plot| plot.title.as_str()).collect();
    let desc = format!("{}: {}", title, names.join(", "));
    let key = [("first", keys[0]), ("last", keys[1])];
    let has_no_reference = plots.iter().all(|plot| plot.reference.is_empty());
    let used = usize::from(has_no_reference);
    sheet(title, &desc, &panels, COLUMNS, &key[used..])
}

fn panel(plot: &Plot) -> Panel {
    let x = plot.line.iter().chain(&plot.reference).map(|point| point.0);
    Panel {
        title: plot.title.clone(),
        unit: plot.unit.clone(),
        x: match plot.x_marks.as_slice() {
            [] => Axis::over(x, 1e-6, MAX_INTERVALS),
            _ => Axis::around(x, 0.04),
        },
        x_marks: plot.x_marks.clone(),
        x_title: plot.x_title.to_owned(),
        size: SIZE,
        from_zero: plot.from_zero,
        min_span: plot.least_span,
        curves: vec![
            Curve::new("first", plot.reference.clone()),
            Curve::new("last", plot.line.clone()).dotted(),
        ],
        ..Panel::default()
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
