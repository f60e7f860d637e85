//! The femur of a case pressed on its deformable insert to where it is at places of the first cycle, as CalculiX is
//! to do.
//!
//! `cargo run --release -p condyle-lab --example pressed_at_poses -- CASE FOLDER PERCENT... > pressed.csv`
//!
//! Writes FOLDER/PERCENT.inp, the files of `condyle export --pressed-at`, and prints condyle's answer to them: the femur
//! comes straight down without sliding, in ten increments. `time_s` is that of pressing alone, on an insert whose
//! compliance the cycle solved before has left; `since_start_s` has all in it from reading the case on, the files aside.

use std::{
    error::Error,
    fs::File,
    io::BufWriter,
    path::{Path, PathBuf},
    time::Instant,
};

use condyle::{
    Vec3,
    contact::{ContactMemory, ContactModel, Settled},
    evolve::March,
    spatial::{Pose, RelativeMotion},
};
use condyle_io::{abaqus::PressedCase, case::Case};

/// Increments of pressing.
const INCREMENTS: u32 = 10;
/// How far above the pose the first of them begins, mm: more than the bodies overlap.
const LIFT_MM: f64 = 0.5;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [case, folder, percents @ ..] = &words[..] else {
        return Err("say a case, a folder, and places of the cycle in percent".into());
    };
    let start = Instant::now();
    let case = Case::read(Path::new(case))?;
    let pressed = PressedCase::new(&case, 1)?;
    println!(
        "percent,force_x_n,force_y_n,force_z_n,peak_mpa,highest_node_mpa,time_s,since_start_s"
    );
    for percent in percents {
        let (row, pose) = pressed.at(percent.parse()?)?;
        let answer = answer(pressed.unworn(), &pose)?;
        let since_start_s = start.elapsed().as_secs_f64();
        println!("{},{answer},{since_start_s:.4}", row.percent);
    }
    for percent in percents {
        let path = PathBuf::from(folder).join(format!("{percent}.inp"));
        pressed.write(percent.parse()?, &mut BufWriter::new(File::create(path)?))?;
    }
    Ok(())
}

/// Force on the insert, peak, highest pressure of a node, and seconds of pressing.
fn answer(march: &March, pose: &Pose) -> Result<String, Box<dyn Error>> {
    let surface = march.insert().surface();
    let law = &march.test().contact;
    let mut contact = law.contact(march.bodies(&surface), ContactMemory::default());
    let start = Instant::now();
    for increment in 1..INCREMENTS {
        let left = 1.0 - f64::from(increment) / f64::from(INCREMENTS);
        let lifted = pose.translation + Vec3::new(0.0, LIFT_MM * left, 0.0);
        press(
            contact.as_mut(),
            &RelativeMotion::at_rest(Pose::new(pose.rotation, lifted)),
        )?;
    }
    let motion = RelativeMotion::at_rest(*pose);
    let force_n = press(contact.as_mut(), &motion)?;
    let seconds = start.elapsed().as_secs_f64();
    let landing = contact.land(&motion);
    let pressures = landing.touched.iter().map(|node| node.pressure_mpa);
    let (x, y, z) = (force_n.x, force_n.y, force_n.z);
    let (peak, highest) = (landing.peak_pressure_mpa, pressures.fold(0.0, f64::max));
    Ok(format!(
        "{x:.3},{y:.3},{z:.3},{peak:.4},{highest:.4},{seconds:.4}"
    ))
}

/// Presses until what flows has flowed, and gives the force on the insert.
fn press(contact: &mut dyn ContactModel, motion: &RelativeMotion) -> Result<Vec3, Box<dyn Error>> {
    loop {
        let force_n = contact.respond(motion).wrench.force;
        match contact.settle(motion) {
            Ok(Settled::Yes) => {
                contact.accept(motion);
                return Ok(force_n);
            }
            Ok(Settled::RespondAgain) => {}
            Err(flat) => return Err(format!("pressed flat: {flat:?}").into()),
        }
    }
}
