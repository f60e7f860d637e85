//! What creep needs to know of the cycles: mean pressures, and how they change as nodes go down.

use super::WearTest;
use crate::{geometry::Insert, machine::Cycle};

/// So many instants of a cycle stand for all where it is foreseen how the pressure will change.
const INSTANTS: usize = 16;

/// The contact of a mean cycle, as creep sees it.
#[derive(Clone, Debug)]
pub(super) struct CreepContact {
    /// Pressure at every surface node, the mean over time, MPa.
    pub mean_pressure_mpa: Vec<f64>,
    /// Those of node i are `first[i]..first[i + 1]`.
    pressing: Vec<Pressing>,
    first: Vec<usize>,
    nodes: Vec<NodeStiffness>,
    sides: Vec<Side>,
}

/// A node that presses at an instant.
#[derive(Clone, Copy, Debug, Default)]
struct Pressing {
    /// Which instant and side of the femur.
    side: u32,
    /// Area of its share that presses, mm2.
    pressed_mm2: f32,
}

/// How the pressure at a node falls as the node alone goes down.
#[derive(Clone, Copy, Debug)]
struct NodeStiffness {
    /// Of what presses, MPa/mm.
    mpa_per_mm: f64,
    /// The same by area of the share, MPa/mm3: times the area that presses it is how the mean over the share falls.
    mpa_per_mm3: f64,
}

/// A side of the femur at an instant.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// Part of the time that the instant stands for.
    part_of_time: f64,
    /// Force that it gains as it sinks, N/mm.
    n_per_mm: f64,
}

impl CreepContact {
    /// The contact of one solved cycle of every activity.
    pub fn new(test: &WearTest, insert: &Insert, cycles: &[Cycle]) -> Self {
        let nodes = 0..insert.surface_nodes().len();
        let parts = parts_of_time(test);
        let stiffness = |node| {
            let mpa_per_mm = test.contact.stiffness_mpa_per_mm(insert, node);
            NodeStiffness {
                mpa_per_mm,
                mpa_per_mm3: mpa_per_mm / insert.unworn_share_mm2(node),
            }
        };
        let mut by_time = ByTime {
            nodes: nodes.clone().map(stiffness).collect(),
            ..ByTime::default()
        };
        for (cycle, part) in cycles.iter().zip(&parts) {
            by_time.add(cycle, *part, insert);
        }
        let mean = |node| mean_pressure_mpa(cycles, &parts, node);
        by_time.by_node(nodes.map(mean).collect())
    }

    /// How the mean pressure at a node falls as the node alone goes down, MPa/mm.
    pub fn stiffness_mpa_per_mm(&self, node: usize) -> f64 {
        let own = self.pressing(node).iter();
        let areas = own.map(|pressing| {
            self.sides[pressing.side as usize].part_of_time * f64::from(pressing.pressed_mm2)
        });
        self.nodes[node].mpa_per_mm3 * areas.sum::<f64>()
    }

    /// What a node's mean pressure rises by as each side sinks by so much at each instant, MPa.
    pub fn rise_mpa(&self, node: usize, sunk: &Sunk) -> f64 {
        let own = self.pressing(node).iter();
        let volumes = own.map(|pressing| {
            sunk.weighed_mm[pressing.side as usize] * f64::from(pressing.pressed_mm2)
        });
        self.nodes[node].mpa_per_mm3 * volumes.sum::<f64>()
    }

    /// Adds what each side loses at each instant as a node goes down, N.
    pub fn add_lost_n(&self, node: usize, down_mm: f64, lost_n: &mut [f64]) {
        let lost_mpa = self.nodes[node].mpa_per_mm * down_mm;
        for pressing in self.pressing(node) {
            lost_n[pressing.side as usize] += lost_mpa * f64::from(pressing.pressed_mm2);
        }
    }

    /// No force lost yet.
    pub fn none_lost_n(&self) -> Vec<f64> {
        vec![0.0; self.sides.len()]
    }

    /// How far each side sinks at each instant so that it bears as much as before it lost that, mm.
    pub fn sunk_mm(&self, lost_n: &[f64]) -> Vec<f64> {
        let sides = lost_n.iter().zip(&self.sides);
        sides
            .map(|(lost_n, side)| lost_n / side.n_per_mm.max(f64::MIN_POSITIVE))
            .collect()
    }

    /// Sides that have sunk by so much, mm.
    pub fn sunk(&self, sunk_mm: &[f64]) -> Sunk {
        let sides = sunk_mm.iter().zip(&self.sides);
        Sunk {
            weighed_mm: sides
                .map(|(sunk_mm, side)| side.part_of_time * sunk_mm)
                .collect(),
        }
    }

    fn pressing(&self, node: usize) -> &[Pressing] {
        &self.pressing[self.first[node]..self.first[node + 1]]
    }
}

/// How far each side of the femur has sunk at each instant.
pub(super) struct Sunk {
    /// Times the part of the time that the instant stands for, mm.
    weighed_mm: Vec<f64>,
}

/// What presses, as instants give it.
#[derive(Default)]
struct ByTime {
    nodes: Vec<NodeStiffness>,
    /// With the number of its node.
    pressing: Vec<(u32, Pressing)>,
    sides: Vec<Side>,
}

impl ByTime {
    /// Adds some instants of a cycle, each with the sides of its own.
    fn add(&mut self, cycle: &Cycle, part_of_time: f64, insert: &Insert) {
        let regions = insert.regions();
        let stride = cycle.instants.len().div_ceil(INSTANTS);
        let instants = cycle.instants.iter().step_by(stride);
        let unloaded = Side {
            part_of_time: part_of_time / instants.len() as f64,
            n_per_mm: 0.0,
        };
        for instant in instants {
            let first = self.sides.len();
            self.sides.resize(first + regions.count(), unloaded);
            for record in cycle.history.instant(instant) {
                let pressing = Pressing {
                    side: (first + regions.of_node(record.node as usize)) as u32,
                    pressed_mm2: record.pressed_mm2,
                };
                self.push(record.node, pressing);
            }
        }
    }

    fn push(&mut self, node: u32, pressing: Pressing) {
        let mpa_per_mm = self.nodes[node as usize].mpa_per_mm;
        let n_per_mm = mpa_per_mm * f64::from(pressing.pressed_mm2);
        self.sides[pressing.side as usize].n_per_mm += n_per_mm;
        self.pressing.push((node, pressing));
    }

    /// The same sorted by node, of nodes with such mean pressures.
    fn by_node(self, mean_pressure_mpa: Vec<f64>) -> CreepContact {
        let count = mean_pressure_mpa.len();
        // Counted two places on: filling then moves every node's end on to where the next begins.
        let mut first = vec![0; count + 2];
        for (node, _) in &self.pressing {
            first[*node as usize + 2] += 1;
        }
        for i in 0..=count {
            first[i + 1] += first[i];
        }
        let mut sorted = vec![Pressing::default(); self.pressing.len()];
        for (node, pressing) in &self.pressing {
            let place = &mut first[*node as usize + 1];
            sorted[*place] = *pressing;
            *place += 1;
        }
        CreepContact {
            mean_pressure_mpa,
            pressing: sorted,
            first,
            nodes: self.nodes,
            sides: self.sides,
        }
    }
}

/// Pressure at a node, the mean over the time of all activities, MPa.
fn mean_pressure_mpa(cycles: &[Cycle], parts_of_time: &[f64], node: usize) -> f64 {
    let each = cycles.iter().zip(parts_of_time).map(|(cycle, part)| {
        part * cycle.history.sums(node).summed_pressure_mpa / cycle.instants.len() as f64
    });
    each.sum()
}

/// The part of the time that each activity of a test takes: its share of the cycles over its frequency.
fn parts_of_time(test: &WearTest) -> Vec<f64> {
    let all = test.cycle_seconds();
    let each = test.activities.iter();
    each.map(|activity| activity.seconds() / all).collect()
}

#[cfg(test)]
impl CreepContact {
    /// A punch that presses on equal nodes, half of them on either side, all the time.
    pub fn uniform(pressure_mpa: f64, stiffness_mpa_per_mm: f64, nodes: usize) -> Self {
        let side = Side {
            part_of_time: 1.0,
            n_per_mm: 0.0,
        };
        let node = NodeStiffness {
            mpa_per_mm: stiffness_mpa_per_mm,
            mpa_per_mm3: stiffness_mpa_per_mm,
        };
        let mut by_time = ByTime {
            nodes: vec![node; nodes],
            sides: vec![side; 2],
            ..ByTime::default()
        };
        for node in 0..nodes {
            let pressing = Pressing {
                side: u32::from(2 * node >= nodes),
                pressed_mm2: 1.0,
            };
            by_time.push(node as u32, pressing);
        }
        by_time.by_node(vec![pressure_mpa; nodes])
    }
}
