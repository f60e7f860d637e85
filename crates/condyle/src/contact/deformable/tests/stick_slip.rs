//! Stick and slip of a ball on an elastic half-space, against Cattaneo and Mindlin.

use super::*;
use crate::contact::deformable::{
    friction::ElasticFriction, friction_memory::FrictionMemory, tests::half_space::AlongHalfSpace,
};

const MU: f64 = 0.07;

fn shear_modulus_mpa() -> f64 {
    MODULUS_MPA / (2.0 * (1.0 + POISSON))
}

/// A ball on a half-space that sticks and slips.
fn sticking(plane: &Plane) -> DeformableContact<'_, BruteForce> {
    let along = AlongHalfSpace::under(&plane.surface, shear_modulus_mpa(), POISSON);
    let along = Arc::new(Compliance::new(along));
    let memory = FrictionMemory::default();
    let friction = ElasticFriction::after(memory, MU, &plane.surface, along);
    plane.contact(0.0).sticking(Some(friction))
}

/// A ball at a depth, its middle shifted along x.
fn shifted(depth_mm: f64, x: f64) -> RelativeMotion {
    pressed(depth_mm, x, 0.0)
}

/// The tangential shift of Cattaneo and Mindlin under a part of the force at which all slides, mm.
fn mindlin_mm(normal_n: f64, radius_mm: f64, part: f64) -> f64 {
    let stiff = 16.0 * shear_modulus_mpa() * radius_mm;
    3.0 * MU * normal_n * (2.0 - POISSON) / stiff * (1.0 - (1.0 - part).powf(2.0 / 3.0))
}

#[test]
fn verify_cattaneo_and_mindlin() {
    let (depth_mm, steps) = (0.408, 10);
    let hertz = Hertz::at(depth_mm);
    let slides_mm = mindlin_mm(hertz.force_n, hertz.radius_mm, 1.0);
    for edge_mm in [1.0, 0.5, 0.25] {
        let plane = Plane::under_sphere(edge_mm);
        let mut contact = sticking(&plane);
        contact.respond(&shifted(depth_mm, 0.0));
        contact.accept(&shifted(depth_mm, 0.0));
        for step in 1..=steps {
            let x = slides_mm * f64::from(step) / f64::from(steps);
            let motion = shifted(depth_mm, x);
            let force = contact.respond(&motion).wrench.force;
            contact.accept(&motion);
            let landing = contact.land(&motion);
            let part = force.x / (-MU * force.y);
            let shift_mm = mindlin_mm(-force.y, hertz.radius_mm, part);
            let sticks =
                |node: &&TouchedNode| node.force_n.xz().norm() < 0.999_999 * MU * load_n(node);
            let sticking_mm2: f64 = landing
                .touched
                .iter()
                .filter(sticks)
                .map(|node| plane.surface.shares[node.node as usize].area_mm2)
                .sum();
            let stick_mm = (sticking_mm2 / PI).sqrt();
            let exact_mm = (1.0 - part).max(0.0).cbrt() * hertz.radius_mm;
            println!(
                "{edge_mm} {x:.5}: T/(mu N) {part:.4}, shift over Mindlin's {:.4}, stick {stick_mm:.3} for {exact_mm:.3}",
                x / shift_mm
            );
        }
    }
}
