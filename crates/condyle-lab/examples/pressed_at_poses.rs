//! The femur of a case pressed on its deformable insert to where it is at places of the first cycle, as CalculiX is
//! to do.
//!
//! `cargo run --release -p condyle-lab --example pressed_at_poses -- CASE FOLDER PERCENT... > pressed.csv`
//!
//! Writes FOLDER/PERCENT.inp, the files of `condyle export --pressed-at`, and prints condyle's answer to them: the femur
//! comes straight down without sliding, in ten increments. `time_s` is that of pressing alone, on an insert whose
//! compliance the cycle solved before has left; `since_start_s` has all in it from reading the case on, the files aside.
//! Of an insert that yields there is also the largest plastic strain at a Gauss point, and the force and the highest node at
//! the same pose if it did not yield.

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
use condyle_case::{
    abaqus::PressedCase,
    case::{Case, ContactModelChoice, PlasticityChoice},
};

/// Increments of pressing.
const INCREMENTS: u32 = 10;
/// Distance above the pose at which the first of them begins, mm: more than the overlap of the bodies.
const LIFT_MM: f64 = 0.5;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [case, folder, percents @ ..] = &words[..] else {
        return Err("say a case, a folder, and places of the cycle in percent".into());
    };
    let start = Instant::now();
    let case = Case::read(Path::new(case))?;
    let pressed = PressedCase::new(&case, 1)?;
    let mut answers = Vec::new();
    for percent in percents {
        let (row, pose) = pressed.at(percent.parse()?)?;
        let answer = answer(pressed.unworn(), &pose)?;
        answers.push((row.percent, pose, answer, start.elapsed().as_secs_f64()));
    }
    println!(
        "percent,force_x_n,force_y_n,force_z_n,peak_mpa,highest_node_mpa,time_s,since_start_s,\
         plastic_strain,elastic_force_y_n,elastic_node_mpa"
    );
    let unyielding = unyielding(&case);
    let unyielding = unyielding.as_ref().map(|case| PressedCase::new(case, 1));
    let unyielding = unyielding.transpose()?;
    for (percent, pose, found, since_start_s) in answers {
        print!("{percent},{},{since_start_s:.4},", found.columns());
        match &unyielding {
            Some(elastic) => {
                let elastic = answer(elastic.unworn(), &pose)?;
                let (force_y_n, node_mpa) = (elastic.force_n.y, elastic.highest_node_mpa);
                println!("{:.7},{force_y_n:.3},{node_mpa:.4}", found.plastic_strain);
            }
            None => println!(",,"),
        }
    }
    for percent in percents {
        let path = PathBuf::from(folder).join(format!("{percent}.inp"));
        pressed.write(percent.parse()?, &mut BufWriter::new(File::create(path)?))?;
    }
    Ok(())
}

/// The case with an insert that does not yield, if its own does.
fn unyielding(case: &Case) -> Option<Case> {
    let mut model = case.contact.deformable()?.clone();
    if model.plasticity == PlasticityChoice::None {
        return None;
    }
    model.plasticity = PlasticityChoice::None;
    let mut elastic = case.clone();
    elastic.contact.model = ContactModelChoice::Deformable(model);
    Some(elastic)
}

/// The result of condyle at a pose.
struct Answer {
    /// Force on the insert, N.
    force_n: Vec3,
    peak_mpa: f64,
    highest_node_mpa: f64,
    /// Seconds of pressing.
    time_s: f64,
    /// The largest at a Gauss point.
    plastic_strain: f64,
}

impl Answer {
    fn columns(&self) -> String {
        let (x, y, z) = (self.force_n.x, self.force_n.y, self.force_n.z);
        let (peak, highest, time_s) = (self.peak_mpa, self.highest_node_mpa, self.time_s);
        format!("{x:.3},{y:.3},{z:.3},{peak:.4},{highest:.4},{time_s:.4}")
    }
}

fn answer(march: &March, pose: &Pose) -> Result<Answer, Box<dyn Error>> {
    let surface = march.surface();
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
    let time_s = start.elapsed().as_secs_f64();
    let landing = contact.evaluate(&motion);
    let pressures = landing.touched.iter().map(|node| node.pressure_mpa);
    let left = contact.into_memory();
    let under = law.under_surface(march.insert(), &left.state, 0, &[]);
    let plastic = under.and_then(|under| under.plastic);
    let strains = plastic.map_or_else(Vec::new, |plastic| plastic.plastic_strain);
    Ok(Answer {
        force_n,
        peak_mpa: landing.peak_pressure_mpa,
        highest_node_mpa: pressures.fold(0.0, f64::max),
        time_s,
        plastic_strain: strains.into_iter().fold(0.0, f64::max),
    })
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
