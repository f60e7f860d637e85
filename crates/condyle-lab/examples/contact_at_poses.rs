//! Contact force, area and time of one evaluation at given poses of the femur at rest.
//!
//! `cargo run --release -p condyle-lab --example contact_at_poses -- CASE POSES.csv > contact.csv`
//!
//! The poses are those that the example `poses_at_load` prints. Times are medians of wrench and
//! tangent: `first_us` right after the femur jumped there from the pose before, so that everything
//! that has come near must be found, `again_us` of the same pose once more.

use std::{
    error::Error,
    hint::black_box,
    time::{Duration, Instant},
};

use condyle::{
    Mat3, Vec3,
    contact::{Bodies, ContactMemory, ContactModel},
    evolve::March,
    spatial::{Pose, RelativeMotion},
};
use condyle_case::case::Case;

/// Rounds over all poses.
const ROUNDS: usize = 101;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [case, poses] = &words[..] else {
        return Err("say a case and a file of poses".into());
    };
    let poses = read_poses(&std::fs::read_to_string(poses)?)?;
    let march = March::start(Case::read(case.as_ref())?.build(1)?.test)?;
    let bodies = Bodies {
        counterface: march.counterface(),
        insert: march.insert(),
        surface: &march.surface(),
    };
    let law = &march.test().contact;
    let mut contact = law.contact(bodies, ContactMemory::default());
    let times = median_times_us(contact.as_mut(), &poses);
    println!("percent,force_x_n,force_y_n,force_z_n,area_mm2,first_us,again_us");
    for ((percent, pose), [first_us, again_us]) in poses.iter().zip(times) {
        let motion = RelativeMotion::at_rest(*pose);
        let force_n = contact.respond(&motion).wrench.force;
        let touched = contact.evaluate(&motion).touched;
        let area_mm2: f64 = touched.iter().map(|node| node.covered_mm2).sum();
        let (x, y, z) = (force_n.x, force_n.y, force_n.z);
        println!("{percent:.1},{x:.4},{y:.4},{z:.4},{area_mm2:.4},{first_us:.2},{again_us:.2}");
    }
    Ok(())
}

/// Of every pose, the first and the second evaluation.
fn median_times_us(contact: &mut dyn ContactModel, poses: &[(f64, Pose)]) -> Vec<[f64; 2]> {
    let mut times = vec![[const { Vec::new() }; 2]; poses.len()];
    for _ in 0..ROUNDS {
        for ((_, pose), times) in poses.iter().zip(&mut times) {
            for times in times {
                times.push(time(contact, pose));
            }
        }
    }
    times.into_iter().map(|both| both.map(median_us)).collect()
}

fn time(contact: &mut dyn ContactModel, pose: &Pose) -> Duration {
    let motion = RelativeMotion::at_rest(*pose);
    let start = Instant::now();
    let response = contact.respond(&motion);
    black_box(response.wrench);
    black_box(contact.tangent());
    start.elapsed()
}

fn median_us(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    times[times.len() / 2].as_secs_f64() * 1e6
}

fn read_poses(text: &str) -> Result<Vec<(f64, Pose)>, Box<dyn Error>> {
    text.lines().skip(1).map(read_pose).collect()
}

fn read_pose(line: &str) -> Result<(f64, Pose), Box<dyn Error>> {
    let numbers: Vec<f64> = line.split(',').map(str::parse).collect::<Result<_, _>>()?;
    if numbers.len() != 13 {
        return Err(format!("a pose has 13 numbers, this row has {}", numbers.len()).into());
    }
    let pose = Pose::new(
        Mat3::from_row_slice(&numbers[1..10]),
        Vec3::from_row_slice(&numbers[10..]),
    );
    Ok((numbers[0], pose))
}
