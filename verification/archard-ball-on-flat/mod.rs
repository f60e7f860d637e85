//! The volume that Archard's law wears, whatever the shape.

use std::{f64::consts::PI, path::Path};

use condyle::{
    contact::Foundation,
    evolve::March,
    geometry::Counterface,
    machine::{Chain, Simulator},
};

use crate::{
    Case, Row, default_case,
    drives::to_and_fro,
    law::THICKNESS_MM,
    marched::{bodies_of, case_in, marched, run_on, started},
    observed::Observed,
    plate::rubbing,
    pressed::block,
    quadrature::integral,
    rub_test::{MM_PER_M, Rub, WEAR_FACTOR_MM3_PER_NM},
};

pub(crate) const CASE: Case = Case {
    name: "archard-ball-on-flat",
    readme: include_str!("README.md"),
    rows,
};

const RADIUS_MM: f64 = 24.0;
const LOAD_N: f64 = 2000.0;
const AMPLITUDE_MM: f64 = 5.0;
const CYCLES: f64 = 1e5;

fn rows() -> Vec<Row> {
    let mut rows = on_a_flat();
    rows.extend(of_a_knee());
    rows
}

fn on_a_flat() -> Vec<Row> {
    let (contact, stiffness) = rubbing(0.07, 1.0);
    let rub = Rub {
        femur: Counterface::sphere(RADIUS_MM),
        insert: block(24.0, THICKNESS_MM, 0.5),
        contact,
        ap: to_and_fro(AMPLITUDE_MM),
        load_n: LOAD_N,
        increments: 400,
        cycles: CYCLES,
        updates: 1,
    };
    let volume = volumes_mm3(&marched(rub.test())).0;
    let part = sliding_part(overclosure_mm(stiffness), stiffness);
    let archard = WEAR_FACTOR_MM3_PER_NM / MM_PER_M * 4.0 * AMPLITUDE_MM * LOAD_N * CYCLES;
    vec![Row::relative(
        "ball on a flat: volume",
        "mm3",
        archard * part,
        volume,
        1e-4,
    )]
}

/// Overclosure at which the ball carries the load: pi k (R - d) d^2, by Newton's method.
fn overclosure_mm(k: f64) -> f64 {
    let mut d = (LOAD_N / (PI * k * RADIUS_MM)).sqrt();
    for _ in 0..20 {
        let excess = PI * k * (RADIUS_MM - d) * d * d - LOAD_N;
        d -= excess / (PI * k * (2.0 * RADIUS_MM - 3.0 * d) * d);
    }
    d
}

/// The integral of F ds over load times path: int k (R - s) c dA / N, with c the part of the ball's
/// speed that its surface has along the flat.
fn sliding_part(d: f64, k: f64) -> f64 {
    let h = RADIUS_MM - d;
    let edge = (RADIUS_MM * RADIUS_MM - h * h).sqrt();
    let ring = |r: f64| {
        let s = h.hypot(r);
        // The mean round the ring, of a smooth periodic function: exact with a few places.
        let slides = |i: u32| {
            let (sine, cosine) = (PI * f64::from(i) / 16.0).sin_cos();
            let (nx, nz) = (cosine * r / s, sine * r / s);
            (1.0 - nx * nx).hypot(nx * nz)
        };
        let mean = (0..32).map(slides).sum::<f64>() / 32.0;
        2.0 * PI * r * k * (RADIUS_MM - s) * mean
    };
    integral(0.0, edge, ring) / LOAD_N
}

/// Volume from depth and from the mesh.
fn volumes_mm3(march: &March) -> (f64, f64) {
    let last = march.state().updates.last().expect("an update");
    (last.volume_loss_mm3, last.volume_loss_mesh_mm3)
}

fn of_a_knee() -> Vec<Row> {
    let (march, law) = started(&knee());
    let rubbed_nm = rubbed_nmm(&march, &law) / MM_PER_M;
    let exact = WEAR_FACTOR_MM3_PER_NM * rubbed_nm * CYCLES;
    let (depth, mesh) = volumes_mm3(&run_on(march));
    vec![
        Row::relative("generic knee: volume", "mm3", exact, depth, 1e-4),
        Row::relative(
            "generic knee: volume from the mesh",
            "mm3",
            exact,
            mesh,
            0.005,
        ),
    ]
}

fn knee() -> condyle_case::case::Case {
    let default = default_case::text();
    let above = default.split("[march]").next().unwrap_or_default();
    let cycles = CYCLES as u64;
    let text = format!("{above}[march]\ncycles = {cycles}\nupdates = 1\n");
    case_in(&text, Path::new(""))
}

/// Normal force times sliding over the cycle that a march is about to solve.
fn rubbed_nmm(march: &March, law: &Foundation) -> f64 {
    let (test, surface) = (march.test(), march.insert().surface());
    let machine = test.machine();
    let mut contact = Observed::new(law, bodies_of(march, &surface));
    let chain = Chain::new(machine, march.state().zero_mm, test.flexion_axis_mm);
    let mut simulator = Simulator::new(machine, &chain, &mut contact, &test.time);
    let mut watch = |_| std::ops::ControlFlow::Continue(());
    let start = march.state().activities[0].machine;
    let solved = simulator.cycle(&start, &mut watch);
    assert!(solved.expect("a solved cycle").is_continue());
    let step_s = 1.0 / (machine.frequency_hz * test.time.increments as f64);
    let last = contact.instants.len() - test.time.increments;
    let last_cycle = contact.instants[last..].iter();
    last_cycle
        .map(|instant| instant.rubbed_nmm_per_s)
        .sum::<f64>()
        * step_s
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_archard_ball_on_flat() {
        super::CASE.assert_holds();
    }
}
