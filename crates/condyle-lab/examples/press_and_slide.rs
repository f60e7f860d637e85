//! A ball of 24 mm pressed 0.25 mm into a bonded block of 20 x 20 x 10 mm and slid 2 mm, as CalculiX is to do.
//!
//! `cargo run --release -p condyle-lab --example press_and_slide -- PRESSED.inp SLID.inp > block.csv`
//!
//! The block has 31 x 24 x 12 = 8,928 hexahedra, the polyethylene of a case and friction of 0.07. The files are for
//! CalculiX, the first without the slide and without friction; what is printed is the answer of condyle after each step,
//! the second with either model of friction, and the time until then, which begins before the stiffness is put together.

use std::{error::Error, fs::File, io::BufWriter, time::Instant};

use condyle::{
    Mat3, Vec3,
    contact::{
        Backside, Bodies, ContactLaw, ContactMemory, ContactModel, Deformable, FrictionModel,
    },
    geometry::{Counterface, Insert, Meshing, TriangleMesh, flat_insert},
    spatial::{Pose, RelativeMotion, Twist},
};
use condyle_case::abaqus::{Pressed, Slide};
use condyle_fem::Elastic;

const RADIUS_MM: f64 = 24.0;
const DEPTH_MM: f64 = 0.25;
const SLIDE_MM: f64 = 2.0;
const FRICTION: f64 = 0.07;
const SIZE_MM: Vec3 = Vec3::new(20.0, 10.0, 20.0);
const HEXAHEDRA: Vec3 = Vec3::new(31.0, 12.0, 24.0);
/// Increments of pressing, and of sliding.
const PRESSING: u32 = 10;
const SLIDING: u32 = 20;
/// Much above the speed at which friction is nearly full.
const SPEED_MM_PER_S: f64 = 20.0;
const SLIP_TOLERANCE_MM_PER_S: f64 = 0.01;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [pressed_path, slid_path] = &words[..] else {
        return Err("say where the two files are to be".into());
    };
    let insert = block()?;
    let femur = Counterface::sphere(RADIUS_MM);
    let surface = insert.surface();
    let bodies = Bodies {
        counterface: &femur,
        insert: &insert,
        surface: &surface,
    };
    let elastic = Elastic::new(463.0, 0.46)?;
    println!("place,step,force_x_n,force_y_n,peak_mpa,highest_node_mpa,time_s");
    for (model, place) in [
        (FrictionModel::Regularised, "slid"),
        (FrictionModel::StickSlip, "sticks"),
    ] {
        let start = Instant::now();
        let mut law = Deformable::new(
            elastic,
            FRICTION,
            SLIP_TOLERANCE_MM_PER_S,
            Backside::Bonded,
            &insert,
        )?;
        law.friction_model = model;
        let mut contact = law.contact(bodies, ContactMemory::default());
        let answer = press(contact.as_mut());
        if model == FrictionModel::Regularised {
            println!(
                "pressed,PRESSED,{answer},{:.4}",
                start.elapsed().as_secs_f64()
            );
        }
        let answer = slide(contact.as_mut());
        println!("{place},SLID,{answer},{:.4}", start.elapsed().as_secs_f64());
    }
    let pressed = Pressed {
        title: "Ball pressed on a block",
        note: "A ball of 24 mm, 0.25 mm deep in a bonded block; it slides 2 mm if there is a second step.",
        bodies,
        triangles: &cap(),
        elastic,
        hardening: None,
        pose: at(0.0, DEPTH_MM),
        slide: None,
    };
    pressed.write(&mut BufWriter::new(File::create(pressed_path)?))?;
    let slid = Pressed {
        slide: Some(Slide {
            by_mm: Vec3::new(SLIDE_MM, 0.0, 0.0),
            friction: FRICTION,
        }),
        ..pressed
    };
    slid.write(&mut BufWriter::new(File::create(slid_path)?))?;
    Ok(())
}

fn block() -> Result<Insert, Box<dyn Error>> {
    let meshing = Meshing {
        edge_mm: 1.0,
        layers: HEXAHEDRA.y as usize,
    };
    let grid = flat_insert((HEXAHEDRA.x, HEXAHEDRA.z), HEXAHEDRA.y, meshing)?;
    let mut mesh = grid.mesh().clone();
    for node in &mut mesh.nodes {
        *node = node.component_mul(&SIZE_MM.component_div(&HEXAHEDRA));
    }
    let at = |height_mm: f64| {
        let mut quads = mesh.boundary_quads();
        quads.retain(|quad| {
            mesh.positions(quad)
                .all(|node| (node.y - height_mm).abs() < 1e-9)
        });
        quads
    };
    let (top, bottom) = (at(0.0), at(-SIZE_MM.y));
    Ok(Insert::new(mesh, &top, &bottom)?)
}

/// The lower cap of the ball, coarsely.
fn cap() -> TriangleMesh {
    const HALF: i32 = 12;
    let side = 2 * HALF as u32 + 1;
    let heights = (-HALF..=HALF).flat_map(|z| {
        (-HALF..=HALF).map(move |x| Vec3::new(f64::from(x) / 2.0, 0.0, f64::from(z) / 2.0))
    });
    let down = |at: Vec3| at - (RADIUS_MM.powi(2) - at.norm_squared()).sqrt() * Vec3::y();
    let corner = |x: u32, z: u32| z * side + x;
    let squares = (0..side - 1).flat_map(|z| (0..side - 1).map(move |x| (x, z)));
    TriangleMesh {
        vertices: heights.map(down).collect(),
        triangles: squares
            .flat_map(|(x, z)| {
                let [a, b, c, d] = [
                    corner(x, z),
                    corner(x + 1, z),
                    corner(x + 1, z + 1),
                    corner(x, z + 1),
                ];
                [[a, b, c], [a, c, d]]
            })
            .collect(),
    }
}

fn at(x_mm: f64, depth_mm: f64) -> Pose {
    Pose::new(Mat3::identity(), Vec3::new(x_mm, RADIUS_MM - depth_mm, 0.0))
}

fn press(contact: &mut dyn ContactModel) -> String {
    let motion = |increment: u32| {
        let part = f64::from(increment) / f64::from(PRESSING);
        RelativeMotion::at_rest(at(0.0, DEPTH_MM * part))
    };
    go(contact, PRESSING, motion)
}

fn slide(contact: &mut dyn ContactModel) -> String {
    let twist = Twist::new(Vec3::zeros(), Vec3::new(SPEED_MM_PER_S, 0.0, 0.0));
    let motion = |increment: u32| {
        let part = f64::from(increment) / f64::from(SLIDING);
        RelativeMotion {
            pose: at(SLIDE_MM * part, DEPTH_MM),
            twist,
        }
    };
    go(contact, SLIDING, motion)
}

/// The answer to the last of so many increments.
fn go(
    contact: &mut dyn ContactModel,
    increments: u32,
    motion: impl Fn(u32) -> RelativeMotion,
) -> String {
    for increment in 1..increments {
        contact.respond(&motion(increment));
        contact.accept(&motion(increment));
    }
    let answer = answer(contact, &motion(increments));
    contact.accept(&motion(increments));
    answer
}

/// Force on the insert along x and y, peak, and highest pressure of a node.
fn answer(contact: &mut dyn ContactModel, motion: &RelativeMotion) -> String {
    let force_n = contact.respond(motion).wrench.force;
    let landing = contact.evaluate(motion);
    let pressures = landing.touched.iter().map(|node| node.pressure_mpa);
    let (x, y, peak) = (force_n.x, force_n.y, landing.peak_pressure_mpa);
    format!(
        "{x:.3},{y:.3},{peak:.4},{:.4}",
        pressures.fold(0.0, f64::max)
    )
}
