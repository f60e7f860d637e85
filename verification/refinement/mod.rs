//! The default case with finer increments, meshes and friction.

use crate::{
    Case, Row,
    convergence::order_of_differences,
    default_case,
    marched::{marched, test_of},
};

pub(crate) const CASE: Case = Case {
    name: "refinement",
    readme: include_str!("README.md"),
    rows,
};

/// Accepted error of the mass loss, and of the deepest wear.
const MASS: f64 = 0.005;
const DEPTH: f64 = 0.01;

/// The default case with some of its lines changed.
struct Finer {
    increments: u32,
    edge_mm: f64,
    slip_tolerance_mm_per_s: f64,
    repeat_tolerance: f64,
}

/// As it is shipped.
const DEFAULT: Finer = Finer {
    increments: 200,
    edge_mm: 1.05,
    slip_tolerance_mm_per_s: 0.3,
    repeat_tolerance: 0.01,
};

/// As it is refined: cycles that repeat themselves well.
const REPEATING: Finer = Finer {
    increments: 400,
    repeat_tolerance: 1e-4,
    ..DEFAULT
};

/// Mass loss, mg, and deepest wear, mm.
type Loss = [f64; 2];

fn rows() -> Vec<Row> {
    let increments = [400, 800, 1600].map(|increments| {
        let finer = Finer {
            increments,
            ..REPEATING
        };
        finer.loss()
    });
    let mut rows = by_increments(&increments);
    rows.extend(by_mesh());
    rows.extend(by_creep(increments[0]));
    rows
}

fn by_increments(three: &[Loss; 3]) -> Vec<Row> {
    let (limit, default) = (limit(&three[1..], 2.0), DEFAULT.loss());
    let [mass, depth] = errors("200 increments", limit, default, MASS);
    vec![mass.with_order(2.0, order(three, 0), 0.6), depth]
}

fn by_mesh() -> [Row; 2] {
    let two = [1.05, 0.525].map(|edge_mm| {
        let finer = Finer {
            edge_mm,
            increments: DEFAULT.increments,
            ..REPEATING
        };
        finer.loss()
    });
    errors("edge 1.05 mm", limit(&two, 2.0), two[0], MASS)
}

/// `at_default` has the slip tolerance of 0.3 mm/s.
fn by_creep(at_default: Loss) -> [Row; 2] {
    let [half, quarter] = [0.15, 0.075].map(|slip_tolerance_mm_per_s| {
        let finer = Finer {
            slip_tolerance_mm_per_s,
            ..REPEATING
        };
        finer.loss()
    });
    let limit = limit(&[half, quarter], 1.0);
    let [mass, depth] = errors("slip tolerance 0.3 mm/s", limit, at_default, MASS);
    let three = [at_default, half, quarter];
    [
        mass.with_order(1.0, order(&three, 0), 0.25),
        depth.with_order(1.0, order(&three, 1), 0.25),
    ]
}

fn errors(what: &str, limit: Loss, computed: Loss, mass: f64) -> [Row; 2] {
    let named = |quantity: &str| format!("{quantity}, {what}");
    [
        Row::relative(named("mass loss"), "mg", limit[0], computed[0], mass),
        Row::relative(named("deepest wear"), "mm", limit[1], computed[1], DEPTH),
    ]
}

fn order(three: &[Loss; 3], quantity: usize) -> f64 {
    order_of_differences(three.map(|loss| loss[quantity]))
}

/// Richardson's limit from the last two of values at halved steps, of an error of order `order`.
fn limit(last_two: &[Loss], order: f64) -> Loss {
    let [before, last] = [last_two[0], last_two[1]];
    [0, 1].map(|i| last[i] + (last[i] - before[i]) / (order.exp2() - 1.0))
}

impl Finer {
    fn loss(&self) -> Loss {
        let march = marched(test_of(&self.case()));
        let last = march.state().updates.last().expect("ten updates");
        [last.mass_loss_mg, last.max_depth_mm]
    }

    fn case(&self) -> String {
        let Self {
            increments,
            edge_mm,
            slip_tolerance_mm_per_s,
            repeat_tolerance,
        } = self;
        let time = format!(
            "increments = {increments}\nrepeat_tolerance_mm = {repeat_tolerance:?}\n\
             repeat_tolerance_deg = {repeat_tolerance:?}"
        );
        let edge = format!("edge_mm = {edge_mm:?}");
        let slip = format!("slip_tolerance_mm_per_s = {slip_tolerance_mm_per_s:?}");
        let changes = [
            ("increments = 200", time),
            ("edge_mm = 1.05", edge),
            ("slip_tolerance_mm_per_s = 0.3", slip),
        ];
        let change = |text: String, (line, new): &(&str, String)| {
            assert!(text.contains(line), "the default case has no longer {line}");
            text.replace(line, new)
        };
        changes.iter().fold(default_case::text(), change)
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_refinement() {
        super::CASE.assert_holds();
    }
}
