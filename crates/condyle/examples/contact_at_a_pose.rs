//! The contact of two bodies at a pose, without a machine: force, pressure and area of a ball pressed into a plate.
//!
//! It teaches the contact interface: a [`ContactLaw`] makes the contact of two [`Bodies`], and the contact responds
//! to a motion. The result is compared with the closed form of a paraboloid on a linear foundation. View `rigid_test`
//! first.
//!
//! Run: `cargo run --release -p condyle --example contact_at_a_pose`

use std::{error::Error, f64::consts::PI};

use condyle::{Mat3, prelude::*};

const RADIUS_MM: f64 = 24.0;
const THICKNESS_MM: f64 = 9.0;
const MODULUS_MPA: f64 = 2142.0;
const DEPTH_MM: f64 = 0.1;

fn main() -> Result<(), Box<dyn Error>> {
    // 1. The bodies. The counterface is prepared for the size of the surface's shares, over which pressure is averaged.
    let meshing = Meshing {
        edge_mm: 0.5,
        layers: 1,
    };
    let insert = flat_insert((24.0, 24.0), THICKNESS_MM, meshing)?;
    let surface = insert.surface();
    let counterface = Counterface::sphere(RADIUS_MM).prepared_for(surface.mean_spread_mm2());
    let bodies = Bodies {
        counterface: &counterface,
        insert: &insert,
        surface: &surface,
    };

    // 2. The contact, which has no history yet.
    let pressure = PressureLaw::Linear {
        modulus_mpa: MODULUS_MPA,
    };
    let law = Foundation::new(pressure, 0.0, 1.0);
    let mut contact = law.contact(bodies, ContactMemory::default());

    // 3. The pose of the counterface frame in the insert frame: the ball is DEPTH_MM deep in the plate, at rest.
    let centre_mm = Vec3::new(0.0, RADIUS_MM - DEPTH_MM, 0.0);
    let motion = RelativeMotion::at_rest(Pose::new(Mat3::identity(), centre_mm));
    let force_n = -contact.respond(&motion).wrench.force.y;

    // 4. The nodes in contact, with the peak between nodes as well.
    let result = contact.evaluate(&motion);
    let area_mm2: f64 = result.touched.iter().map(|node| node.covered_mm2).sum();
    println!(
        "force {force_n:.1} N, peak {:.2} MPa, area {area_mm2:.2} mm2",
        result.peak_pressure_mpa
    );

    // 5. Exact for a shallow ball: F = pi R K d^2 / h, A = 2 pi R d, p = K d / h.
    let near =
        |found: f64, exact: f64| assert!((found / exact - 1.0).abs() < 0.01, "{found} {exact}");
    near(
        force_n,
        PI * RADIUS_MM * MODULUS_MPA * DEPTH_MM * DEPTH_MM / THICKNESS_MM,
    );
    near(area_mm2, 2.0 * PI * RADIUS_MM * DEPTH_MM);
    near(
        result.peak_pressure_mpa,
        MODULUS_MPA * DEPTH_MM / THICKNESS_MM,
    );
    Ok(())
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
