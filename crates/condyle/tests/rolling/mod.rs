//! A cylinder that rolls over an insert that yields, always the same way, without friction.

use std::f64::consts::PI;

use condyle::{
    Mat3, Vec3,
    contact::{
        Backside, Bodies, ContactLaw, ContactMemory, ContactModel, ContactState, Deformable,
        Settled,
    },
    geometry::{ArticulatingSurface, Counterface, Cylinder, Insert, Meshing, flat_insert},
    spatial::{Pose, RelativeMotion},
};
use condyle_fem::{Elastic, ElasticPlastic, Hardening};

use crate::half_space::{grown_beyond, moved};

const RADIUS_MM: f64 = 24.0;
const MODULUS_MPA: f64 = 463.0;
const POISSON: f64 = 0.46;
/// Half the width of Hertz's contact.
const HALF_WIDTH_MM: f64 = 1.0;
const EDGE_MM: f64 = 0.25;
/// How much larger than the one before each element beyond the small ones is.
const GROWTH: f64 = 1.6;
const HALF_LENGTH_MM: f64 = 100.0;
/// How far from the middle a pass begins and ends.
const HALF_PASS_MM: f64 = 2.5;

/// A block of small elements along the way of the cylinder, as deep as a half-space, and two elements long across.
fn rolled_on() -> Insert {
    let (fine, fine_below, beyond) = (15, 8, 7);
    let meshing = Meshing {
        edge_mm: EDGE_MM,
        layers: fine_below + beyond,
    };
    let wide_mm = 2.0 * (fine + beyond) as f64 * EDGE_MM;
    let deep_mm = (fine_below + beyond) as f64 * EDGE_MM;
    let grid = flat_insert((wide_mm, 2.0 * EDGE_MM), deep_mm, meshing).unwrap();
    moved(&grid, |node| {
        Vec3::new(
            grown_beyond(fine, GROWTH, node.x, EDGE_MM),
            grown_beyond(fine_below, GROWTH, node.y, EDGE_MM),
            node.z / EDGE_MM * HALF_LENGTH_MM,
        )
    })
}

/// A cylinder that rolls over a block again and again.
pub struct Rolling {
    counterface: Counterface,
    insert: Insert,
    surface: ArticulatingSurface,
    law: Deformable,
    peak_mpa: f64,
}

impl Rolling {
    pub fn new() -> Self {
        let insert = rolled_on();
        let elastic = Elastic::new(MODULUS_MPA, POISSON).unwrap();
        let modulus_mpa = MODULUS_MPA / (1.0 - POISSON * POISSON);
        Self {
            counterface: Counterface::Cylinder(Cylinder {
                radius_mm: RADIUS_MM,
            }),
            surface: insert.surface(),
            law: Deformable::new(elastic, 0.0, 1.0, Backside::Bonded, &insert).unwrap(),
            peak_mpa: modulus_mpa * HALF_WIDTH_MM / (2.0 * RADIUS_MM),
            insert,
        }
    }

    /// Rolls so many times over a block whose yield stress in shear is so small a part of the peak of Hertz's pressure;
    /// what accumulates of plastic strain in each pass, at most, in the middle of the way.
    pub fn flows(&mut self, peak_over_shear_yield: f64, passes: usize) -> Vec<f64> {
        let yield_mpa = 3.0_f64.sqrt() * self.peak_mpa / peak_over_shear_yield;
        self.law = self.law.clone().with_material(ElasticPlastic {
            elastic: Elastic::new(MODULUS_MPA, POISSON).unwrap(),
            hardening: Hardening::perfectly_plastic(yield_mpa).unwrap(),
        });
        let mut state = ContactState::default();
        let mut before = vec![0.0; self.insert.mesh().hexes.len()];
        let mut pass = || {
            state = self.pass(std::mem::take(&mut state));
            let under = self
                .law
                .under_surface(&self.insert, &state, 0, &[])
                .unwrap();
            let after = under.plastic.unwrap().plastic_strain;
            let flows = after.iter().zip(&before).enumerate();
            let middle = flows.filter(|(element, _)| self.is_in_the_middle(*element));
            let most = middle
                .map(|(_, (after, before))| after - before)
                .fold(0.0, f64::max);
            before = after;
            most
        };
        (0..passes).map(|_| pass()).collect()
    }

    fn is_in_the_middle(&self, element: usize) -> bool {
        let corners = self.insert.mesh().corners(element);
        (corners.iter().sum::<Vec3>() / 8.0).x.abs() < 0.5 * HALF_WIDTH_MM
    }

    fn pass(&self, state: ContactState) -> ContactState {
        let bodies = Bodies {
            counterface: &self.counterface,
            insert: &self.insert,
            surface: &self.surface,
        };
        let memory = ContactMemory {
            state,
            ..ContactMemory::default()
        };
        let mut contact = self.law.contact(bodies, memory);
        let steps = (2.0 * HALF_PASS_MM / EDGE_MM).round() as usize;
        let mut height_mm = RADIUS_MM;
        for step in 0..=steps {
            height_mm = self.press(
                contact.as_mut(),
                step as f64 * EDGE_MM - HALF_PASS_MM,
                height_mm,
            );
        }
        contact.into_memory().state
    }

    /// Lets the cylinder find the height at which it carries its load there, and the insert flow.
    fn press(&self, contact: &mut dyn ContactModel, x_mm: f64, near_mm: f64) -> f64 {
        let force_n = PI / 2.0 * HALF_WIDTH_MM * self.peak_mpa * 2.0 * HALF_LENGTH_MM;
        let mut height_mm = near_mm;
        loop {
            let centre = Vec3::new(x_mm, height_mm, 0.0);
            let motion = RelativeMotion::at_rest(Pose::new(Mat3::identity(), centre));
            let response = contact.respond(&motion);
            let over_n = -response.wrench.force.y - force_n;
            let stiffness = contact.tangent().by_pose.matrix[(4, 4)];
            if over_n.abs() > 1e-6 * force_n {
                height_mm += (over_n / stiffness.max(1.0)).clamp(-0.05, 0.05);
            } else if contact.settle(&motion).unwrap() == Settled::Yes {
                contact.accept(&motion);
                return height_mm;
            }
        }
    }
}
