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
    contact::{ContactModel, Foundation, Pose, RelativeMotion, Vec6},
    evolve::March,
};
use condyle_io::case::Case;

/// Rounds over all poses.
const ROUNDS: usize = 101;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [case, poses] = &words[..] else {
        return Err("say a case and a file of poses".into());
    };
    let poses = read_poses(&std::fs::read_to_string(poses)?)?;
    let march = March::start(Case::read(case.as_ref())?.build(1)?.test)?;
    let test = march.test();
    let mut contact = Foundation::new(&test.contact, &test.femur, &test.insert);
    let times = median_times_us(&mut contact, &poses);
    println!("percent,force_x_n,force_y_n,force_z_n,area_mm2,first_us,again_us");
    for ((percent, pose), [first_us, again_us]) in poses.iter().zip(times) {
        let wrench = contact.respond(&at_rest(pose));
        let touched = contact.touched(&at_rest(pose));
        let area_mm2: f64 = touched.iter().map(|node| node.covered_mm2).sum();
        let (x, y, z) = (wrench[3], wrench[4], wrench[5]);
        println!("{percent:.1},{x:.4},{y:.4},{z:.4},{area_mm2:.4},{first_us:.2},{again_us:.2}");
    }
    Ok(())
}

fn at_rest(pose: &Pose) -> RelativeMotion {
    RelativeMotion {
        pose: *pose,
        twist: Vec6::zeros(),
    }
}

/// Of every pose, the first and the second evaluation.
fn median_times_us(contact: &mut Foundation<'_>, poses: &[(f64, Pose)]) -> Vec<[f64; 2]> {
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

fn time(contact: &mut Foundation<'_>, pose: &Pose) -> Duration {
    let start = Instant::now();
    black_box(contact.respond(&at_rest(pose)));
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
    let pose = Pose {
        rotation: Mat3::from_row_slice(&numbers[1..10]),
        translation: Vec3::from_row_slice(&numbers[10..]),
    };
    Ok((numbers[0], pose))
}
