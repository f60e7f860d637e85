//! How far creep takes the surface down, by the pressure that every node has had so far.

use serde::{Deserialize, Serialize};

use super::creep_contact::CreepContact;
use crate::{creep::LeePienkowski, number::Mixing};

/// Where no side of the femur has to sink further, at any instant, by more than this part of the largest step of a
/// node, the search ends, ...
const SETTLED: f64 = 1e-3;
/// ... or with the turn of this number.
const MAX_ITERATIONS: usize = 100;

/// What creep remembers of the load.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CreepState {
    /// When the intervals done have ended, min.
    ends_min: Vec<f64>,
    /// Mean pressure of a cycle at the end of each interval, at every surface node that was pressed, MPa.
    pressures_mpa: Vec<Vec<(u32, f64)>>,
    /// How deep creep would be at every surface node if all of it recovered, at its deepest so far, by the
    /// pressures that were found, mm.
    deepest_mm: Vec<f64>,
    /// How deep it would be so by now, by the pressures that are foreseen, mm.
    foreseen_mm: Vec<f64>,
    /// How deep it is, mm.
    depth_mm: Vec<f64>,
}

/// A step of creep.
pub(super) struct CreepStep<'a> {
    pub law: &'a LeePienkowski,
    /// Thickness of the unworn insert at every surface node, mm.
    pub thickness_mm: &'a [f64],
    /// How far wear takes every surface node down in the same step, mm.
    pub worn_mm: &'a [f64],
    /// The contact of the cycles that were solved before it.
    pub contact: &'a CreepContact,
    /// When it ends, min from the start of the test.
    pub end_min: f64,
}

/// How a node creeps in a step: recoverable depth = `by_history` + `per_mpa` times its pressure.
#[derive(Clone, Copy)]
struct Node {
    number: usize,
    by_history_mm: f64,
    mm_per_mpa: f64,
    deepest_mm: f64,
    before_mm: f64,
    pressure_mpa: f64,
    /// By how much wear relieves it, MPa.
    relieved_mpa: f64,
    /// How the mean pressure falls as this node alone goes down, MPa/mm.
    stiffness_mpa_per_mm: f64,
}

impl CreepState {
    /// What of creep an unloaded insert still shows after long rest at every surface node, mm.
    pub fn left_mm(&self, law: &LeePienkowski) -> Vec<f64> {
        let nodes = self.deepest_mm.iter().zip(&self.foreseen_mm);
        nodes
            .map(|(deepest, foreseen)| law.left_mm(deepest.max(*foreseen)))
            .collect()
    }

    /// Takes a step, and gives how far it goes down at every node, mm; up where load has gone.
    ///
    /// The pressure through the step is taken to be what it is in the end (Euler's implicit method in the
    /// superposition of loads), as far as can be foreseen: a node that goes down by x, of wear and creep, relieves
    /// itself by its stiffness times x, and gets back what the femur sinks by, which keeps the force of each side at
    /// every instant. An explicit step would take every node out of contact, since the creep of the first interval is
    /// deeper than the femur presses.
    pub(super) fn step(&mut self, step: &CreepStep<'_>) -> Vec<f64> {
        let count = step.thickness_mm.len();
        self.deepest_mm.resize(count, 0.0);
        self.foreseen_mm.resize(count, 0.0);
        self.depth_mm.resize(count, 0.0);
        let pressed = pressed_nodes(step.contact);
        self.put_right(step, &pressed);
        let strains = self.strains(step.law, step.end_min, count);
        let minutes = step.end_min - self.ends_min.last().copied().unwrap_or(0.0);
        let per_mpa = step.law.compliance_per_mpa(minutes);
        let nodes = (0..count).map(|node| self.node(step, node, strains[node], per_mpa));
        // Most of a surface is never touched.
        let nodes: Vec<Node> = nodes.filter(Node::was_pressed).collect();
        let down_mm = implicit(step, &nodes);
        for node in &nodes {
            let down_mm = down_mm[node.number];
            self.foreseen_mm[node.number] = node.recoverable_mm(step.law, down_mm);
            self.depth_mm[node.number] += down_mm;
        }
        self.ends_min.push(step.end_min);
        self.pressures_mpa.push(pressed);
        down_mm
    }

    /// Puts the pressures found now, those at the end of the interval before, in place of what was foreseen.
    fn put_right(&mut self, step: &CreepStep<'_>, pressed: &[(u32, f64)]) {
        let (Some(last), Some(end_min)) = (self.pressures_mpa.last_mut(), self.ends_min.last())
        else {
            return;
        };
        *last = pressed.to_vec();
        let strains = self.strains(step.law, *end_min, step.thickness_mm.len());
        let nodes = step.thickness_mm.iter().zip(strains);
        for (deepest_mm, (thickness_mm, strain)) in self.deepest_mm.iter_mut().zip(nodes) {
            *deepest_mm = deepest_mm.max(thickness_mm * strain);
        }
    }

    /// Strain that would be there at `now_min` at every node by the intervals done, if all of it recovered.
    fn strains(&self, law: &LeePienkowski, now_min: f64, count: usize) -> Vec<f64> {
        let since = |minutes: f64| law.compliance_per_mpa(now_min - minutes);
        let starts_min = std::iter::once(&0.0).chain(&self.ends_min);
        let intervals = starts_min.zip(&self.ends_min).zip(&self.pressures_mpa);
        let mut strains = vec![0.0; count];
        for ((start_min, end_min), pressures_mpa) in intervals {
            let per_mpa = since(*start_min) - since(*end_min);
            for (node, pressure) in pressures_mpa {
                strains[*node as usize] += per_mpa * pressure;
            }
        }
        strains
    }

    fn node(&self, step: &CreepStep<'_>, node: usize, strain: f64, per_mpa: f64) -> Node {
        let thickness_mm = step.thickness_mm[node];
        let stiffness_mpa_per_mm = step.contact.stiffness_mpa_per_mm(node);
        Node {
            number: node,
            by_history_mm: thickness_mm * strain,
            mm_per_mpa: thickness_mm * per_mpa,
            deepest_mm: self.deepest_mm[node],
            before_mm: self.depth_mm[node],
            pressure_mpa: step.contact.mean_pressure_mpa[node],
            relieved_mpa: stiffness_mpa_per_mm * step.worn_mm[node],
            stiffness_mpa_per_mm,
        }
    }
}

impl Node {
    fn was_pressed(&self) -> bool {
        self.pressure_mpa > 0.0 || self.by_history_mm != 0.0 || self.before_mm != 0.0
    }

    /// How far it goes down where its pressure rises by `more_mpa` as the femur sinks, mm.
    ///
    /// Solves x = d(e) - before, e = history + c (p + more - k x), p + more - k x >= 0, with d the depth of a
    /// recoverable depth e, which is straight on either side of the deepest so far.
    fn down_mm(&self, law: &LeePienkowski, more_mpa: f64) -> f64 {
        let free_mpa = self.pressure_mpa + more_mpa - self.relieved_mpa;
        let k = self.stiffness_mpa_per_mm;
        let solved = |slope: f64, offset_mm: f64| {
            let at_rest_mm = slope * (self.by_history_mm + self.mm_per_mpa * free_mpa) + offset_mm;
            (at_rest_mm - self.before_mm) / (1.0 + slope * self.mm_per_mpa * k)
        };
        let deeper_mm = solved(1.0, 0.0);
        let stays_mm = law.left_mm(self.deepest_mm);
        let down_mm = if self.before_mm + deeper_mm >= self.deepest_mm {
            deeper_mm
        } else {
            solved(law.recovering_fraction, stays_mm)
        };
        if free_mpa - k * down_mm >= 0.0 {
            return down_mm;
        }
        law.depth_mm(self.by_history_mm, self.deepest_mm) - self.before_mm
    }

    /// How far it goes down where its pressure stays, mm.
    fn unrelieved_mm(&self, law: &LeePienkowski) -> f64 {
        let recoverable_mm = self.by_history_mm + self.mm_per_mpa * self.pressure_mpa;
        law.depth_mm(recoverable_mm, self.deepest_mm) - self.before_mm
    }

    /// The recoverable depth that its depth after going down by `down_mm` stands for, mm.
    fn recoverable_mm(&self, law: &LeePienkowski, down_mm: f64) -> f64 {
        let depth_mm = self.before_mm + down_mm;
        if depth_mm >= self.deepest_mm || law.recovering_fraction == 0.0 {
            return depth_mm;
        }
        (depth_mm - law.left_mm(self.deepest_mm)) / law.recovering_fraction
    }
}

/// Every node that is pressed, with its mean pressure, MPa.
fn pressed_nodes(contact: &CreepContact) -> Vec<(u32, f64)> {
    let all = contact.mean_pressure_mpa.iter().enumerate();
    let pressed = all.filter(|(_, pressure)| **pressure > 0.0);
    pressed
        .map(|(node, pressure)| (node as u32, *pressure))
        .collect()
}

/// How far every node goes down, mm, found in turn with how far the femur sinks.
fn implicit(step: &CreepStep<'_>, nodes: &[Node]) -> Vec<f64> {
    let mut down_mm = vec![0.0; step.thickness_mm.len()];
    let mut lost_n = step.contact.none_lost_n();
    for node in nodes {
        step.add_lost_n(node, node.unrelieved_mm(step.law), &mut lost_n);
    }
    let mut sunk_mm = step.contact.sunk_mm(&lost_n);
    let mut mixing = Mixing::default();
    for _ in 0..MAX_ITERATIONS {
        lost_n.fill(0.0);
        let sunk = step.contact.sunk(&sunk_mm);
        let mut most_mm = 0.0_f64;
        for node in nodes {
            let rise_mpa = step.contact.rise_mpa(node.number, &sunk);
            let node_mm = node.down_mm(step.law, rise_mpa);
            most_mm = most_mm.max(node_mm.abs());
            down_mm[node.number] = node_mm;
            step.add_lost_n(node, node_mm, &mut lost_n);
        }
        let image_mm = step.contact.sunk_mm(&lost_n);
        let left = std::iter::zip(&sunk_mm, &image_mm).map(|(sunk, image)| (image - sunk).abs());
        if left.fold(0.0, f64::max) <= SETTLED * most_mm {
            break;
        }
        sunk_mm = mixing.next(&sunk_mm, &image_mm, 1.0);
    }
    down_mm
}

impl CreepStep<'_> {
    /// Adds what each side of the femur loses as a node creeps by so much and wears.
    fn add_lost_n(&self, node: &Node, crept_mm: f64, lost_n: &mut [f64]) {
        let down_mm = crept_mm + self.worn_mm[node.number];
        self.contact.add_lost_n(node.number, down_mm, lost_n);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat punch on equal nodes, pressed as hard all the time.
    fn punch(pressure_mpa: f64, nodes: usize) -> CreepContact {
        CreepContact::uniform(pressure_mpa, 250.0, nodes)
    }

    /// Depths of creep under a punch after steps that end at so many minutes, each with its pressure found when
    /// it begins, and the last.
    fn depths_mm(law: &LeePienkowski, steps: &[(f64, f64)]) -> Vec<f64> {
        let mut state = CreepState::default();
        let mut depth_mm = 0.0;
        let step = |&(end_min, pressure_mpa): &(f64, f64)| {
            let contact = punch(pressure_mpa, 6);
            let step = CreepStep {
                law,
                thickness_mm: &[10.0; 6],
                worn_mm: &[0.0; 6],
                contact: &contact,
                end_min,
            };
            let down_mm = state.step(&step);
            let even = |down: &f64| (down - down_mm[0]).abs() < 1e-12;
            assert!(down_mm.iter().all(even), "{down_mm:?}");
            depth_mm += down_mm[0];
            depth_mm
        };
        steps.iter().map(step).collect()
    }

    fn assert_near(found: f64, expected: f64) {
        let tolerance = 1e-4 * expected;
        assert!((found - expected).abs() < tolerance, "{found} {expected}");
    }

    #[test]
    fn verify_a_flat_punch_creeps_by_pressure_thickness_and_compliance() {
        // 4 MPa on 10 mm: 0.1396 mm after 10,000 min, whatever the steps.
        let law = LeePienkowski::default();
        let at_once = depths_mm(&law, &[(1e4, 4.0)]);
        assert_near(at_once[0], 4.0 * 10.0 * 3.491e-3);
        let in_steps = depths_mm(&law, &[(10.0, 4.0), (1e3, 4.0), (1e4, 4.0), (1e5, 4.0)]);
        assert_near(in_steps[0], 40.0 * (3.491e-3 - 3.0 * 7.966e-4));
        assert_near(in_steps[1], 40.0 * (3.491e-3 - 7.966e-4));
        assert_near(in_steps[2], 40.0 * 3.491e-3);
        assert_near(in_steps[3], 40.0 * (3.491e-3 + 7.966e-4));
    }

    #[test]
    fn verify_a_stepped_load_is_superposed() {
        // 4 MPa to 10,000 min, then 7 MPa: 0.04 J(t) + 0.03 J(t - 10,000) mm on 10 mm.
        let law = LeePienkowski::default();
        let depths = depths_mm(&law, &[(1e4, 4.0), (1.1e4, 4.0), (2e4, 7.0), (1e5, 7.0)]);
        // What is found at 11,000 min was there from 10,000 on.
        let j = |minutes| law.compliance_per_mpa(minutes);
        assert_near(depths[2], 40.0 * j(2e4) + 30.0 * j(1e4));
        assert_near(depths[3], 40.0 * j(1e5) + 30.0 * j(9e4));
    }

    #[test]
    fn verify_half_of_it_comes_back_without_load() {
        let law = LeePienkowski::default();
        let depths = depths_mm(&law, &[(1e4, 4.0), (2e4, 4.0), (1.2e5, 0.0)]);
        let (j, deepest) = (|minutes| law.compliance_per_mpa(minutes), 40.0 * 3.491e-3);
        let recoverable = 40.0 * (j(1.2e5) - j(1.1e5));
        // What was foreseen up to 20,000 min and did not come leaves nothing behind.
        assert_near(depths[1], 40.0 * j(2e4));
        assert_near(depths[2], 0.5 * recoverable + 0.5 * deepest);
    }

    #[test]
    fn a_node_that_bears_more_creeps_more_and_is_relieved() {
        let law = LeePienkowski::default();
        let mut contact = punch(4.0, 6);
        contact.mean_pressure_mpa[2] = 6.0;
        let step = CreepStep {
            law: &law,
            thickness_mm: &[10.0; 6],
            worn_mm: &[0.0; 6],
            contact: &contact,
            end_min: 1e4,
        };
        let down_mm = CreepState::default().step(&step);
        // Left and right of the middle are sides of their own.
        let j = 10.0 * law.compliance_per_mpa(1e4);
        let (mean, above) = (14.0 / 3.0, 4.0 / 3.0);
        assert_near(down_mm[2], j * (mean + above / (1.0 + 250.0 * j)));
        assert_near(down_mm[3], j * 4.0);
    }
}
