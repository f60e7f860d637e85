//! Places inside the outline where no column may stand.

use std::fmt;

use super::{footprint::Footprint, grid::Place, outline::Loop};

/// A place inside the outline of an insert where no column of hexahedra may stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Hole {
    /// Place of its middle, anterior, mm.
    pub x_mm: f64,
    /// Place of its middle, to the right of a right knee, mm.
    pub z_mm: f64,
    /// Area seen from above, mm2.
    pub area_mm2: f64,
    /// True if the hole goes through the insert; otherwise the surface is a wall, or the insert is too thin.
    pub goes_through: bool,
    /// The line around it, places (x, z), mm.
    pub outline_mm: Vec<[f64; 2]>,
}

impl Hole {
    /// Returns the distance of a place (x, z) from the hole seen from above, mm; 0 inside.
    pub fn distance_mm(&self, place_mm: [f64; 2]) -> f64 {
        let points = self.outline_mm.iter().copied().map(Place::from);
        let Some(outline) = Loop::through(points.collect()) else {
            return f64::INFINITY;
        };
        let place = Place::from(place_mm);
        if outline.goes_round(&place) {
            0.0
        } else {
            outline.nearest(&place).1
        }
    }
}

impl fmt::Display for Hole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.goes_through {
            "hole"
        } else {
            "wall or thin place"
        };
        let (x, z) = (self.x_mm, self.z_mm);
        let area = self.area_mm2;
        write!(f, "{what} of {area:.1} mm2 at x {x:.1}, z {z:.1} mm")
    }
}

/// Fills the holes of a footprint that are smaller than a hexahedron and do not go through, since the
/// columns around bridge them; bridges the others, with what stands in them, and returns them.
pub(super) fn holes(footprint: &mut Footprint<'_>, outlines: &[Loop], edge_mm: f64) -> Vec<Hole> {
    let mut holes = Vec::new();
    for outline in outlines.iter().filter(|outline| outline.area_mm2() < 0.0) {
        let samples = &footprint.samples;
        let goes_round = |sample: &usize| outline.goes_round(&samples.place_of_mm(*sample));
        let inside = (0..samples.point_count()).filter(goes_round).collect();
        // The outline is smoothed, so that bare samples next to those inside belong to the hole too.
        let mut inside = samples.connected(inside, |other| !footprint.holds[other]);
        inside.sort_unstable();
        let goes_through = inside.iter().any(|&sample| !footprint.meets_shell[sample]);
        let area_mm2 = -outline.area_mm2();
        if goes_through || area_mm2 > edge_mm * edge_mm {
            let middle = outline.middle();
            holes.push(Hole {
                x_mm: middle[0],
                z_mm: middle[1],
                area_mm2,
                goes_through,
                outline_mm: outline.places_mm(),
            });
            footprint.bridge(&inside);
        } else {
            for sample in inside {
                footprint.holds[sample] = true;
            }
        }
    }
    holes
}
