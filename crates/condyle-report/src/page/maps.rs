//! The fields of the last mesh as maps.

use serde::Serialize;

use super::slip::slip_map;
use crate::figure::{ColourRange, Map, Shades};
use crate::results::{contents::Results, surface::SurfaceFields};

/// A small map with its caption.
#[derive(Serialize)]
pub(super) struct Small {
    svg: String,
    caption: &'static str,
}

/// The map of wear depth; `None` without a mesh that carries it.
pub(crate) fn wear_map(results: &Results, px_per_mm: f64) -> Option<Map<'_>> {
    let surface = results.surface.as_ref()?;
    Some(Map {
        id: "map-wear",
        title: "Wear depth",
        unit: "mm",
        largest: "Deepest",
        ..plain(results, surface, "wear_depth_mm", px_per_mm)?
    })
}

/// The maps of peak pressure, of sliding distance and of cross-shear, and the slip paths.
pub(super) fn small(results: &Results, px_per_mm: f64) -> Vec<Small> {
    let Some(surface) = &results.surface else {
        return Vec::new();
    };
    let pressure = plain(results, surface, "peak_pressure_mpa", px_per_mm).map(|map| Map {
        id: "map-pressure",
        title: "Peak pressure",
        unit: "MPa",
        shades: Shades::Viridis,
        ..map
    });
    let sliding = plain(results, surface, "sliding_distance_mm", px_per_mm).map(|map| Map {
        id: "map-sliding",
        title: "Sliding distance",
        unit: "mm",
        shades: Shades::Cividis,
        ..map
    });
    let cross_shear = plain(results, surface, "cross_shear", px_per_mm).map(|map| Map {
        id: "map-cross-shear",
        title: "Cross-shear ratio",
        shades: Shades::Magma,
        ..map
    });
    let depth = |id, title, field| {
        plain(results, surface, field, px_per_mm).map(|map| Map {
            id,
            title,
            unit: "mm",
            largest: "Deepest",
            shades: Shades::Viridis,
            ..map
        })
    };
    let creep = depth("map-creep", "Creep", "creep_depth_mm");
    let set = depth("map-set", "Permanent set", "permanent_set_mm");
    let captions = [
        "Largest contact pressure that each node sees in one gait cycle, the mean over its share of the surface, last update.",
        "Distance that the femur slides over each place while it presses on it, in one gait cycle, last update.",
        "What part of pressure times sliding goes across the main direction at each place, last update: 0 where the femur slides to and fro on a line, 0.5 where it goes round a circle.",
        "How far creep has taken the surface down under load, last update; no mass is lost by it.",
        "How far yielding has taken the surface down for good, last update; wear is not in it.",
    ];
    let maps = [pressure, sliding, cross_shear, creep, set]
        .into_iter()
        .zip(captions);
    let maps = maps.filter_map(|(map, caption)| {
        Some(Small {
            svg: map?.svg(),
            caption,
        })
    });
    let paths = slip_map(results, px_per_mm).map(|svg| Small {
        svg,
        caption: "How the femur slides past the deepest place of each side and past four around it while they are pressed, in one gait cycle, last update; each about the dot of its place, at 0.4 of its length and 1.6 of its width, so that four times as wide as it is. The wider, the more cross-shear.",
    });
    maps.chain(paths).collect()
}

fn plain<'a>(
    results: &Results,
    surface: &'a SurfaceFields,
    field: &str,
    px_per_mm: f64,
) -> Option<Map<'a>> {
    Some(Map {
        id: "",
        title: "",
        unit: "",
        largest: "Highest",
        surface,
        values: surface.field(field)?,
        side: results.side,
        shades: Shades::Magma,
        range: ColourRange::Own,
        px_per_mm,
    })
}
