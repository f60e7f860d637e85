//! `cycle_first_pressure.csv` and `cycle_last_pressure.csv`: contact pressure through a cycle.

use std::fmt::Write;

use condyle::evolve::March;

use super::cycle_files::KeptCycle;

/// Name of the file of a cycle.
pub fn cycle_pressure_file(cycle: KeptCycle) -> String {
    format!("{}_pressure.csv", cycle.name())
}

/// The pressures of the cycle that a march solved last: a row an increment and node that is pressed.
///
/// `node` is the number of a point of `insert_*.vtu`, from 0; `pressure_mpa` is the mean over the node's share of
/// the surface, of 32 bits, at the end of the increment. Nothing before the first update of a march.
pub fn cycle_pressure_csv(march: &March) -> Option<String> {
    let cycle = march.last_cycle()?;
    let nodes = march.insert().surface_nodes();
    let mut text = String::from("percent,node,pressure_mpa\n");
    for (increment, row) in cycle.rows.iter().enumerate() {
        let pressures = cycle.pressures_mpa(increment);
        let pressed = nodes.iter().zip(pressures).filter(|(_, mpa)| *mpa > 0.0);
        for (node, mpa) in pressed {
            writeln!(text, "{},{node},{}", row.percent, mpa as f32)
                .expect("writing to a string cannot fail");
        }
    }
    Some(text)
}
