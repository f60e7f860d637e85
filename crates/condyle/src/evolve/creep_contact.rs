//! What creep needs to know of the cycles: mean pressures, and how they change as nodes go down.

use super::WearTest;
use crate::{geometry::Insert, machine::Cycle};

/// So many instants of a cycle stand for all where it is foreseen how the pressure will change.
const INSTANTS: usize = 16;

/// The contact of a mean cycle, as creep sees it.
#[derive(Clone, Debug, Default)]
pub(super) struct CreepContact {
    /// Pressure at every surface node, the mean over time, MPa.
    pub mean_pressure_mpa: Vec<f64>,
    /// How that falls as the node alone goes down, MPa/mm.
    pub stiffness_mpa_per_mm: Vec<f64>,
    pressing: Vec<Pressing>,
    /// Force that a side of the femur gains as it sinks at an instant, N/mm.
    sides_n_per_mm: Vec<f64>,
}

/// A node that presses at an instant.
#[derive(Clone, Copy, Debug)]
struct Pressing {
    node: u32,
    /// Which instant and side of the femur.
    side: u32,
    /// Force that goes as the node goes down, N/mm.
    n_per_mm: f64,
    /// Mean pressure that comes as the femur sinks there, MPa/mm.
    mpa_per_mm: f64,
}

impl CreepContact {
    /// That of one solved cycle of every activity.
    pub fn of(test: &WearTest, insert: &Insert, cycles: &[Cycle]) -> Self {
        let count = insert.surface_nodes().len();
        let mut contact = Self {
            mean_pressure_mpa: vec![0.0; count],
            stiffness_mpa_per_mm: vec![0.0; count],
            ..Self::default()
        };
        let alone = |node| test.contact.stiffness_mpa_per_mm(insert, node);
        let alone_mpa_per_mm: Vec<f64> = (0..count).map(alone).collect();
        for (cycle, part_of_time) in cycles.iter().zip(parts_of_time(test)) {
            contact.add_pressures(cycle, part_of_time);
            contact.add_pressing(cycle, part_of_time, insert, &alone_mpa_per_mm);
        }
        contact
    }

    fn add_pressures(&mut self, cycle: &Cycle, part_of_time: f64) {
        let part = part_of_time / cycle.instants.len() as f64;
        for instant in &cycle.instants {
            for record in cycle.history.instant(instant) {
                self.mean_pressure_mpa[record.node as usize] += part * record.moment.pressure_mpa;
            }
        }
    }

    fn add_pressing(
        &mut self,
        cycle: &Cycle,
        part_of_time: f64,
        insert: &Insert,
        alone_mpa_per_mm: &[f64],
    ) {
        let regions = insert.regions();
        let stride = cycle.instants.len().div_ceil(INSTANTS);
        let instants = cycle.instants.iter().step_by(stride);
        let part = part_of_time / instants.len() as f64;
        for instant in instants {
            let first = self.sides_n_per_mm.len();
            self.sides_n_per_mm.resize(first + regions.count(), 0.0);
            for record in cycle.history.instant(instant) {
                let node = record.node as usize;
                let n_per_mm = alone_mpa_per_mm[node] * f64::from(record.pressed_mm2);
                let pressing = Pressing {
                    node: record.node,
                    side: (first + regions.of_node(node)) as u32,
                    n_per_mm,
                    mpa_per_mm: part * n_per_mm / insert.unworn_share_mm2(node),
                };
                self.add(pressing);
            }
        }
    }

    fn add(&mut self, pressing: Pressing) {
        self.stiffness_mpa_per_mm[pressing.node as usize] += pressing.mpa_per_mm;
        self.sides_n_per_mm[pressing.side as usize] += pressing.n_per_mm;
        self.pressing.push(pressing);
    }

    /// By how much the mean pressure at every node rises since the femur sinks where nodes go down by `down_mm`,
    /// so that each side bears as much as before at every instant, MPa.
    pub fn relief_mpa(&self, down_mm: &[f64]) -> Vec<f64> {
        let mut lost_n = vec![0.0; self.sides_n_per_mm.len()];
        for pressing in &self.pressing {
            lost_n[pressing.side as usize] += pressing.n_per_mm * down_mm[pressing.node as usize];
        }
        let sides = lost_n.iter().zip(&self.sides_n_per_mm);
        let sunk_mm: Vec<f64> = sides
            .map(|(lost_n, n_per_mm)| lost_n / n_per_mm.max(f64::MIN_POSITIVE))
            .collect();
        let mut more_mpa = vec![0.0; down_mm.len()];
        for pressing in &self.pressing {
            more_mpa[pressing.node as usize] +=
                pressing.mpa_per_mm * sunk_mm[pressing.side as usize];
        }
        more_mpa
    }
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
        let mut contact = Self {
            mean_pressure_mpa: vec![pressure_mpa; nodes],
            stiffness_mpa_per_mm: vec![0.0; nodes],
            pressing: Vec::new(),
            sides_n_per_mm: vec![0.0; 2],
        };
        for node in 0..nodes {
            contact.add(Pressing {
                node: node as u32,
                side: u32::from(2 * node >= nodes),
                n_per_mm: stiffness_mpa_per_mm,
                mpa_per_mm: stiffness_mpa_per_mm,
            });
        }
        contact
    }
}
