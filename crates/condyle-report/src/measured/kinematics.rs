//! Measured and predicted motions over the cycle, and their difference.

use crate::figure::{Axis, Curve, Panel, sheet};
use crate::page::{PlottedColumn, channel};

/// Width and height of a panel, px.
const SIZE: (f64, f64) = (430.0, 226.0);

/// A column of kinematics.csv, predicted and measured at the same instants.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedCurve {
    /// Name of the column.
    pub column: &'static str,
    /// (percent of the cycle, predicted, measured), percent growing.
    pub points: Vec<[f64; 3]>,
}

/// The text of an SVG file: a row a column, the curves on the left, predicted minus measured on
/// the right.
pub fn compared_kinematics_svg(title: &str, curves: &[ComparedCurve]) -> String {
    let panels: Vec<Panel> = curves.iter().flat_map(row).collect();
    let key = [("first", "measured"), ("last", "predicted")];
    let desc =
        "Measured and predicted motions against percent of the gait cycle, and their difference.";
    sheet(title, desc, &panels, 2, &key)
}

fn row(curve: &ComparedCurve) -> Vec<Panel> {
    let Some(channel) = channel(curve.column) else {
        return Vec::new();
    };
    let line = |class, value: fn(&[f64; 3]) -> f64| Curve {
        class,
        points: unbroken(&curve.points, value),
        dots: false,
        end: None,
    };
    let both = vec![
        line("first", |point| point[2]),
        line("last", |point| point[1]),
    ];
    let error = vec![line("last", |point| point[1] - point[2])];
    vec![
        panel(channel, channel.title.to_owned(), channel.positive, both),
        panel(
            channel,
            format!("{}, predicted \u{2212} measured", channel.title),
            "",
            error,
        ),
    ]
}

/// The points, with a break where instants are missing.
fn unbroken(points: &[[f64; 3]], value: fn(&[f64; 3]) -> f64) -> Vec<(f64, f64)> {
    let steps = points.windows(2).map(|pair| pair[1][0] - pair[0][0]);
    let usual = steps.fold(f64::INFINITY, f64::min);
    let mut line = Vec::with_capacity(points.len());
    let mut before = f64::INFINITY;
    for point in points {
        if point[0] - before > 1.5 * usual {
            line.push((f64::midpoint(before, point[0]), f64::NAN));
        }
        before = point[0];
        line.push((point[0], value(point)));
    }
    line
}

fn panel(channel: &PlottedColumn, title: String, positive: &str, curves: Vec<Curve>) -> Panel {
    Panel {
        id: String::new(),
        desc: format!("{title} in {}.", channel.unit),
        title,
        unit: channel.unit.to_owned(),
        positive: positive.to_owned(),
        x: Axis {
            low: 0.0,
            high: 100.0,
            step: 20.0,
        },
        x_marks: Vec::new(),
        x_unit: "%",
        x_title: String::new(),
        size: SIZE,
        from_zero: false,
        least_span: channel.least_span / 5.0,
        curves,
    }
}
