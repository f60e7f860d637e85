//! The fields of the last mesh as maps.

use condyle_results::Side;

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

/// A field that has a map, and how it is drawn.
#[derive(Clone, Copy)]
pub(crate) struct MapOf {
    id: &'static str,
    pub(crate) title: &'static str,
    pub(crate) unit: &'static str,
    largest: &'static str,
    shades: Shades,
    /// Name of the point data.
    pub(crate) field: &'static str,
    caption: &'static str,
}

const WEAR: MapOf = MapOf {
    id: "map-wear",
    title: "Wear depth",
    unit: "mm",
    largest: "Deepest",
    shades: Shades::Magma,
    field: "wear_depth_mm",
    caption: "",
};

/// All fields that have a map, in the order of the page.
pub(crate) static MAPS: [MapOf; 6] = [
    WEAR,
    MapOf {
        id: "map-pressure",
        title: "Peak pressure",
        unit: "MPa",
        largest: "Highest",
        shades: Shades::Viridis,
        field: "peak_pressure_mpa",
        caption: "Largest contact pressure that each node sees in one gait cycle, the mean over its share of the surface, last update.",
    },
    MapOf {
        id: "map-sliding",
        title: "Sliding distance",
        unit: "mm",
        largest: "Highest",
        shades: Shades::Cividis,
        field: "sliding_distance_mm",
        caption: "Distance that the femur slides over each place while it presses on it, in one gait cycle, last update.",
    },
    MapOf {
        id: "map-cross-shear",
        title: "Cross-shear ratio",
        unit: "",
        largest: "Highest",
        shades: Shades::Magma,
        field: "cross_shear",
        caption: "What part of pressure times sliding goes across the main direction at each place, last update: 0 where the femur slides to and fro on a line, 0.5 where it goes round a circle.",
    },
    MapOf {
        id: "map-creep",
        title: "Creep",
        unit: "mm",
        largest: "Deepest",
        shades: Shades::Viridis,
        field: "creep_depth_mm",
        caption: "How far creep has taken the surface down under load, last update; no mass is lost by it.",
    },
    MapOf {
        id: "map-set",
        title: "Permanent set",
        unit: "mm",
        largest: "Deepest",
        shades: Shades::Viridis,
        field: "permanent_set_mm",
        caption: "How far yielding has taken the surface down for good, last update; wear is not in it.",
    },
];

impl MapOf {
    /// The map of a surface; `None` without the field.
    pub(crate) fn drawn<'a>(
        &self,
        surface: &'a SurfaceFields,
        side: Side,
        px_per_mm: f64,
    ) -> Option<Map<'a>> {
        Some(Map {
            id: self.id,
            title: self.title,
            unit: self.unit,
            largest: self.largest,
            surface,
            values: surface.field(self.field)?,
            side,
            shades: self.shades,
            range: ColourRange::Own,
            px_per_mm,
        })
    }
}

/// The map of wear depth; `None` without a mesh that carries it.
pub(crate) fn wear_map(results: &Results, px_per_mm: f64) -> Option<Map<'_>> {
    WEAR.drawn(results.surface.as_ref()?, results.side, px_per_mm)
}

/// The maps of all fields but the wear depth, and the slip paths.
pub(super) fn small(results: &Results, px_per_mm: f64) -> Vec<Small> {
    let Some(surface) = &results.surface else {
        return Vec::new();
    };
    let maps = MAPS[1..].iter().filter_map(|map| {
        Some(Small {
            svg: map.drawn(surface, results.side, px_per_mm)?.svg(),
            caption: map.caption,
        })
    });
    let of_page = |map: &Map<'_>, desc: &str, over: &str| map.svg_with(desc, over);
    let paths = slip_map(results, px_per_mm, of_page).map(|svg| Small {
        svg,
        caption: "How the femur slides past the deepest place of each side and past four around it while they are pressed, in one gait cycle, last update; each about the dot of its place, at 0.4 of its length and 1.6 of its width, so that four times as wide as it is. The wider, the more cross-shear.",
    });
    maps.chain(paths).collect()
}
