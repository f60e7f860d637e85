//! The loads under which the surfaces touch and nowhere overlap, and nowhere pull: a linear complementarity problem.

use super::{
    changed_factor::ChangedFactor,
    cholesky::{Eight, ROWS, zero},
    compliance::NearMatrix,
};
use crate::number::{F64x4, LANES, Number};

/// Largest tensile load that counts as round-off, N, where loads are a few newtons.
const LOAD_TOLERANCE_N: f64 = 1e-9;
/// Block exchanges without progress after which single exchanges follow.
const MAX_TRIES: u32 = 10;
/// Number of rounds after which the remaining error is round-off: ten times the largest number observed.
const MAX_ROUNDS: u32 = 500;

/// The set of nodes in contact, and the factor of their compliance.
///
/// With the overclosure d of the bodies at rest, the normal compliance C of the surface and the loads N, the gap is C N - d,
/// and
///
/// $$ N \ge 0, \quad C N - d \ge 0, \quad N \cdot (C N - d) = 0. $$
///
/// C is positive definite, so there is one solution. It is found by trying which nodes are in contact: first those of the
/// response before; then without those that pull, and with those that overlap. Exchanging all of these at once takes few
/// rounds but may cycle; Murty's rule, which exchanges one at a time, is slow but ends. So block exchanges are tried as
/// long as they reduce the number of wrong nodes (Portugal, Judice and Vicente 1994).
pub(crate) struct ContactSet {
    /// For every surface node, whether it was in contact at the last response.
    was_in_contact: Vec<bool>,
    /// For every candidate, whether it is in the trial set.
    is_in_contact: Vec<bool>,
    /// The nodes of the trial set, and their places among the candidates.
    places: Vec<usize>,
    nodes: Vec<u32>,
    /// The overclosure of every surface node and its derivatives by six motions, current for candidates.
    overclosures: Vec<Eight>,
    factor: ChangedFactor,
    /// The load of every node of the trial set; and of the solution, with the derivatives by six motions.
    loads_n: Vec<f64>,
    loads: Vec<Eight>,
    /// The loads of the trial set by the panels of their nodes.
    by_panel: Vec<(usize, Eight)>,
    clearances: Clearances,
}

impl ContactSet {
    pub fn new(node_count: usize) -> Self {
        Self {
            was_in_contact: vec![false; node_count],
            is_in_contact: Vec::new(),
            places: Vec::new(),
            nodes: Vec::new(),
            overclosures: vec![zero(); node_count],
            factor: ChangedFactor::new(node_count),
            loads_n: Vec::new(),
            loads: Vec::new(),
            by_panel: Vec::new(),
            clearances: Clearances::new(node_count),
        }
    }

    /// Finds the loads, and returns the place of each node in contact among the candidates with its load and the load's
    /// derivatives by six motions.
    ///
    /// The candidates must come in a fixed order.
    pub fn solve(
        &mut self,
        candidates: &[Candidate],
        compliance: &NearMatrix,
    ) -> impl Iterator<Item = (usize, &Eight)> {
        self.start(candidates);
        for candidate in candidates {
            self.overclosures[candidate.node as usize] = candidate.overclosure_mm;
        }
        self.factor.take_other_overclosures();
        // The smallest number of wrong nodes so far, and the block exchanges left without a smaller one.
        let (mut least, mut tries) = (usize::MAX, MAX_TRIES);
        for _ in 0..MAX_ROUNDS {
            self.load(candidates, compliance);
            let wrong = self.wrong(candidates, compliance);
            let Some(last) = wrong.last() else {
                break;
            };
            tries = if wrong.len() < least {
                MAX_TRIES
            } else {
                tries.saturating_sub(1)
            };
            least = least.min(wrong.len());
            // Murty's rule exchanges the last one, by the fixed order of the candidates.
            let exchanged = if tries > 0 {
                &wrong[..]
            } else {
                std::slice::from_ref(last)
            };
            for &place in exchanged {
                self.is_in_contact[place] = !self.is_in_contact[place];
            }
        }
        // Only the solution needs derivatives.
        self.factor
            .loads_by_motion(&self.nodes, &self.overclosures, &mut self.loads);
        for &node in &self.nodes {
            self.was_in_contact[node as usize] = true;
        }
        self.places.iter().copied().zip(&self.loads)
    }

    /// Starts with the candidates that were in contact before; if there is none, with all that overlap.
    fn start(&mut self, candidates: &[Candidate]) {
        let was_in_contact = |candidate: &Candidate| self.was_in_contact[candidate.node as usize];
        self.is_in_contact.clear();
        self.is_in_contact
            .extend(candidates.iter().map(was_in_contact));
        for &node in &self.nodes {
            self.was_in_contact[node as usize] = false;
        }
        if !self.is_in_contact.contains(&true) {
            let overlaps = |candidate: &Candidate| candidate.overclosed_mm() > 0.0;
            self.is_in_contact.clear();
            self.is_in_contact.extend(candidates.iter().map(overlaps));
        }
    }

    /// Finds the loads under which the gaps of the trial set are zero.
    fn load(&mut self, candidates: &[Candidate], compliance: &NearMatrix) {
        let (places, nodes) = (&mut self.places, &mut self.nodes);
        places.clear();
        places.extend((0..candidates.len()).filter(|&place| self.is_in_contact[place]));
        nodes.clear();
        nodes.extend(places.iter().map(|&place| candidates[place].node));
        self.factor.set_contact(nodes, compliance);
        self.factor
            .loads(nodes, &self.overclosures, &mut self.loads_n);
        self.clearances.take(nodes, &self.loads_n, compliance);
        self.by_panel = by_panel(nodes, &self.loads_n, compliance);
    }

    /// Returns the places of the candidates that pull, and of those that overlap and are not in the trial set; ascending.
    fn wrong(&mut self, candidates: &[Candidate], compliance: &NearMatrix) -> Vec<usize> {
        let loads = self.places.iter().zip(&self.loads_n);
        let pulling = loads.filter(|(_, load_n)| **load_n < -LOAD_TOLERANCE_N);
        let mut wrong: Vec<usize> = pulling.map(|(&place, _)| place).collect();
        // Gaps are expensive. Nodes that are likely to overlap come first: as long as anything is wrong, the others can wait.
        for is_likely in [true, false] {
            if !is_likely && !wrong.is_empty() {
                break;
            }
            for (place, candidate) in candidates.iter().enumerate() {
                if self.is_in_contact[place] || self.clearances.may_overlap(candidate) != is_likely
                {
                    continue;
                }
                let row = compliance.row(candidate.node);
                let moved_mm = || compliance.moved(row, &self.by_panel);
                if self.clearances.overlaps(candidate, compliance, moved_mm) {
                    wrong.push(place);
                }
            }
        }
        wrong.sort_unstable();
        wrong
    }
}

/// Arranges loads on nodes by the panels of the compliance, in the order of places: sums do not depend on the order in which
/// tiles were added.
pub(crate) fn by_panel(
    nodes: &[u32],
    loads_n: &[f64],
    compliance: &NearMatrix,
) -> Vec<(usize, Eight)> {
    let rows = nodes.iter().map(|&node| compliance.row(node) as usize);
    let mut loads: Vec<(u32, usize, f64)> = nodes
        .iter()
        .zip(rows)
        .zip(loads_n)
        .map(|((&node, row), &load_n)| (compliance.place(node), row, load_n))
        .collect();
    loads.sort_unstable_by_key(|&(place, ..)| place);
    let mut panels: Vec<(usize, [f64; ROWS])> = Vec::new();
    for (_, row, load_n) in loads {
        if panels.last().is_none_or(|(panel, _)| *panel != row / ROWS) {
            panels.push((row / ROWS, [0.0; ROWS]));
        }
        if let Some((_, loads)) = panels.last_mut() {
            loads[row % ROWS] = load_n;
        }
    }
    let vectors =
        |loads: [f64; ROWS]| [0, LANES].map(|first| F64x4::from_lanes(|lane| loads[first + lane]));
    panels
        .into_iter()
        .map(|(panel, loads)| (panel, vectors(loads)))
        .collect()
}

#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    pub node: u32,
    /// The overclosure of the rigid counterface and the surface at rest, mm, < 0 if apart; then its derivatives by six motions.
    pub overclosure_mm: Eight,
}

impl Candidate {
    pub fn overclosed_mm(&self) -> f64 {
        self.overclosure_mm[0].lane(0)
    }

    pub fn displace(&mut self, by_mm: f64) {
        // Trial states do not depend on the motion: the derivatives stay.
        self.overclosure_mm[0] -= F64x4::new([by_mm, 0.0, 0.0, 0.0]);
    }
}

/// Largest overlap that counts as none, mm: a millionth of the roughness of a surface.
const GAP_TOLERANCE_MM: f64 = 1e-10;

/// A node is likely to overlap if its gap would be less than this, mm, with the deflection that was computed last.
const NARROW_MM: f64 = 0.01;

/// Bounds on the gaps of nodes that are not in contact, which make most gaps unnecessary to compute.
///
/// A gap is the sum of many loads, each times its compliance. It cannot have closed since it was last computed if it was
/// wider than all changes of load since then can have moved its node and the counterface can have come nearer; the bounds on the
/// former are known tile by tile. Results do not depend on when a gap was computed last.
struct Clearances {
    /// For every surface node, its deflection when that was computed last plus the closing of its tile until then, mm.
    wider_mm: Vec<f64>,
    moved_mm: Vec<f64>,
    tiles: Vec<TileClearance>,
    /// The load of every surface node, and the nodes that have one.
    load_n: Vec<f64>,
    loaded: Vec<u32>,
}

/// Bounds on the gaps over a tile of nodes, and the loads on it.
#[derive(Clone, Copy, Default)]
struct TileClearance {
    /// The largest outward displacement of any of its nodes by all changes of load so far, mm.
    closed_mm: f64,
    /// The largest outward displacement of any of its nodes by the loads, mm.
    most_bulge_mm: f64,
    /// The decrease and the increase of loads on it with the last change, and their sum, N.
    less_n: f64,
    more_n: f64,
    pressing_n: f64,
}

impl Clearances {
    fn new(node_count: usize) -> Self {
        Self {
            wider_mm: vec![f64::NEG_INFINITY; node_count],
            moved_mm: vec![f64::NEG_INFINITY; node_count],
            tiles: Vec::new(),
            load_n: vec![0.0; node_count],
            loaded: Vec::new(),
        }
    }

    fn take(&mut self, nodes: &[u32], loads_n: &[f64], compliance: &NearMatrix) {
        let reaches = &compliance.reaches;
        self.tiles.resize(reaches.len(), TileClearance::default());
        for tile in &mut self.tiles {
            (tile.less_n, tile.more_n, tile.pressing_n) = (0.0, 0.0, 0.0);
        }
        // First the changes of loads on nodes in contact now, then those on nodes that have left.
        for (&node, &load_n) in nodes.iter().zip(loads_n) {
            let tile = &mut self.tiles[compliance.slot(node)];
            tile.change(load_n - self.load_n[node as usize]);
            tile.pressing_n += load_n.max(0.0);
            self.load_n[node as usize] = 0.0;
        }
        for node in self.loaded.drain(..) {
            self.tiles[compliance.slot(node)].change(-self.load_n[node as usize]);
            self.load_n[node as usize] = 0.0;
        }
        for (&node, &load_n) in nodes.iter().zip(loads_n) {
            self.load_n[node as usize] = load_n;
        }
        self.loaded.extend_from_slice(nodes);
        for (own, reaches) in reaches.iter().enumerate() {
            let (mut closed_mm, mut bulge_mm) = (0.0, 0.0);
            for (tile, reach) in self.tiles.iter().zip(reaches) {
                closed_mm += tile.less_n * reach.inwards + tile.more_n * reach.outwards;
                bulge_mm += tile.pressing_n * reach.outwards;
            }
            self.tiles[own].closed_mm += closed_mm;
            self.tiles[own].most_bulge_mm = bulge_mm;
        }
    }

    fn may_overlap(&self, candidate: &Candidate) -> bool {
        self.moved_mm[candidate.node as usize] - candidate.overclosed_mm() < NARROW_MM
    }

    /// Returns whether a node outside the trial set overlaps the counterface; `moved_mm` computes its deflection.
    ///
    /// It may miss an overlap while a load pulls; the trial set is then wrong anyway.
    fn overlaps(
        &mut self,
        candidate: &Candidate,
        compliance: &NearMatrix,
        moved_mm: impl FnOnce() -> f64,
    ) -> bool {
        let (node, overclosed_mm) = (candidate.node as usize, candidate.overclosed_mm());
        let tile = &self.tiles[compliance.slot(candidate.node)];
        // Either no load can bulge the surface as far as the counterface, or the gap was wider than it can have closed since.
        let is_apart = overclosed_mm + tile.most_bulge_mm < 0.0
            || self.wider_mm[node] - overclosed_mm - tile.closed_mm > 0.0;
        if is_apart {
            return false;
        }
        let moved_mm = moved_mm();
        self.moved_mm[node] = moved_mm;
        self.wider_mm[node] = moved_mm + tile.closed_mm;
        overclosed_mm - moved_mm > GAP_TOLERANCE_MM
    }
}

impl TileClearance {
    fn change(&mut self, by_n: f64) {
        self.less_n += (-by_n).max(0.0);
        self.more_n += by_n.max(0.0);
    }
}
