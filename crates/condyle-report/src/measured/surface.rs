//! Predicted and scanned wear on the articulating surface, and their difference.

use condyle_results::Side;

use crate::figure::{ColourRange, Map, Shades, alone};
use crate::results::surface::SurfaceFields;

/// Scale of each map, px per mm.
const PX_PER_MM: f64 = 5.0;
/// Space between maps, px.
const GAP: f64 = 18.0;

/// The text of an SVG file with the maps of `predicted_mm`, `scanned_mm` and `difference_mm`, the
/// first two in the same colours; `None` where the surface lacks a field.
pub fn compared_surface_svg(surface: &SurfaceFields, side: Side) -> Option<String> {
    let depth_mm =
        largest(surface.field("predicted_mm")?).max(largest(surface.field("scanned_mm")?));
    let difference_mm = largest(surface.field("difference_mm")?);
    let depth = (Shades::Magma, ColourRange::UpTo(depth_mm));
    let difference = (Shades::RedBlue, ColourRange::BothWays(difference_mm));
    let maps = [
        map(
            surface,
            side,
            "predicted_mm",
            ["Predicted", "Deepest"],
            depth,
        )?,
        map(surface, side, "scanned_mm", ["Scanned", "Deepest"], depth)?,
        map(
            surface,
            side,
            "difference_mm",
            ["Scanned \u{2212} predicted", "Largest"],
            difference,
        )?,
    ];
    let (width, height) = maps[0].size();
    let beside = |(index, map): (usize, &Map<'_>)| {
        let x = index as f64 * (width + GAP);
        format!(r#"<g transform="translate({x:.1} 0)">{}</g>"#, map.body())
    };
    let body: String = maps.iter().enumerate().map(beside).collect();
    let whole = (3.0 * width + 2.0 * GAP, height);
    let desc: Vec<String> = maps.iter().map(Map::desc).collect();
    Some(alone(
        "Wear depth, predicted and scanned",
        &desc.join(" "),
        whole,
        &body,
    ))
}

/// The largest finite size of a value.
fn largest(values: &[f64]) -> f64 {
    let finite = values.iter().filter(|value| value.is_finite());
    finite.fold(0.0, |most, value| value.abs().max(most))
}

fn map<'a>(
    surface: &'a SurfaceFields,
    side: Side,
    field: &str,
    [title, largest]: [&'static str; 2],
    (shades, range): (Shades, ColourRange),
) -> Option<Map<'a>> {
    Some(Map {
        id: "",
        title,
        unit: "mm",
        largest,
        surface,
        values: surface.field(field)?,
        side,
        shades,
        range,
        px_per_mm: PX_PER_MM,
    })
}
