//! Creep of the surface: the load history of every node, and the contact that causes it.

use serde::{Deserialize, Serialize};

use super::WearTest;
use crate::{
    Vec3,
    contact::Record,
    creep::LeePienkowski,
    geometry::{ArticulatingSurface, Insert},
    machine::Cycle,
    number::Mixing,
};

/// Part of the largest step of a node by which no side of the counterface may still sink at any instant when the
/// iteration has converged.
const SETTLED: f64 = 1e-3;
/// Largest number of iterations.
const MAX_ITERATIONS: usize = 100;
/// Number of instants of a cycle that represent it where the change of the pressure is predicted.
const INSTANTS: usize = 16;

/// The load history of creep.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CreepState {
    /// Ends of the intervals done, min.
    ends_min: Vec<f64>,
    /// Mean pressure of a cycle at the end of each interval, at every surface node that was pressed, MPa.
    pressures_mpa: Vec<Vec<(u32, f64)>>,
    /// Largest recoverable depth so far at every surface node by the computed pressures, mm: the depth that creep would
    /// have if all of it recovered.
    deepest_mm: Vec<f64>,
    /// Recoverable depth now, by the predicted pressures, mm.
    foreseen_mm: Vec<f64>,
    depth_mm: Vec<f64>,
}

pub(super) struct CreepStep<'a> {
    pub law: &'a LeePienkowski,
    /// Thickness of the unworn insert at every surface node, mm.
    pub thickness_mm: &'a [f64],
    /// Depth of wear of every surface node in the same step, mm.
    pub worn_mm: &'a [f64],
    /// The contact of the cycles that were solved before it.
    pub contact: &'a CreepContact,
    /// End of the step, min from the start of the test.
    pub end_min: f64,
}

/// The creep of a node in a step: recoverable depth = `by_history_mm` + `mm_per_mpa` times its pressure.
#[derive(Clone, Copy)]
struct Node {
    number: usize,
    by_history_mm: f64,
    mm_per_mpa: f64,
    deepest_mm: f64,
    before_mm: f64,
    pressure_mpa: f64,
    /// Pressure that it loses by wear, MPa.
    relieved_mpa: f64,
    /// Decrease of its mean pressure as this node alone goes down, MPa/mm.
    stiffness_mpa_per_mm: f64,
}

impl CreepState {
    /// Returns the creep that remains after long rest without load at every surface node, mm.
    pub fn left_mm(&self, law: &LeePienkowski) -> Vec<f64> {
        let nodes = self.deepest_mm.iter().zip(&self.foreseen_mm);
        nodes
            .map(|(deepest, foreseen)| law.left_mm(deepest.max(*foreseen)))
            .collect()
    }

    /// Takes a step, and returns its depth at every node, mm; negative where the load has been removed.
    ///
    /// The pressure during the step is the predicted pressure at its end (Euler's implicit method in the
    /// superposition of loads): a node that goes down by x, by wear and creep, loses its stiffness times x, and
    /// gains pressure as the counterface sinks, which keeps the force of each side at every instant. An explicit step would
    /// take every node out of contact, since the creep of the first interval is deeper than the overclosure.
    pub(super) fn step(&mut self, step: &CreepStep<'_>) -> Vec<f64> {
        let count = step.thickness_mm.len();
        self.deepest_mm.resize(count, 0.0);
        self.foreseen_mm.resize(count, 0.0);
        self.depth_mm.resize(count, 0.0);
        let all = step.contact.mean_pressure_mpa.iter().enumerate();
        let pressed = all.filter(|(_, pressure)| **pressure > 0.0);
        let pressed: Vec<_> = pressed.map(|(node, &mpa)| (node as u32, mpa)).collect();
        self.correct_last(step, &pressed);
        let strains = self.strains(step.law, step.end_min, count);
        let minutes = step.end_min - self.ends_min.last().copied().unwrap_or(0.0);
        let per_mpa = step.law.compliance_per_mpa(minutes);
        let nodes = (0..count).map(|node| self.node(step, node, strains[node], per_mpa));
        // Most of a surface is never touched.
        let was_pressed = |node: &Node| {
            node.pressure_mpa > 0.0 || node.by_history_mm != 0.0 || node.before_mm != 0.0
        };
        let nodes: Vec<Node> = nodes.filter(was_pressed).collect();
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

    /// Replaces the predicted pressures at the end of the last interval by those computed now.
    fn correct_last(&mut self, step: &CreepStep<'_>, pressed: &[(u32, f64)]) {
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

    /// Recoverable strain at `now_min` at every node by the intervals done.
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
    /// Returns the depth of the step where the pressure rises by `more_mpa` as the counterface sinks, mm.
    ///
    /// Solves x = d(e) - before, e = history + c (p + more - k x), p + more - k x >= 0, with d the depth of a
    /// recoverable depth e, which is linear on either side of the deepest so far.
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
        // The node leaves the contact: no pressure acts, and it recovers.
        law.depth_mm(self.by_history_mm, self.deepest_mm) - self.before_mm
    }

    /// Recoverable depth after a step of `down_mm`, mm: the inverse of the law's depth.
    fn recoverable_mm(&self, law: &LeePienkowski, down_mm: f64) -> f64 {
        let depth_mm = self.before_mm + down_mm;
        // Without recovery the depth does not depend on it below the deepest, and there is no inverse.
        if depth_mm >= self.deepest_mm || law.recovering_fraction == 0.0 {
            return depth_mm;
        }
        (depth_mm - law.left_mm(self.deepest_mm)) / law.recovering_fraction
    }
}

/// Solves for the depth of the step at every node, mm, and the motion by which the counterface sinks.
fn implicit(step: &CreepStep<'_>, nodes: &[Node]) -> Vec<f64> {
    let contact = step.contact;
    let add_lost_n = |node: &Node, crept_mm: f64, lost_n: &mut [f64]| {
        let down_mm = crept_mm + step.worn_mm[node.number];
        contact.add_lost_n(node.number, down_mm, lost_n);
    };
    let mut down_mm = vec![0.0; step.thickness_mm.len()];
    let mut lost_n = vec![0.0; contact.sides.len()];
    // The search starts from the creep at constant pressure.
    for node in nodes {
        let recoverable_mm = node.by_history_mm + node.mm_per_mpa * node.pressure_mpa;
        let depth_mm = step.law.depth_mm(recoverable_mm, node.deepest_mm);
        add_lost_n(node, depth_mm - node.before_mm, &mut lost_n);
    }
    let mut sunk_mm = contact.sunk_mm(&lost_n);
    // The map from sunk to sunk contracts slowly where the compliance is large; mixing accelerates it.
    let mut mixing = Mixing::default();
    for _ in 0..MAX_ITERATIONS {
        lost_n.fill(0.0);
        let weighed = sunk_mm.iter().zip(&contact.sides);
        let weighed_mm: Vec<f64> = weighed
            .map(|(sunk, side)| side.part_of_time * sunk)
            .collect();
        let mut most_mm = 0.0_f64;
        for node in nodes {
            let rise_mpa = contact.rise_mpa(node.number, &weighed_mm);
            let node_mm = node.down_mm(step.law, rise_mpa);
            most_mm = most_mm.max(node_mm.abs());
            down_mm[node.number] = node_mm;
            add_lost_n(node, node_mm, &mut lost_n);
        }
        let image_mm = contact.sunk_mm(&lost_n);
        let left = std::iter::zip(&sunk_mm, &image_mm).map(|(sunk, image)| (image - sunk).abs());
        if left.fold(0.0, f64::max) <= SETTLED * most_mm {
            break;
        }
        sunk_mm = mixing.next(&sunk_mm, &image_mm, 1.0);
    }
    down_mm
}

/// The contact of a mean cycle, as far as creep depends on it.
#[derive(Clone, Debug)]
pub(super) struct CreepContact {
    /// Pressure at every surface node, mean over time, MPa.
    pub mean_pressure_mpa: Vec<f64>,
    /// The loads of node i are `pressing[first[i]..first[i + 1]]`.
    pressing: Vec<Pressing>,
    first: Vec<usize>,
    nodes: Vec<NodeStiffness>,
    sides: Vec<Side>,
}

/// A loaded node at an instant.
#[derive(Clone, Copy, Debug)]
struct Pressing {
    /// Number of the instant and side of the counterface.
    side: u32,
    pressed_mm2: f32,
    /// Cosine of the angle between the normal of the node and the motion of the sinking side.
    cosine: f32,
}

/// Decrease of the pressure at a node as the node alone goes down.
#[derive(Clone, Copy, Debug)]
struct NodeStiffness {
    /// Of the pressure on the loaded area, MPa/mm.
    mpa_per_mm: f64,
    /// The same over the area of the share, MPa/mm3: times the loaded area it is the decrease of the mean over the
    /// share.
    mpa_per_mm3: f64,
}

/// A side of the counterface at an instant.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// Part of the time that the instant represents.
    part_of_time: f64,
    /// Force that it gains as it sinks, N/mm.
    n_per_mm: f64,
}

impl CreepContact {
    /// Creates the contact of one solved cycle of every activity.
    pub fn new(
        test: &WearTest,
        insert: &Insert,
        surface: &ArticulatingSurface,
        cycles: &[Cycle],
    ) -> Self {
        let all_s = test.cycle_seconds();
        let activities = test.activities.iter();
        let parts: Vec<f64> = activities.map(|own| own.seconds() / all_s).collect();
        let stiffness = |node| {
            let mpa_per_mm = test.contact.stiffness_mpa_per_mm(insert, node);
            NodeStiffness {
                mpa_per_mm,
                mpa_per_mm3: mpa_per_mm / insert.unworn_share_mm2(node),
            }
        };
        let nodes: Vec<NodeStiffness> = (0..insert.surface_nodes().len()).map(stiffness).collect();
        let regions = insert.regions();
        let (mut sides, mut pressing): (Vec<Side>, Vec<(u32, Pressing)>) = Default::default();
        for (cycle, part_of_time) in cycles.iter().zip(&parts) {
            let stride = cycle.instants.len().div_ceil(INSTANTS);
            let instants = cycle.instants.iter().step_by(stride);
            let unloaded = Side {
                part_of_time: part_of_time / instants.len() as f64,
                n_per_mm: 0.0,
            };
            for instant in instants {
                let first = sides.len();
                sides.resize(first + regions.count(), unloaded);
                let records = cycle.history.instant(instant);
                // The normals of a cup differ by a right angle and more; those of a side of two are nearly parallel.
                let is_cup = regions.count() == 1;
                let along = is_cup.then(|| sinking(surface, records)).flatten();
                for record in records {
                    let side = first + regions.of_node(record.node as usize);
                    let normal = &surface.normals[record.node as usize];
                    let cosine = along.map_or(1.0, |along| along.dot(normal));
                    let own = Pressing {
                        side: side as u32,
                        pressed_mm2: record.pressed_mm2,
                        cosine: cosine as f32,
                    };
                    pressing.push((record.node, own));
                }
            }
        }
        let mean_mpa = |node: usize| -> f64 {
            let each = cycles.iter().zip(&parts).map(|(cycle, part)| {
                part * cycle.history.sums(node).summed_pressure_mpa / cycle.instants.len() as f64
            });
            each.sum()
        };
        let mean_pressure_mpa = (0..nodes.len()).map(mean_mpa).collect();
        Self::sorted(mean_pressure_mpa, nodes, sides, pressing)
    }

    /// Creates the contact of loads given in the order of time, each with its node.
    fn sorted(
        mean_pressure_mpa: Vec<f64>,
        nodes: Vec<NodeStiffness>,
        mut sides: Vec<Side>,
        mut pressing: Vec<(u32, Pressing)>,
    ) -> Self {
        for (node, own) in &pressing {
            let along_mm2 = own.pressed_mm2 * own.cosine * own.cosine;
            let n_per_mm = nodes[*node as usize].mpa_per_mm * f64::from(along_mm2);
            sides[own.side as usize].n_per_mm += n_per_mm;
        }
        // Stable, so that the sums over a node's loads keep the order of time.
        pressing.sort_by_key(|(node, _)| *node);
        let first = |node| pressing.partition_point(|(other, _)| (*other as usize) < node);
        Self {
            first: (0..=nodes.len()).map(first).collect(),
            pressing: pressing.into_iter().map(|(_, own)| own).collect(),
            mean_pressure_mpa,
            nodes,
            sides,
        }
    }

    /// Returns the decrease of the mean pressure at a node as the node alone goes down, MPa/mm.
    fn stiffness_mpa_per_mm(&self, node: usize) -> f64 {
        let areas = self.pressing(node).map(|(side, pressed_mm2, _)| {
            let part_of_time = self.sides[side].part_of_time;
            part_of_time * pressed_mm2
        });
        self.nodes[node].mpa_per_mm3 * areas.sum::<f64>()
    }

    /// Returns the increase of a node's mean pressure as the sides sink, MPa, from their motions times their parts of
    /// the time, mm.
    fn rise_mpa(&self, node: usize, weighed_mm: &[f64]) -> f64 {
        let own = self.pressing(node);
        let volumes =
            own.map(|(side, pressed_mm2, cosine)| weighed_mm[side] * pressed_mm2 * cosine);
        self.nodes[node].mpa_per_mm3 * volumes.sum::<f64>()
    }

    /// Adds the force that each side loses at each instant as a node goes down, N.
    fn add_lost_n(&self, node: usize, down_mm: f64, lost_n: &mut [f64]) {
        let lost_mpa = self.nodes[node].mpa_per_mm * down_mm;
        for (side, pressed_mm2, cosine) in self.pressing(node) {
            lost_n[side] += lost_mpa * pressed_mm2 * cosine;
        }
    }

    /// Returns the motion by which each side sinks at each instant to restore the force that it lost, mm.
    fn sunk_mm(&self, lost_n: &[f64]) -> Vec<f64> {
        let sides = lost_n.iter().zip(&self.sides);
        sides
            // A side without load has lost no force; the bound only avoids 0/0.
            .map(|(lost_n, side)| lost_n / side.n_per_mm.max(f64::MIN_POSITIVE))
            .collect()
    }

    /// Sides that load a node, each with the loaded area, mm2, and the cosine between its motion and the normal.
    fn pressing(&self, node: usize) -> impl Iterator<Item = (usize, f64, f64)> {
        let own = self.pressing[self.first[node]..self.first[node + 1]].iter();
        own.map(|own| {
            let (pressed_mm2, cosine) = (f64::from(own.pressed_mm2), f64::from(own.cosine));
            (own.side as usize, pressed_mm2, cosine)
        })
    }
}

/// Returns the direction in which a counterface sinks into a cup, that of the force on it; none without a force.
fn sinking(surface: &ArticulatingSurface, records: &[Record]) -> Option<Vec3> {
    let force_n = |record: &Record| {
        let node = record.node as usize;
        surface.normals[node] * (record.moment.pressure_mpa * surface.shares[node].area_mm2)
    };
    let total_n: Vec3 = records.iter().map(force_n).sum();
    total_n.try_normalize(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a flat punch on equal nodes, half of them on either side, under constant pressure.
    fn punch(pressure_mpa: f64, nodes: usize) -> CreepContact {
        let side = Side {
            part_of_time: 1.0,
            n_per_mm: 0.0,
        };
        let node = NodeStiffness {
            mpa_per_mm: 250.0,
            mpa_per_mm3: 250.0,
        };
        let pressing = |node: usize| {
            let pressing = Pressing {
                side: u32::from(2 * node >= nodes),
                pressed_mm2: 1.0,
                cosine: 1.0,
            };
            (node as u32, pressing)
        };
        CreepContact::sorted(
            vec![pressure_mpa; nodes],
            vec![node; nodes],
            vec![side; 2],
            (0..nodes).map(pressing).collect(),
        )
    }

    #[test]
    fn a_sinking_head_presses_no_wall_along_which_it_sinks() {
        let pressing = [1.0, 0.5, 0.0].map(|cosine| Pressing {
            side: 0,
            pressed_mm2: 1.0,
            cosine,
        });
        let numbered = (0..).zip(pressing).collect();
        let punch = punch(2.0, 3);
        let cup = CreepContact::sorted(
            vec![2.0; 3],
            punch.nodes,
            punch.sides[..1].to_vec(),
            numbered,
        );
        let mut lost_n = [0.0];
        cup.add_lost_n(0, 0.01, &mut lost_n);
        cup.add_lost_n(2, 0.01, &mut lost_n);
        let sunk_mm = cup.sunk_mm(&lost_n);
        assert!((cup.rise_mpa(1, &sunk_mm) / cup.rise_mpa(0, &sunk_mm) - 0.5).abs() < 1e-12);
        assert_eq!(cup.rise_mpa(2, &sunk_mm), 0.0);
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
