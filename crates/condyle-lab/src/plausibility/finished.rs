//! The run that the checks examine.

use std::collections::{BTreeMap, BTreeSet};

use condyle::{
    evolve::{CycleRecord, March},
    geometry::{ArticulatingSurface, Insert},
    machine::{CycleRow, Machine},
};
use condyle_case::case::BuildWarning;
use condyle_mesh::repair::border_sides;
use condyle_results::{PlausibilityWarning, Side, Summary};

/// Returns the warning of the check called `check`, of a value beyond its limit, in their unit.
pub(super) fn warning(
    check: &str,
    (value, limit, unit): (f64, f64, &str),
    message: String,
    advice: &str,
) -> PlausibilityWarning {
    PlausibilityWarning {
        check: check.to_owned(),
        value,
        limit,
        unit: unit.to_owned(),
        message,
        advice: advice.to_owned(),
    }
}

pub(crate) struct Finished<'a> {
    pub march: &'a March,
    pub summary: &'a Summary,
    /// The side in whose frame places are stated.
    pub side: Side,
    /// The remarks on the bodies as they were built.
    pub of_build: &'a [BuildWarning],
    /// The surface of the last cycle.
    pub surface: ArticulatingSurface,
    /// The surface of the first cycle, which is unworn.
    pub unworn: ArticulatingSurface,
    /// Ends of the edges at which the articulating surface ends, and of the edges of a socket.
    rim: Vec<[u32; 2]>,
    rim_nodes: BTreeSet<u32>,
}

/// The first or the last solved cycle of an activity.
#[derive(Clone, Copy)]
pub(crate) struct SolvedCycle<'a> {
    /// `first` or `last`.
    pub name: &'static str,
    /// The number of the activity.
    pub activity: usize,
    /// Its increments.
    pub rows: &'a [CycleRow],
}

impl SolvedCycle<'_> {
    /// Returns the part of the cycle whose rows satisfy a condition, %.
    pub fn percent_of_rows(&self, is_so: impl Fn(&CycleRow) -> bool) -> f64 {
        let count = self.rows.iter().filter(|row| is_so(row)).count();
        100.0 * count as f64 / self.rows.len().max(1) as f64
    }
}

impl<'a> Finished<'a> {
    pub fn new(
        march: &'a March,
        summary: &'a Summary,
        side: Side,
        of_build: &'a [BuildWarning],
    ) -> Self {
        let surface = march.surface();
        let unworn = march.test().contact.surface(&march.test().insert);
        let mut rim = rim_of(march.insert());
        // A head rides on the edge of the socket, from which a chamfer may go on to the rim.
        if march.test().start_height_mm.is_some() {
            rim.extend(convex_edges(march.insert(), &unworn));
        }
        Self {
            rim_nodes: rim.iter().flatten().copied().collect(),
            rim,
            march,
            summary,
            side,
            of_build,
            unworn,
            surface,
        }
    }

    /// Returns the distance of a surface node from the rim, mm.
    pub fn distance_to_rim_mm(&self, node: usize) -> f64 {
        let place = self.surface.positions[node];
        let edges = self.rim.iter();
        let edges = edges.map(|edge| edge.map(|node| self.surface.positions[node as usize]));
        let distances = edges.map(|[from, to]| {
            let along = to - from;
            // The nearest place of the line may lie beyond an end of the edge.
            let part = (place - from).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
            (place - (from + along * part.clamp(0.0, 1.0))).norm()
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Returns whether a surface node is on the rim.
    pub fn is_on_rim(&self, node: usize) -> bool {
        self.rim_nodes.contains(&(node as u32))
    }

    /// Returns the first and the last cycle of every activity, once if both are the same.
    pub fn cycles(&self) -> impl Iterator<Item = SolvedCycle<'a>> {
        let activities = self.march.state().activities.iter().enumerate();
        activities.flat_map(|(activity, state)| {
            let solved = |name, cycle: &'a CycleRecord| SolvedCycle {
                name,
                activity,
                rows: &cycle.rows,
            };
            let kept = state.first_and_last.as_ref();
            let first = kept.map(|(first, _)| solved("first", first));
            let last = kept.filter(|(first, last)| first.cycles < last.cycles);
            let last = last.map(|(_, last)| solved("last", last));
            first.into_iter().chain(last)
        })
    }

    /// Returns the first cycle of every activity.
    pub fn first_cycles(&self) -> impl Iterator<Item = SolvedCycle<'a>> {
        self.cycles().filter(|cycle| cycle.name == "first")
    }

    /// Returns the name of the activity of a cycle as it follows its cycle in a sentence; empty if there is only one.
    pub fn activity_in_words(&self, cycle: &SolvedCycle<'_>) -> String {
        match self.march.test().activities.as_slice() {
            [_] => String::new(),
            all => format!(" of {}", all[cycle.activity].name),
        }
    }

    /// Returns a cycle as in "last cycle of stairs"; without the activity if there is only one.
    pub fn cycle_in_words(&self, cycle: &SolvedCycle<'_>) -> String {
        format!("{} cycle{}", cycle.name, self.activity_in_words(cycle))
    }

    /// Returns the machine of a cycle.
    pub fn machine(&self, cycle: &SolvedCycle<'_>) -> &'a Machine {
        &self.march.test().activities[cycle.activity].machine
    }
}

/// Returns the edges that belong to a single face.
pub(crate) fn rim_of(insert: &Insert) -> Vec<[u32; 2]> {
    let sides = border_sides(insert.surface_faces()).into_iter();
    sides.map(|(ends, ..)| ends).collect()
}

/// Cosine of 10 degrees, by which two faces of a surface differ at an edge: those of a socket are concave, and noise of scans turns
/// them by a degree or two.
const EDGE_COSINE: f64 = 0.985;

/// Returns the convex edges between two faces of a surface.
fn convex_edges(insert: &Insert, surface: &ArticulatingSurface) -> Vec<[u32; 2]> {
    let faces = insert.surface_faces();
    let plane = |face: usize| {
        let [a, b, c, d] = faces[face].map(|node| surface.positions[node as usize]);
        let normal = (c - a).cross(&(d - b));
        ((a + b + c + d) / 4.0, normal.normalize())
    };
    let mut first_face = BTreeMap::new();
    let mut edges = Vec::new();
    for (face, corners) in faces.iter().enumerate() {
        for side in 0..4 {
            let (from, to) = (corners[side], corners[(side + 1) % 4]);
            let ends = [from.min(to), from.max(to)];
            let Some(other) = first_face.insert(ends, face) else {
                continue;
            };
            let ((place, normal), (other_place, other_normal)) = (plane(face), plane(other));
            let is_convex = (other_place - place).dot(&normal) < 0.0;
            if is_convex && normal.dot(&other_normal) < EDGE_COSINE {
                edges.push(ends);
            }
        }
    }
    edges
}

/// Returns a part of a whole in %; 0 of nothing.
pub(super) fn percent_of(part: f64, whole: f64) -> f64 {
    if whole > 0.0 {
        100.0 * part / whole
    } else {
        0.0
    }
}
