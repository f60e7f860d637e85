//! The loads under which the surfaces touch and nowhere overlap, and nowhere pull.

use super::{
    changed_factor::ChangedFactor,
    cholesky::{Eight, zero},
    compliance::KnownColumns,
};
use crate::number::Number;

/// A gap may be below zero by this much, mm: a millionth of what a surface is rough by.
const GAP_TOLERANCE_MM: f64 = 1e-10;
/// A load may pull by this much, N.
const LOAD_TOLERANCE_N: f64 = 1e-9;
/// How often all that is wrong may be put right at once without there being less of it.
const MOST_TRIES: u32 = 10;
/// Rounds after which what is left is round-off: ten times what was ever seen.
const MOST_ROUNDS: u32 = 500;

/// A node that may touch.
#[derive(Clone, Copy)]
pub(super) struct Candidate {
    pub node: u32,
    /// How far the rigid femur reaches into the surface at rest, mm; < 0 apart. Then its derivatives by six
    /// motions.
    pub overclosure_mm: Eight,
}

impl Candidate {
    fn overclosed_mm(&self) -> f64 {
        self.overclosure_mm[0].lane(0)
    }
}

/// Which nodes press, and the factor of their compliance.
///
/// With the overclosure d of the bodies at rest, the normal compliance C of the surface and the loads N,
/// the gap is C N - d, and
///
/// $$ N \ge 0, \quad C N - d \ge 0, \quad N \cdot (C N - d) = 0. $$
///
/// C is positive definite, so there is one solution. It is found by trying which nodes press: those of the
/// response before; then without those that pull, and with those that overlap. Block pivoting with Murty's
/// rule as the last resort (Portugal, Judice and Vicente 1994), which ends.
pub(super) struct Pressing {
    /// Of every surface node, whether it pressed at the last response.
    pressed_before: Vec<bool>,
    /// Of every candidate, whether it is tried to press.
    is_pressing: Vec<bool>,
    /// The pressing nodes, and their places among the candidates.
    places: Vec<usize>,
    nodes: Vec<u32>,
    /// Of every surface node its overclosure, and the derivatives by six motions: of candidates as it is now.
    overclosures: Vec<Eight>,
    factor: ChangedFactor,
    /// Of every pressing node its load, and the derivatives by six motions.
    loads: Vec<Eight>,
    /// Places of the candidates that do not press, and how far each gives way.
    silent: Vec<usize>,
    deflection_mm: Vec<f64>,
}

impl Pressing {
    /// Nothing presses yet on a surface with so many nodes.
    pub fn nothing(node_count: usize) -> Self {
        Self {
            pressed_before: vec![false; node_count],
            is_pressing: Vec::new(),
            places: Vec::new(),
            nodes: Vec::new(),
            overclosures: vec![zero(); node_count],
            factor: ChangedFactor::of_nothing(node_count),
            loads: Vec::new(),
            silent: Vec::new(),
            deflection_mm: Vec::new(),
        }
    }

    /// Finds the loads; the place of each pressing node among the candidates with its load and the load's
    /// derivatives by six motions.
    ///
    /// Candidates come in an order that is always the same.
    pub fn solve(
        &mut self,
        candidates: &[Candidate],
        columns: &mut KnownColumns,
    ) -> impl Iterator<Item = (usize, &Eight)> {
        self.start(candidates);
        for candidate in candidates {
            self.overclosures[candidate.node as usize] = candidate.overclosure_mm;
        }
        self.factor.take_other_overclosures();
        let (mut least, mut tries) = (usize::MAX, MOST_TRIES);
        for _ in 0..MOST_ROUNDS {
            self.load(candidates, columns);
            let wrong = self.wrong(candidates, columns);
            let Some(last) = wrong.last() else {
                break;
            };
            tries = if wrong.len() < least {
                MOST_TRIES
            } else {
                tries.saturating_sub(1)
            };
            least = least.min(wrong.len());
            let changed = if tries > 0 {
                &wrong[..]
            } else {
                std::slice::from_ref(last)
            };
            for &place in changed {
                self.is_pressing[place] = !self.is_pressing[place];
            }
        }
        self.nodes
            .iter()
            .for_each(|&node| self.pressed_before[node as usize] = true);
        self.places.iter().copied().zip(&self.loads)
    }

    /// Tries those that pressed before and are candidates still; where there are none, all that overlap.
    fn start(&mut self, candidates: &[Candidate]) {
        let before = candidates
            .iter()
            .map(|candidate| self.pressed_before[candidate.node as usize]);
        self.is_pressing.clear();
        self.is_pressing.extend(before);
        self.nodes
            .iter()
            .for_each(|&node| self.pressed_before[node as usize] = false);
        if !self.is_pressing.contains(&true) {
            let overlap = candidates
                .iter()
                .map(|candidate| candidate.overclosed_mm() > 0.0);
            self.is_pressing.clear();
            self.is_pressing.extend(overlap);
        }
    }

    /// The loads under which the gap of all that press is zero.
    fn load(&mut self, candidates: &[Candidate], columns: &mut KnownColumns) {
        let (places, nodes) = (&mut self.places, &mut self.nodes);
        places.clear();
        places.extend((0..candidates.len()).filter(|&place| self.is_pressing[place]));
        nodes.clear();
        nodes.extend(places.iter().map(|&place| candidates[place].node));
        columns.ask(nodes.iter().copied());
        self.factor.press(nodes, columns);
        self.factor
            .solve(nodes, &self.overclosures, &mut self.loads);
    }

    /// Places of the candidates that pull, and of those that overlap and do not press; ascending.
    fn wrong(&mut self, candidates: &[Candidate], columns: &KnownColumns) -> Vec<usize> {
        let loads = self.places.iter().zip(&self.loads);
        let pulling = loads.filter(|(_, load)| load[0].lane(0) < -LOAD_TOLERANCE_N);
        let mut wrong: Vec<usize> = pulling.map(|(&place, _)| place).collect();
        self.silent.clear();
        let silent = (0..candidates.len()).filter(|&place| !self.is_pressing[place]);
        self.silent.extend(silent);
        self.find_deflection(candidates, columns);
        for (&place, deflection_mm) in self.silent.iter().zip(&self.deflection_mm) {
            if candidates[place].overclosed_mm() - deflection_mm > GAP_TOLERANCE_MM {
                wrong.push(place);
            }
        }
        wrong.sort_unstable();
        wrong
    }

    /// How far each candidate that does not press gives way.
    fn find_deflection(&mut self, candidates: &[Candidate], columns: &KnownColumns) {
        self.deflection_mm.clear();
        self.deflection_mm.resize(self.silent.len(), 0.0);
        for (&node, load) in self.nodes.iter().zip(&self.loads) {
            let (column, load_n) = (columns.of(node), load[0].lane(0));
            for (sum, &place) in self.deflection_mm.iter_mut().zip(&self.silent) {
                *sum += column[candidates[place].node as usize] * load_n;
            }
        }
    }
}
