//! Weighed and predicted wear over cycles.

use crate::figure::{Axis, Curve, Panel, sheet};

/// Width and height, px.
const SIZE: (f64, f64) = (640.0, 360.0);
const MILLION: f64 = 1e6;

/// Soak-corrected and predicted mass loss against cycles.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedWear {
    /// (cycles, mg) of each specimen.
    pub specimens: Vec<Vec<(f64, f64)>>,
    /// (cycles, mg) at both ends of the line through all weighings.
    pub line: [(f64, f64); 2],
    /// (cycles, mg) of the prediction.
    pub predicted: Vec<(f64, f64)>,
}

/// The text of an SVG file: specimens as dots, their line, and the prediction.
pub fn compared_wear_svg(wear: &ComparedWear) -> String {
    let curve = |class, points: &[(f64, f64)], dots| Curve {
        class,
        points: in_millions(points),
        dots,
        end: None,
    };
    let mut curves = vec![curve("first", &wear.line, false)];
    let specimens = wear.specimens.iter();
    curves.extend(specimens.map(|points| curve("specimen", points, true)));
    curves.push(curve("last", &wear.predicted, false));
    let key = [
        ("specimen", "specimens"),
        ("first", "line through all"),
        ("last", "predicted"),
    ];
    sheet(
        "Mass loss, weighed and predicted",
        DESC,
        &[panel(curves)],
        1,
        &key,
    )
}

const DESC: &str = "Soak-corrected mass loss of each specimen, the line of least squares through all \
    weighings, and the predicted mass loss, in mg against million cycles.";

fn in_millions(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    points
        .iter()
        .map(|(cycles, mg)| (cycles / MILLION, *mg))
        .collect()
}

fn panel(curves: Vec<Curve>) -> Panel {
    let all = curves.iter().flat_map(|curve| &curve.points);
    let most = all.map(|point| point.0).fold(0.0, f64::max);
    Panel {
        id: String::new(),
        title: "Mass loss, soak-corrected".to_owned(),
        unit: "mg".to_owned(),
        positive: String::new(),
        x: Axis::covering(0.0, most, 1e-6, 6),
        x_marks: Vec::new(),
        x_unit: "",
        x_title: "million cycles".to_owned(),
        size: SIZE,
        from_zero: true,
        least_span: f64::MIN_POSITIVE,
        curves,
        desc: DESC.to_owned(),
    }
}
