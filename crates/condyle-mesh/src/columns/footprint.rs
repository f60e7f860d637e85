//! The places where columns may stand: where a body is thick enough below a surface that is not a wall.

use super::{
    grid::{ColumnGrid, Place},
    vertical_lines::{Bridges, Through, VerticalLines},
};
use crate::triangle_mesh::TriangleMesh;

/// Share of the median thickness below which a shell is the wedge of a chamfer, without a separate layer below it:
/// its columns would be too stiff.
const THINNEST_SHARE: f64 = 0.15;
/// A surface that rises by more than 1.5 edges over one, 56 degrees, is the side of the insert, and no
/// longer articulates.
const MIN_UPWARD: f64 = 0.555;
/// Samples of the shell along an edge of a hexahedron ...
const SAMPLES_PER_EDGE: f64 = 4.0;
/// ... but no closer than this, mm, which no outline needs.
const CLOSEST_SAMPLES_MM: f64 = 0.1;
/// Chips, slits and teeth of the outline up to twice as many samples wide are not part of it.
const DETAIL_SAMPLES: usize = 2;
/// Teeth that are narrower than twice as many samples, an edge, and longer than [`LONGEST_TOOTH_SAMPLES`], are not part
/// of the outline either: the ring of quads along it would not reach into them.
const TOOTH_SAMPLES: usize = 4;
/// One and a half edges: the tip of a square corner, however it is turned, is shorter.
const LONGEST_TOOTH_SAMPLES: usize = 6;

/// Samples around the shell, so many that the removal of details never reaches the last of them.
const MARGIN_SAMPLES: usize = 2 * DETAIL_SAMPLES + 1;

pub(super) struct Footprint<'a> {
    lines: &'a VerticalLines<'a>,
    thinnest_mm: f64,
    /// Points at which it is sampled, with a margin around the shell.
    pub(super) samples: ColumnGrid,
    pub(super) meets_shell: Vec<bool>,
    pub(super) holds: Vec<bool>,
    bridges: Bridges,
}

impl<'a> Footprint<'a> {
    pub(super) fn new(shell: &TriangleMesh, lines: &'a VerticalLines<'a>, edge_mm: f64) -> Self {
        // The lines of the samples lie on the bounds of the shell.
        let (low, high) = shell.bounds();
        let step_mm = (edge_mm / SAMPLES_PER_EDGE).max(CLOSEST_SAMPLES_MM);
        let size = Place::new(high.x - low.x, high.z - low.z);
        let cells = size.map(|length| (length / step_mm).ceil().max(1.0));
        let step_mm = size.component_div(&cells);
        let with_margin = |axis: usize| cells[axis] as usize + 2 * MARGIN_SAMPLES;
        let samples = ColumnGrid {
            origin_mm: Place::new(low.x, low.z) - step_mm * MARGIN_SAMPLES as f64,
            step_mm,
            cells: (with_margin(0), with_margin(1)),
        };
        let numbers = 0..samples.point_count();
        let through: Vec<_> = numbers.map(|n| lines.at(samples.place_of_mm(n))).collect();
        let met = through.iter().flatten();
        let mut thickness: Vec<f64> = met.map(|through| through.top - through.bottom).collect();
        thickness.sort_unstable_by(f64::total_cmp);
        // An open surface has no thickness, and none is too thin.
        let median_mm = thickness.get(thickness.len() / 2).copied().unwrap_or(0.0);
        let mut footprint = Self {
            lines,
            thinnest_mm: THINNEST_SHARE * median_mm,
            samples,
            meets_shell: through.iter().map(Option::is_some).collect(),
            holds: Vec::new(),
            bridges: Bridges::default(),
        };
        let may_stand = |through: &Option<Through>| footprint.may_stand(*through);
        let holds: Vec<bool> = through.iter().map(may_stand).collect();
        // An opening and a closing by a square remove narrow parts, and fill narrow gaps.
        let grown = |of: &[bool]| spread(&samples, of, DETAIL_SAMPLES, true);
        let shrunk = |of: &[bool]| spread(&samples, of, DETAIL_SAMPLES, false);
        let opened = grown(&shrunk(&holds));
        footprint.holds = without_teeth(&samples, &shrunk(&grown(&opened)));
        footprint
    }

    pub(super) fn through(&self, place_mm: Place) -> Option<Through> {
        let bridge = self.bridges.at(&self.samples, place_mm);
        bridge.or_else(|| self.lines.at(place_mm))
    }

    /// Lets columns stand on some samples as if the shell continued smoothly from around them.
    pub(super) fn bridge(&mut self, samples: &[usize]) {
        for &sample in samples {
            self.holds[sample] = true;
        }
        let height = |sample: usize| {
            let through = self.lines.at(self.samples.place_of_mm(sample))?;
            Some([through.bottom, through.top])
        };
        self.bridges.add(&self.samples, samples, height);
    }

    pub(super) fn holds_near(&self, place_mm: Place) -> bool {
        let samples = &self.samples;
        let steps = (place_mm - samples.origin_mm).component_div(&samples.step_mm);
        let [i, k] = [(0, samples.cells.0), (1, samples.cells.1)]
            .map(|(axis, cells)| (steps[axis].round().max(0.0) as usize).min(cells));
        self.holds[samples.number(i, k)]
    }

    pub(super) fn holds(&self, place_mm: Place) -> bool {
        self.may_stand(self.through(place_mm))
    }

    /// Returns the same without a second attempt next to the place, which would make the outline slightly too wide.
    pub(super) fn holds_exactly(&self, place_mm: Place) -> bool {
        self.may_stand(self.lines.exactly_at(place_mm))
    }

    fn may_stand(&self, through: Option<Through>) -> bool {
        through.is_some_and(|through| {
            let is_wall = through.upward < MIN_UPWARD;
            let is_thin = through.top - through.bottom < self.thinnest_mm;
            !is_wall && !is_thin
        })
    }
}

/// Removes teeth: narrow parts that stick out of the rest and are long.
///
/// Corners, which no square of samples fills to the tip, are shorter, and stay.
fn without_teeth(samples: &ColumnGrid, holds: &[bool]) -> Vec<bool> {
    let shrunk = spread(samples, holds, TOOTH_SAMPLES, false);
    let body = spread(samples, &shrunk, TOOTH_SAMPLES, true);
    let near = spread(samples, &body, LONGEST_TOOTH_SAMPLES, true);
    let mut kept = holds.to_vec();
    for first in 0..holds.len() {
        if !kept[first] || near[first] {
            continue;
        }
        // The connected samples outside the body to which this one belongs.
        let tooth = samples.connected(vec![first], |other| kept[other] && !body[other]);
        let is_on_body = |&n: &usize| samples.around(n).any(|other| kept[other] && body[other]);
        let touches_body = tooth.iter().any(is_on_body);
        // A piece that is not connected with the rest is not a tooth.
        if touches_body {
            tooth.iter().for_each(|&n| kept[n] = false);
        }
    }
    kept
}

/// Spreads samples that are `value` by `reach` samples along both axes.
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
