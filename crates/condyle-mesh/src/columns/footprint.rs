//! The places where columns may stand: where a body is thick enough below a surface that is not a wall.

use super::{
    grid::ColumnGrid,
    vertical_lines::{Bridges, Through, VerticalLines},
};
use crate::triangle_mesh::TriangleMesh;

/// A shell that is thinner than this share of the median is the wedge of a chamfer, which has no layer of its
/// own below it: its columns would be stiffer than it is.
const THINNEST_SHARE: f64 = 0.15;
/// A surface that rises by more than 1.5 edges over one, 56 degrees, is the side of the insert, and no
/// longer articulates.
const MIN_UPWARD: f64 = 0.555;
/// The shell is looked at this often along an edge of a hexahedron, ...
const SAMPLES_PER_EDGE: f64 = 4.0;
/// ... but no closer than this, mm, which no outline needs.
const CLOSEST_SAMPLES_MM: f64 = 0.1;
/// Chips, slits and teeth of the outline up to twice as many samples wide are no part of it.
const DETAIL_SAMPLES: usize = 2;
/// Teeth that are narrower than twice as many samples, an edge, and longer than [`LONGEST_TOOTH_SAMPLES`], are no part
/// of the outline either: the ring of quads along it would not reach into them.
const TOOTH_SAMPLES: usize = 4;
/// One and a half edges: the tip of a square corner, however it is turned, is shorter.
const LONGEST_TOOTH_SAMPLES: usize = 6;

/// So many samples around the shell that what is evened out never reaches the last of them.
const MARGIN_SAMPLES: usize = 2 * DETAIL_SAMPLES + 1;

/// The part of the transverse plane in which columns may stand.
pub struct Footprint<'a> {
    lines: VerticalLines<'a>,
    thinnest_mm: f64,
    /// Points at which it is sampled, with a margin around the shell.
    pub samples: ColumnGrid,
    meets_shell: Vec<bool>,
    holds: Vec<bool>,
    bridges: Bridges,
}

impl<'a> Footprint<'a> {
    /// That of a shell that is to be filled with hexahedra with edges of `edge_mm`.
    pub fn new(shell: &'a TriangleMesh, is_closed: bool, edge_mm: f64) -> Self {
        let lines = VerticalLines::new(shell, is_closed);
        let samples = samples_around(shell, edge_mm);
        let numbers = 0..samples.point_count();
        let through: Vec<_> = numbers.map(|n| lines.at(samples.place_of_mm(n))).collect();
        let mut footprint = Self {
            lines,
            thinnest_mm: THINNEST_SHARE * median_thickness_mm(&through),
            samples,
            meets_shell: through.iter().map(Option::is_some).collect(),
            holds: Vec::new(),
            bridges: Bridges::default(),
        };
        let may_stand = |through: &Option<Through>| footprint.may_stand(*through);
        let holds: Vec<bool> = through.iter().map(may_stand).collect();
        let evened = without_details(&footprint.samples, &holds, DETAIL_SAMPLES);
        footprint.holds = without_teeth(
            &footprint.samples,
            &evened,
            TOOTH_SAMPLES,
            LONGEST_TOOTH_SAMPLES,
        );
        footprint
    }

    /// What the vertical line over a place meets.
    pub fn through(&self, place_mm: (f64, f64)) -> Option<Through> {
        let bridge = self.bridges.at(&self.samples, place_mm);
        bridge.or_else(|| self.lines.at(place_mm))
    }

    /// Whether the vertical line through a sample meets the shell.
    pub fn meets_shell(&self, sample: usize) -> bool {
        self.meets_shell[sample]
    }

    /// Whether a column may stand on a sample.
    pub fn holds_sample(&self, sample: usize) -> bool {
        self.holds[sample]
    }

    /// Lets columns stand on some samples as if the shell went on smoothly from around them.
    pub fn bridge(&mut self, samples: &[usize]) {
        for &sample in samples {
            self.holds[sample] = true;
        }
        let height = |sample: usize| {
            let through = self.lines.at(self.samples.place_of_mm(sample));
            through.map(|through| [through.bottom, through.top])
        };
        self.bridges.add(&self.samples, samples, height);
    }

    /// Lets a column stand on a sample.
    pub fn fill_sample(&mut self, sample: usize) {
        self.holds[sample] = true;
    }

    /// Whether a column may stand on the sample nearest to a place.
    pub fn holds_near(&self, place_mm: (f64, f64)) -> bool {
        let nearest = |value: f64, low: f64, step: f64, cells: usize| {
            (((value - low) / step).round().max(0.0) as usize).min(cells)
        };
        let ColumnGrid {
            origin_mm,
            step_mm,
            cells,
        } = self.samples;
        let i = nearest(place_mm.0, origin_mm.0, step_mm.0, cells.0);
        let k = nearest(place_mm.1, origin_mm.1, step_mm.1, cells.1);
        self.holds[self.samples.number(i, k)]
    }

    /// Whether a column may stand at a place.
    pub fn holds(&self, place_mm: (f64, f64)) -> bool {
        self.may_stand(self.through(place_mm))
    }

    /// The same without a try beside the place, which would be a hair too wide.
    pub fn holds_exactly(&self, place_mm: (f64, f64)) -> bool {
        self.may_stand(self.lines.exactly_at(place_mm))
    }

    fn may_stand(&self, through: Option<Through>) -> bool {
        let is_wall = |through: &Through| through.upward < MIN_UPWARD;
        let is_thin = |through: &Through| through.top - through.bottom < self.thinnest_mm;
        through.is_some_and(|through| !is_wall(&through) && !is_thin(&through))
    }
}

/// A grid of samples whose lines lie on the bounds of the shell.
fn samples_around(shell: &TriangleMesh, edge_mm: f64) -> ColumnGrid {
    let (low, high) = shell.bounds();
    let wished_mm = (edge_mm / SAMPLES_PER_EDGE).max(CLOSEST_SAMPLES_MM);
    let cells = |length: f64| (length / wished_mm).ceil().max(1.0);
    let (nx, nz) = (cells(high.x - low.x), cells(high.z - low.z));
    let step = ((high.x - low.x) / nx, (high.z - low.z) / nz);
    ColumnGrid {
        origin_mm: (
            low.x - MARGIN_SAMPLES as f64 * step.0,
            low.z - MARGIN_SAMPLES as f64 * step.1,
        ),
        step_mm: step,
        cells: (
            nx as usize + 2 * MARGIN_SAMPLES,
            nz as usize + 2 * MARGIN_SAMPLES,
        ),
    }
}

/// Half of the columns are thinner; 0 for an open surface, which has no thickness.
fn median_thickness_mm(through: &[Option<Through>]) -> f64 {
    let all = through.iter().flatten();
    let mut thickness: Vec<f64> = all.map(|through| through.top - through.bottom).collect();
    thickness.sort_unstable_by(f64::total_cmp);
    thickness.get(thickness.len() / 2).copied().unwrap_or(0.0)
}

/// Takes away what of some samples is narrower than `2 reach + 1` of them, and fills what is narrower
/// between them: an opening and a closing by a square.
pub fn without_details(samples: &ColumnGrid, holds: &[bool], reach: usize) -> Vec<bool> {
    let grown = |of: &[bool]| spread(samples, of, reach, true);
    let shrunk = |of: &[bool]| spread(samples, of, reach, false);
    let opened = grown(&shrunk(holds));
    shrunk(&grown(&opened))
}

/// Takes away teeth: what sticks out of the rest, is narrower than `2 reach + 1` samples, and longer than `longest`.
///
/// Corners, which no square of samples fills to the tip, are shorter, and stay.
pub fn without_teeth(
    samples: &ColumnGrid,
    holds: &[bool],
    reach: usize,
    longest: usize,
) -> Vec<bool> {
    let shrunk = spread(samples, holds, reach, false);
    let body = spread(samples, &shrunk, reach, true);
    let near = spread(samples, &body, longest, true);
    let mut kept = holds.to_vec();
    for first in 0..holds.len() {
        if kept[first] && !near[first] {
            let piece = piece_beside(samples, &kept, &body, first);
            // What nothing holds together with the rest is no tooth of it.
            if piece.touches_body {
                piece.samples.iter().for_each(|&n| kept[n] = false);
            }
        }
    }
    kept
}

/// Samples that hang together outside of a body.
struct Piece {
    samples: Vec<usize>,
    touches_body: bool,
}

/// The piece of what is held, less a body, to which a sample belongs.
fn piece_beside(samples: &ColumnGrid, holds: &[bool], body: &[bool], first: usize) -> Piece {
    let mut piece = Piece {
        samples: vec![first],
        touches_body: false,
    };
    let mut is_found = vec![false; holds.len()];
    is_found[first] = true;
    let mut at = 0;
    while let Some(&n) = piece.samples.get(at) {
        at += 1;
        for other in samples.around(n).filter(|&other| holds[other]) {
            piece.touches_body |= body[other];
            if !body[other] && !std::mem::replace(&mut is_found[other], true) {
                piece.samples.push(other);
            }
        }
    }
    piece
}

/// Lets samples that are `value` spread by `reach` samples along both axes.
fn spread(samples: &ColumnGrid, of: &[bool], reach: usize, value: bool) -> Vec<bool> {
    let along_z = samples.cells.1 + 1;
    let along = |of: &[bool], stride: usize, place: &dyn Fn(usize) -> (usize, usize)| {
        let mut spread = of.to_vec();
        for (n, spread) in spread.iter_mut().enumerate() {
            let (at, count) = place(n);
            let first = n - stride * at.min(reach);
            let steps = at.min(reach) + (count - 1 - at).min(reach);
            if (0..=steps).any(|step| of[first + stride * step] == value) {
                *spread = value;
            }
        }
        spread
    };
    let along_x = samples.cells.0 + 1;
    let rows = along(of, 1, &|n| (n % along_z, along_z));
    along(&rows, along_z, &|n| (n / along_z, along_x))
}
