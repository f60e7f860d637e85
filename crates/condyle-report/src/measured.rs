//! Pictures of a run compared with measurements.

use std::borrow::Cow;

use condyle_results::{Directions, MotionColumn};

use crate::charts::Channel;
use crate::figure::{
    Axis, ColourRange, Curve, MEASURED, Map, MapStyle, Panel, largest_size, sheet, svg_file,
};
use crate::results::SurfaceFields;

/// Draws an SVG file with a row for each column of kinematics.csv: the curves on the left, predicted minus measured on the
/// right. The points of a column are (percent of the cycle, predicted, measured), in rising percent; `motions` are the joints of the
/// machine.
pub fn compared_kinematics_svg(
    title: &str,
    columns: &[(&str, &[[f64; 3]])],
    motions: &[MotionColumn],
) -> String {
    const SIZE: (f64, f64) = (430.0, 226.0);
    let row = |&(column, points): &(&str, &[[f64; 3]])| {
        let channel = Channel::find(column, motions)?;
        let line = |class, value: fn(&[f64; 3]) -> f64| Curve::new(class, with_gaps(points, value));
        let panel = |curves| Panel {
            size: SIZE,
            from_zero: false,
            // Differences are small: an axis as long as that of the channel would flatten them.
            min_span: channel.min_span / 5.0,
            ..channel.panel(curves)
        };
        let both = panel(vec![
            line("first", |point| point[2]),
            line("last", |point| point[1]),
        ]);
        let difference = Panel {
            title: format!("{}, predicted \u{2212} measured", channel.title),
            positive: Cow::default(),
            ..panel(vec![line("last", |point| point[1] - point[2])])
        };
        Some([both, difference])
    };
    let panels: Vec<Panel> = columns.iter().filter_map(row).flatten().collect();
    let key = [("first", "measured"), ("last", "predicted")];
    let desc = "Measured and predicted motions against percent of the cycle, and their difference.";
    sheet(title, desc, &panels, 2, &key)
}

/// Returns the points, with a break where instants are missing.
fn with_gaps(points: &[[f64; 3]], value: fn(&[f64; 3]) -> f64) -> Vec<(f64, f64)> {
    let steps = points.windows(2).map(|pair| pair[1][0] - pair[0][0]);
    let usual = steps.fold(f64::INFINITY, f64::min);
    let mut line = Vec::with_capacity(points.len());
    let mut before = f64::INFINITY;
    for point in points {
        // Half a step of tolerance for percents that are rounded.
        if point[0] - before > 1.5 * usual {
            line.push((f64::midpoint(before, point[0]), f64::NAN));
        }
        before = point[0];
        line.push((point[0], value(point)));
    }
    line
}

/// Draws an SVG file of mass loss, (cycles, mg): the soak-corrected specimens as dots, the ends of the line through all
/// weighings, and the prediction.
pub fn compared_wear_svg(
    specimens: &[Vec<(f64, f64)>],
    line: &[(f64, f64)],
    predicted: &[(f64, f64)],
) -> String {
    const DESC: &str = "Soak-corrected mass loss of each specimen, the line of least squares through all weighings, and the \
        predicted mass loss, in mg against million cycles.";
    let curve = |class, points: &[(f64, f64)]| {
        let points = points.iter().map(|(cycles, mg)| (cycles / 1e6, *mg));
        Curve::new(class, points.collect())
    };
    let mut curves = vec![curve("first", line)];
    let specimens = specimens.iter();
    curves.extend(specimens.map(|points| curve(MEASURED, points).dotted()));
    curves.push(curve("last", predicted));
    let all = curves.iter().flat_map(|curve| &curve.points);
    let most = all.map(|point| point.0).fold(0.0, f64::max);
    let panel = Panel {
        title: "Mass loss, soak-corrected".to_owned(),
        unit: "mg".to_owned(),
        x: Axis::covering(0.0, most, 1e-6, 6),
        x_title: "million cycles".to_owned(),
        size: (640.0, 360.0),
        from_zero: true,
        min_span: f64::MIN_POSITIVE,
        curves,
        ..Panel::default()
    };
    let key = [
        (MEASURED, "specimens"),
        ("first", "line through all"),
        ("last", "predicted"),
    ];
    sheet("Mass loss, weighed and predicted", DESC, &[panel], 1, &key)
}

/// Draws an SVG file with the maps of `predicted_mm`, `scanned_mm` and `difference_mm`, the first two in the same
/// colours; `None` where the surface lacks a field.
pub fn compared_surface_svg(surface: &SurfaceFields, directions: Directions) -> Option<String> {
    // Space between maps, px.
    const GAP: f64 = 18.0;
    let [predicted, scanned, difference] = [
        surface.field("predicted_mm")?,
        surface.field("scanned_mm")?,
        surface.field("difference_mm")?,
    ];
    let depth = ColourRange::UpTo(largest_size(predicted).max(largest_size(scanned)));
    let both_ways = ColourRange::BothWays(largest_size(difference));
    let map = |values, title, largest, shades, range| Map {
        style: MapStyle {
            id: "",
            title,
            unit: "mm",
            largest,
            shades,
        },
        surface,
        values,
        directions,
        range,
        px_per_mm: 5.0,
    };
    let title = "Scanned \u{2212} predicted";
    let maps = [
        map(predicted, "Predicted", "Deepest", colorous::MAGMA, depth),
        map(scanned, "Scanned", "Deepest", colorous::MAGMA, depth),
        map(difference, title, "Largest", colorous::RED_BLUE, both_ways),
    ];
    let (width, height) = maps[0].size();
    let place = |(index, map): (usize, &Map<'_>)| {
        let x = index as f64 * (width + GAP);
        format!(r#"<g transform="translate({x:.1} 0)">{}</g>"#, map.body())
    };
    let body: String = maps.iter().enumerate().map(place).collect();
    let desc = maps.each_ref().map(Map::desc).join(" ");
    let size = (3.0 * width + 2.0 * GAP, height);
    Some(svg_file(
        "Wear depth, predicted and scanned",
        &desc,
        size,
        &body,
    ))
}
