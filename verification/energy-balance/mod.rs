//! Where the work of a gait cycle goes.

use condyle::{
    evolve::WearTest,
    machine::{Chain, CycleRow, Drive, Integration, Spring},
    spatial::{Mat6, Twist, Vec6},
};

use crate::{
    Case, Row,
    convergence::order_of_errors,
    default_case::{DefaultCase, Solved},
    observed::Instant,
};

pub(crate) const CASE: Case = Case {
    name: "energy-balance",
    readme: include_str!("README.md"),
    rows,
};

/// Part of the work of friction that may be left open.
const MAX_OPEN: f64 = 0.001;
/// The same with the default 200 increments, which follow the quick motions of heel strike coarsely.
const MAX_OPEN_BY_DEFAULT: f64 = 0.01;

/// Where work comes from and goes at one instant, N mm/s, and what is stored, N mm.
#[derive(Clone, Copy)]
struct Flow {
    put_in: f64,
    damping: f64,
    friction: f64,
    /// Through the contact: into friction and into the foundation.
    contact: f64,
    stored: f64,
}

/// Work over a cycle that ends as it starts, N mm.
struct Ledger {
    /// Work of loads and drives less that of the dampers.
    for_friction: f64,
    friction: f64,
    contact: f64,
    /// Largest work unaccounted for at any instant, what is stored counted with.
    most_open: f64,
}

fn rows() -> Vec<Row> {
    let case = DefaultCase::new();
    let ledger = |increments, integration| Ledger::of(&case, &case.solved(increments, integration));
    let implicit = [200, 400, 800].map(|increments| ledger(increments, Integration::Implicit));
    let explicit = ledger(800, Integration::Explicit { least_step_s: 0.0 });
    let [coarse, middle, fine] = &implicit;
    let order = order_of_errors([middle, fine].map(Ledger::lost_in_time), 2.0);
    vec![
        coarse.friction_row("200 increments", MAX_OPEN_BY_DEFAULT),
        middle.friction_row("400 increments", 2.0 * MAX_OPEN),
        fine.friction_row("800 increments", MAX_OPEN),
        explicit.friction_row("explicit, 800 increments", MAX_OPEN),
        fine.open_row("800 increments"),
        explicit.open_row("explicit, 800 increments"),
        coarse.loss_row("200 increments", 0.005),
        fine.loss_row("800 increments", 1e-4)
            .with_order(3.0, order, 0.5),
    ]
}

impl Ledger {
    fn of(case: &DefaultCase, solved: &Solved) -> Self {
        let step_s = 1.0 / (case.test().machine().frequency_hz * solved.rows.len() as f64);
        let chain = case.chain();
        let instants = solved.rows.iter().zip(&solved.contact);
        let flows: Vec<Flow> = instants
            .map(|(row, instant)| Flow::at(case.test(), &chain, row, instant))
            .collect();
        let work = |power: fn(&Flow) -> f64| step_s * flows.iter().map(power).sum::<f64>();
        Self {
            for_friction: work(|flow| flow.put_in - flow.damping),
            friction: work(|flow| flow.friction),
            contact: work(|flow| flow.contact),
            most_open: most_open(&flows, step_s),
        }
    }

    /// What the integrator takes out of the motion, or puts in.
    fn lost_in_time(&self) -> f64 {
        (self.for_friction - self.contact).abs()
    }

    fn friction_row(&self, how: &str, tolerance: f64) -> Row {
        let quantity = format!("work of friction, {how}");
        Row::relative(
            quantity,
            "N mm",
            self.for_friction,
            self.friction,
            tolerance,
        )
    }

    fn open_row(&self, how: &str) -> Row {
        let quantity = format!("largest imbalance of work at any instant, {how}");
        Row::absolute(
            quantity,
            "N mm",
            0.0,
            self.most_open,
            MAX_OPEN * self.friction,
        )
    }

    fn loss_row(&self, how: &str, part: f64) -> Row {
        let quantity = format!("work lost in time integration, {how}");
        Row::absolute(
            quantity,
            "N mm",
            0.0,
            self.lost_in_time(),
            part * self.friction,
        )
    }
}

/// Largest difference of the work done so far and what has become of it, by the trapezoidal rule.
fn most_open(flows: &[Flow], step_s: f64) -> f64 {
    let gain = |flow: &Flow| flow.put_in - flow.damping - flow.friction;
    let (mut gained, mut most) = (0.0, 0.0f64);
    for pair in flows.windows(2) {
        gained += step_s * (gain(&pair[0]) + gain(&pair[1])) / 2.0;
        most = most.max((gained - (pair[1].stored - flows[0].stored)).abs());
    }
    most
}

impl Flow {
    fn at(test: &WearTest, chain: &Chain, row: &CycleRow, instant: &Instant) -> Self {
        let screws = chain.at(&row.positions).screws;
        let rates = rates(&screws, instant);
        let on_femur = instant.wrench.reaction();
        let springs = test.machine().springs.iter();
        let mut flow = Self {
            put_in: 0.0,
            damping: 0.0,
            friction: instant.friction_nmm_per_s,
            contact: -on_femur.power(&instant.twist),
            stored: instant.stored_nmm
                + springs
                    .map(|spring| stored_nmm(spring, &row.positions))
                    .sum::<f64>(),
        };
        for (j, joint) in test.machine().joints.iter().enumerate() {
            let rate = rates[j];
            if let Drive::Loaded(load) = &joint.drive {
                flow.put_in += load.at(row.percent / 100.0).0 * rate;
                flow.damping += joint.damping * rate * rate;
                flow.stored += joint.inertia * rate * rate / 2.0;
            } else {
                flow.put_in -= on_femur.power(&screws[j]) * rate;
            }
        }
        flow
    }
}

/// Rates of the freedoms, from the twist that they make together.
fn rates(screws: &[Twist; 6], instant: &Instant) -> Vec6 {
    let columns = screws.each_ref().map(Twist::numbers);
    let solved = Mat6::from_columns(&columns).lu();
    let solved = solved.solve(&instant.twist.numbers());
    solved.expect("six independent freedoms")
}

/// Energy of a spring that is linear beyond its free play: f^2/(2 k).
fn stored_nmm(spring: &Spring, positions: &[f64; 6]) -> f64 {
    let (ap_mm, ie) = (spring.along.of(positions), spring.about.of(positions));
    match spring.force(ap_mm + spring.offset_mm * ie.sin()) {
        (_, 0.0) => 0.0,
        (force, slope) => -force * force / (2.0 * slope),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_energy_balance() {
        super::CASE.assert_holds();
    }
}
