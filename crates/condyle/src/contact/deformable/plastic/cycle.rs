//! Plastic flow in a cycle that repeats itself, and the stored plastic state.

use std::{collections::BTreeMap, sync::Arc};

use condyle_fem::{PlasticPoint, Strain, Stress};

use crate::contact::model::{ContactState, StateField};

/// Gauss points of an element.
pub(crate) const POINTS: usize = 8;

/// The internal variables at the Gauss points of elements that have yielded, by the number of the element.
pub(crate) type Points = BTreeMap<u32, [PlasticPoint; POINTS]>;

/// The factor by which the surface at rest repeats itself more exactly than a motion: an error in it stays for all
/// cycles of an interval.
const MORE_EXACTLY: f64 = 20.0;

/// Accumulated plastic strain at the Gauss points of an element.
type Flow = [f64; POINTS];

/// The flow of each increment when it was solved last, and the position of the surface at rest.
#[derive(Default)]
pub(crate) struct CycleOfFlow {
    /// The increments of the activity that is being solved.
    increments: BTreeMap<usize, Increment>,
    increment: usize,
    /// The result of the cycles of the activities before.
    before: BTreeMap<u32, Flow>,
    /// The distance of the surface at rest from its place at the same increment a cycle before, mm.
    moved_mm: f64,
}

#[derive(Default)]
struct Increment {
    flows: Vec<(u32, Flow)>,
    set_mm: Option<Arc<Vec<f64>>>,
}

impl CycleOfFlow {
    /// The next increments are of another activity.
    pub fn begin(&mut self) {
        self.before = self.flow();
        self.increments.clear();
    }

    /// The next flows are of this increment.
    pub fn begin_increment(&mut self, increment: usize) {
        self.increment = increment;
        self.present().flows.clear();
    }

    /// Adds the strain that accumulated at the points of an element.
    pub fn add(&mut self, element: u32, flow: Flow) {
        self.present().flows.push((element, flow));
    }

    /// The increment has landed on a surface with that permanent set.
    pub fn end_increment(&mut self, set_mm: &Arc<Vec<f64>>) {
        let before = self.present().set_mm.replace(Arc::clone(set_mm));
        self.moved_mm = match before {
            // The surface of no increment is known yet.
            None => f64::INFINITY,
            Some(before) if Arc::ptr_eq(&before, set_mm) => 0.0,
            Some(before) => farthest_mm(&before, set_mm),
        };
    }

    /// Returns the distance of the surface at rest from its place a cycle before, mm, times the factor of exactness over a
    /// motion.
    pub fn moved_mm(&self) -> f64 {
        MORE_EXACTLY * self.moved_mm
    }

    /// Returns the plastic strain accumulated in the last cycle of every activity, by elements.
    pub fn flow(&self) -> BTreeMap<u32, Flow> {
        let mut sums = self.before.clone();
        let increments = self.increments.values();
        for (element, flow) in increments.flat_map(|increment| &increment.flows) {
            let sum = sums.entry(*element).or_default();
            for (sum, flow) in sum.iter_mut().zip(flow) {
                *sum += flow;
            }
        }
        sums
    }

    fn present(&mut self) -> &mut Increment {
        self.increments.entry(self.increment).or_default()
    }
}

/// Returns the largest distance between two surfaces, mm.
pub(crate) fn farthest_mm(one_mm: &[f64], other_mm: &[f64]) -> f64 {
    let apart = one_mm.iter().zip(other_mm).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f64::max)
}

/// The field of the contact's state that holds plastic strains; of every element that has yielded its number, the
/// largest flow of its Gauss points in the last cycle, and of each point strain, backstress, MPa, and accumulated
/// strain.
pub(crate) const PLASTIC_FIELD: &str = "plastic_strain_and_backstress_mpa";

/// Numbers of a Gauss point.
const OF_POINT: usize = 13;
/// Numbers of an element.
const OF_ELEMENT: usize = 2 + POINTS * OF_POINT;

/// Plastic strains, and what flowed in the last cycle.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PlasticMemory {
    pub points: Points,
    /// The largest strain that accumulated at a Gauss point of each element in the last cycle.
    pub flow_in_cycle: BTreeMap<u32, f64>,
}

impl PlasticMemory {
    /// Reads the field of a contact's state; empty if there is none.
    pub fn from_state(state: &ContactState) -> Self {
        let mut remembered = Self::default();
        let field = state
            .fields
            .iter()
            .find(|field| field.name == PLASTIC_FIELD);
        let values = field.map_or(&[][..], |field| &field.values);
        for numbers in values.chunks_exact(OF_ELEMENT) {
            let element = numbers[0] as u32;
            let point = |p: usize| point_of(&numbers[2 + p * OF_POINT..][..OF_POINT]);
            remembered
                .points
                .insert(element, std::array::from_fn(point));
            remembered.flow_in_cycle.insert(element, numbers[1]);
        }
        remembered
    }

    /// The field that says it; none where nothing has yielded.
    pub fn field(&self) -> Option<StateField> {
        if self.points.is_empty() {
            return None;
        }
        let values = self.points.iter().flat_map(|(element, points)| {
            let flow = self.flow_in_cycle.get(element).copied().unwrap_or_default();
            let own = [f64::from(*element), flow];
            own.into_iter().chain(points.iter().flat_map(numbers_of))
        });
        Some(StateField {
            name: PLASTIC_FIELD.to_owned(),
            values: values.collect(),
        })
    }
}

fn point_of(numbers: &[f64]) -> PlasticPoint {
    PlasticPoint {
        strain: Strain(std::array::from_fn(|i| numbers[i])),
        backstress: Stress(std::array::from_fn(|i| numbers[6 + i])),
        accumulated: numbers[12],
    }
}

fn numbers_of(point: &PlasticPoint) -> impl Iterator<Item = f64> {
    let (strain, backstress) = (point.strain.0, point.backstress.0);
    let tensors = strain.into_iter().chain(backstress);
    tensors.chain([point.accumulated])
}
