//! Places inside the outline where no column may stand.

use std::fmt;

use super::{
    footprint::Footprint,
    outline::{Loop, Place},
};

/// A place inside the outline of an insert where no column of hexahedra may stand.
#[derive(Clone, Debug, PartialEq)]
pub struct Hole {
    /// Place of its middle, anterior, mm.
    pub x_mm: f64,
    /// The same to the right of a right knee, mm.
    pub z_mm: f64,
    /// Area seen from above, mm2.
    pub area_mm2: f64,
    /// Whether it goes through; if not, the surface is a wall there or the insert too thin.
    pub goes_through: bool,
    /// The line around it, places (x, z), mm.
    pub outline_mm: Vec<[f64; 2]>,
}

impl Hole {
    /// How far a place (x, z) is from the hole seen from above, mm; 0 inside.
    pub fn distance_mm(&self, place_mm: [f64; 2]) -> f64 {
        let points = self.outline_mm.iter().map(|&[x, z]| Place::new(x, z));
        let Some(outline) = Loop::through(points.collect()) else {
            return f64::INFINITY;
        };
        let place = Place::new(place_mm[0], place_mm[1]);
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
/// columns around bridge; bridges the others, with what stands in them, and returns them.
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
                outline_mm: outline.places_mm(),
            });
            footprint.bridge(&inside);
        } else {
            inside
                .into_iter()
                .for_each(|sample| footprint.fill_sample(sample));
        }
    }
    holes
}

/// Samples that a line goes round, and those beside them on which no column may stand, since the line is evened out.
fn samples_inside(footprint: &Footprint<'_>, outline: &Loop) -> Vec<usize> {
    let samples = &footprint.samples;
    let goes_round = |sample: &usize| {
        let (x, z) = samples.place_of_mm(*sample);
        outline.goes_round(&Place::new(x, z))
    };
    let mut inside: Vec<usize> = (0..samples.point_count()).filter(goes_round).collect();
    let mut is_inside = vec![false; samples.point_count()];
    inside.iter().for_each(|&sample| is_inside[sample] = true);
    let mut at = 0;
    while let Some(&sample) = inside.get(at) {
        at += 1;
        for beside in samples.around(sample) {
            let is_bare = !footprint.holds_sample(beside);
            if is_bare && !std::mem::replace(&mut is_inside[beside], true) {
                inside.push(beside);
            }
        }
    }
    inside.sort_unstable();
    inside
}
