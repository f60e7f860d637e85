//! Stick and slip of a ball on an elastic half-space, against Cattaneo and Mindlin.

use super::{half_space::AlongHalfSpace, *};
use crate::contact::{deformable::friction::ElasticFriction, model::ContactState};

const MU: f64 = 0.07;
const DEPTH_MM: f64 = 0.408;

fn shear_modulus_mpa() -> f64 {
    MODULUS_MPA / (2.0 * (1.0 + POISSON))
}

/// A ball on a half-space that sticks and slips, from what a contact before left.
fn sticking<'a>(plane: &'a Plane, state: &ContactState) -> DeformableContact<'a> {
    let along = AlongHalfSpace::under(&plane.surface, shear_modulus_mpa(), POISSON);
    let along = Arc::new(Compliance::new(Arc::new(along)));
    let friction = ElasticFriction::new(state, MU, &plane.surface, along);
    plane.contact_by(Search::BruteForce, 0.0, vec![Box::new(friction)])
}

/// A ball that is pressed, its middle shifted along x and on its way further.
fn shifted(x: f64) -> RelativeMotion {
    RelativeMotion {
        twist: Twist::new(Vec3::zeros(), Vec3::x()),
        ..pressed(DEPTH_MM, x, 0.0)
    }
}

/// A ball that was pressed.
fn pressed_ball(plane: &Plane) -> DeformableContact<'_> {
    let mut contact = sticking(plane, &ContactState::default());
    contact.respond(&shifted(0.0));
    contact.accept(&shifted(0.0));
    contact.evaluate(&shifted(0.0));
    contact
}

/// Moves a ball on; the tangential force over that at which all slides, and where it landed.
fn moved_to(contact: &mut DeformableContact<'_>, x: f64) -> (f64, Vec<TouchedNode>) {
    let force = contact.respond(&shifted(x)).wrench.force;
    contact.accept(&shifted(x));
    (
        force.x / (-MU * force.y),
        contact.evaluate(&shifted(x)).touched,
    )
}

/// The shift of Cattaneo and Mindlin at which all slides, mm.
fn sliding_shift_mm() -> f64 {
    let hertz = Hertz::at(DEPTH_MM);
    let stiff = 16.0 * shear_modulus_mpa() * hertz.radius_mm;
    3.0 * MU * hertz.force_n * (2.0 - POISSON) / stiff
}

/// The shift of Cattaneo and Mindlin under a part of the force at which all slides, over that shift.
fn mindlin(part: f64) -> f64 {
    1.0 - (1.0 - part).powf(2.0 / 3.0)
}

#[test]
fn verify_cattaneo_and_mindlin() {
    let radius_mm = Hertz::at(DEPTH_MM).radius_mm;
    for (edge_mm, within) in [(1.0, 0.04), (0.5, 0.01), (0.25, 0.01)] {
        let plane = Plane::under_sphere(edge_mm);
        let mut contact = pressed_ball(&plane);
        for step in 1..=9 {
            let shift = f64::from(step) / 10.0;
            let (part, touched) = moved_to(&mut contact, shift * sliding_shift_mm());
            let sticking = touched
                .iter()
                .filter(|node| node.sliding_mm_per_s == [0.0; 2]);
            let areas = sticking.map(|node| plane.surface.shares[node.node as usize].area_mm2);
            let stick = (areas.sum::<f64>() / PI).sqrt() / radius_mm;
            let exact = (1.0 - part).cbrt();
            println!(
                "{edge_mm}: T/(mu N) {part:.4}: shift {:.4} of Mindlin's; c/a {stick:.3} for {exact:.3}",
                shift / mindlin(part)
            );
            assert!((shift / mindlin(part) - 1.0).abs() < within);
            // A share sticks or slides as a whole: half an edge either way.
            assert!((stick - exact).abs() < 0.5 * edge_mm / radius_mm);
        }
        // Then all slides, under mu N; the ball's normals lean a little.
        let (part, touched) = moved_to(&mut contact, 1.1 * sliding_shift_mm());
        assert!((part - 1.0).abs() < 0.01, "{part}");
        assert!(touched.iter().all(|node| node.sliding_mm_per_s != [0.0; 2]));
    }
}

/// Of nodes that touch the load along the plane under a ball over x, N: what is beside the force along its normal.
fn rub_n(node: &TouchedNode, plane: &Plane, x: f64) -> f64 {
    let share = &plane.surface.shares[node.node as usize];
    let place = plane.surface.positions[node.node as usize];
    let middle = Vec3::new(x, RADIUS_MM - DEPTH_MM, 0.0);
    let normal = (place - middle).normalize();
    node.force_n.x - node.pressure_mpa * share.area_mm2 * normal.x
}

#[test]
fn verify_the_loop_of_mindlin_and_deresiewicz_and_what_it_dissipates() {
    let plane = Plane::under_sphere(0.5);
    let mut contact = pressed_ball(&plane);
    let (most, steps) = (0.6, 30);
    let part_of = |step: i32| most * f64::from(step) / f64::from(steps);
    let (up, there, back) = (0..=steps, (-steps..steps).rev(), 1 - steps..=steps);
    let way: Vec<i32> = up.chain(there).chain(back).collect();
    let (mut dissipated, mut last, mut work) = (0.0, (0.0, 0.0), 0.0);
    let mut parts = Vec::new();
    for (number, &step) in way.iter().enumerate() {
        let x = part_of(step) * sliding_shift_mm();
        let (part, touched) = moved_to(&mut contact, x);
        let rubs = touched.iter().map(|node| {
            let slips = node.sliding_mm_per_s != [0.0; 2];
            let slip_mm = if slips {
                x - last.0 - node.along_mm[0]
            } else {
                0.0
            };
            (rub_n(node, &plane, x), slip_mm)
        });
        let (force_n, lost): (f64, f64) = rubs
            .fold((0.0, 0.0), |(force_n, lost), (rub_n, slip_mm)| {
                (force_n + rub_n, lost + rub_n * slip_mm)
            });
        if number > steps as usize {
            dissipated += lost;
            work += (x - last.0) * (force_n + last.1) / 2.0;
        }
        last = (x, force_n);
        parts.push(part);
    }
    let turn = parts[steps as usize];
    // Unloading from the turning point: twice as far under half of the change.
    for (step, &part) in way
        .iter()
        .zip(&parts)
        .skip(steps as usize)
        .take(2 * steps as usize)
    {
        let exact =
            2.0 * (1.0 - (turn - part) / 2.0).powf(2.0 / 3.0) - (1.0 - turn).powf(2.0 / 3.0) - 1.0;
        assert!(
            (part_of(*step) - exact).abs() < 0.01,
            "{step} {part} {exact}"
        );
    }
    let closing = parts.last().unwrap() / turn;
    println!(
        "turned at T/(mu N) {turn:.4}, closes to {closing:.5}; work {work:.5} N mm, dissipated {dissipated:.5}"
    );
    assert!((closing - 1.0).abs() < 2e-3, "{closing}");
    assert!(
        (dissipated / work - 1.0).abs() < 0.02,
        "{work} {dissipated}"
    );
}

#[test]
fn tangent_with_stick_and_slip_is_the_derivative_of_the_wrench() {
    let plane = Plane::under_sphere(1.0);
    for way in [0.4, 3.0] {
        let mut contact = pressed_ball(&plane);
        moved_to(&mut contact, way * sliding_shift_mm());
        let turn = nalgebra::Rotation3::new(Vec3::new(0.002, -0.001, 0.003)).into_inner();
        let shift = way * sliding_shift_mm() * Vec3::new(0.5, 0.0, 0.4);
        let place = pressed(DEPTH_MM + 0.01, way * sliding_shift_mm(), 0.0)
            .pose
            .translation;
        let motion = RelativeMotion {
            pose: Pose::new(turn, turn * place + shift),
            twist: Twist::zero(),
        };
        contact.respond(&motion);
        let tangent = contact.tangent();
        let by_pose = by_pose_differences(1e-7, &mut contact, &motion);
        assert_near(&tangent.by_pose.matrix, &by_pose);
        assert_eq!(tangent.by_twist.matrix, Mat6::zeros());
    }
}

#[test]
fn what_sticks_is_tried_until_it_is_accepted_and_goes_through_the_state() {
    let plane = Plane::under_sphere(1.0);
    let mut contact = pressed_ball(&plane);
    contact.begin_cycle();
    let (half, all) = (0.5 * sliding_shift_mm(), sliding_shift_mm());
    moved_to(&mut contact, half);
    let there = contact.respond(&shifted(all)).wrench;
    contact.reject();
    // Trials that are not accepted leave no trace, but for the last digits of what they began the search with.
    contact.respond(&shifted(-all));
    let again = contact.respond(&shifted(all)).wrench;
    assert!((there.numbers() - again.numbers()).amax() < 1e-5);
    let state = Box::new(contact).into_memory().state;
    let resumed = |state: &ContactState| {
        let mut contact = sticking(&plane, state);
        contact.begin_cycle();
        contact.respond(&shifted(all)).wrench
    };
    assert!((there.numbers() - resumed(&state).numbers()).amax() < 1e-5);
    assert_eq!(resumed(&state), resumed(&state));
    let mut again = sticking(&plane, &state);
    again.begin_cycle();
    assert_eq!(Box::new(again).into_memory().state, state);
}
