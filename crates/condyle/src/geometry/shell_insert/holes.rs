//! Places inside the outline where no column may stand.

use std::fmt;

use super::{
    footprint::Footprint,
    outline::{Loop, Place},
};

/// A place inside the outline of an insert where no column of hexahedra may stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole {
    /// Place of its middle, anterior, mm.
    pub x_mm: f64,
    /// The same to the right of a right knee, mm.
    pub z_mm: f64,
    /// Area seen from above, mm2.
    pub area_mm2: f64,
    /// Whether it goes through; if not, the surface is a wall there or the insert too thin.
    pub goes_through: bool,
}

impl fmt::Display for Hole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.goes_through {
            "hole"
        } else {
            "wall or thin place"
        };
        let Self {
            x_mm,
            z_mm,
            area_mm2,
            ..
        } = self;
        write!(
            f,
            "{what} of {area_mm2:.1} mm2 at x {x_mm:.1}, z {z_mm:.1} mm"
        )
    }
}

/// Fills the holes of a footprint that are smaller than a hexahedron and do not go through, which the
/// columns around bridge, and returns the others.
pub fn holes(footprint: &mut Footprint<'_>, outlines: &[Loop], edge_mm: f64) -> Vec<Hole> {
    let mut holes = Vec::new();
    for outline in outlines.iter().filter(|outline| outline.area_mm2() < 0.0) {
        let inside = samples_inside(footprint, outline);
        let goes_through = inside.iter().any(|&sample| !footprint.meets_shell(sample));
        let area_mm2 = -outline.area_mm2();
        if goes_through || area_mm2 > edge_mm * edge_mm {
            let middle = outline.middle();
            holes.push(Hole {
                x_mm: middle[0],
                z_mm: middle[1],
                area_mm2,
                goes_through,
            });
        } else {
            inside
                .into_iter()
                .for_each(|sample| footprint.fill_sample(sample));
        }
    }
    holes
}

/// Samples on which no column may stand and which a line goes round.
fn samples_inside(footprint: &Footprint<'_>, outline: &Loop) -> Vec<usize> {
    let samples = &footprint.samples;
    let bare = (0..samples.point_count()).filter(|&sample| !footprint.holds_sample(sample));
    let goes_round = |sample: &usize| {
        let (x, z) = samples.place_of_mm(*sample);
        outline.goes_round(&Place::new(x, z))
    };
    bare.filter(goes_round).collect()
}
