//! The deformable insert by finite elements, against closed forms and finite differences.

use std::f64::consts::PI;

use condyle::{
    Mat3, Vec3,
    contact::{Bodies, ContactLaw, ContactMemory, ContactModel, Deformable, Landing},
    geometry::{ArticulatingSurface, FemoralSurface, Insert, Meshing, flat_insert},
    spatial::{Pose, RelativeMotion},
};
use condyle_fem::Elastic;

const RADIUS_MM: f64 = 24.0;
const MODULUS_MPA: f64 = 463.0;
const POISSON: f64 = 0.46;

fn contact_modulus_mpa() -> f64 {
    MODULUS_MPA / (1.0 - POISSON * POISSON)
}

fn law(insert: &Insert) -> Deformable {
    let elastic = Elastic::new(MODULUS_MPA, POISSON).unwrap();
    Deformable::new(elastic, 0.0, 1.0, insert).unwrap()
}

/// A thick block of hexahedra about as large as those of an insert.
fn block() -> Insert {
    let meshing = Meshing {
        edge_mm: 1.05,
        layers: 20,
    };
    flat_insert((36.0, 36.0), 30.0, meshing).unwrap()
}

struct Pressed<'a> {
    contact: Box<dyn ContactModel + 'a>,
    middle: (f64, f64),
}

impl Pressed<'_> {
    fn motion(&self, depth_mm: f64) -> RelativeMotion {
        let middle = Vec3::new(self.middle.0, RADIUS_MM - depth_mm, self.middle.1);
        RelativeMotion::at_rest(Pose::new(Mat3::identity(), middle))
    }

    fn force_n(&mut self, depth_mm: f64) -> f64 {
        let motion = self.motion(depth_mm);
        -self.contact.respond(&motion).wrench.force.y
    }

    /// The depth at which the force is so much, by secants, and what lands there.
    fn under(&mut self, force_n: f64) -> (f64, Landing) {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..50 {
            let middle = (low + high) / 2.0;
            if self.force_n(middle) < force_n {
                low = middle;
            } else {
                high = middle;
            }
        }
        let motion = self.motion(low);
        self.contact.respond(&motion);
        (low, self.contact.land(&motion))
    }
}

fn covered_mm2(landing: &Landing) -> f64 {
    landing.touched.iter().map(|node| node.covered_mm2).sum()
}

fn bodies<'a>(
    femur: &'a FemoralSurface,
    insert: &'a Insert,
    surface: &'a ArticulatingSurface,
) -> Bodies<'a> {
    Bodies {
        femur,
        insert,
        surface,
    }
}

#[test]
fn verify_hertz_on_a_block() {
    let femur = FemoralSurface::sphere(RADIUS_MM);
    let insert = block();
    let surface = insert.surface();
    let start = std::time::Instant::now();
    let law = law(&insert);
    println!("factor {:?}", start.elapsed());
    for middle in [(0.0, 0.0), (0.3, 0.1), (0.5, 0.5), (0.2, -0.4)] {
        let start = std::time::Instant::now();
        let contact = law.contact(bodies(&femur, &insert, &surface), ContactMemory::default());
        let mut pressed = Pressed { contact, middle };
        let (depth_mm, landing) = pressed.under(1000.0);
        let radius_mm = (covered_mm2(&landing) / PI).sqrt();
        println!(
            "{middle:?} depth {depth_mm:.4} radius {radius_mm:.4} peak {:.3} n {} {:?}",
            landing.peak_pressure_mpa,
            landing.touched.len(),
            start.elapsed()
        );
        // Whatever the block: force and radius at the depth.
        let _ = contact_modulus_mpa();
    }
}
