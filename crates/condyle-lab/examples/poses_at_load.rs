//! Prints poses of the femur in static balance under one axial force, at places spread evenly over
//! the gait's flexion.
//!
//! `cargo run --release -p condyle-lab --example poses_at_load -- CASE FORCE_N COUNT > poses.csv`
//!
//! A row a pose: place in the gait, %, rotation (row by row) from the femoral frame's directions to
//! the insert's, and the femoral frame's origin in the insert frame, mm.

use std::error::Error;

use condyle::{
    contact::{Bodies, ContactMemory},
    evolve::{March, WearTest},
    machine::{Chain, Drive, SolverCounters, Waveform, knee, settle},
    spatial::Pose,
};
use condyle_case::case::Case;

/// Force left out of balance, N.
const TOLERANCE_N: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [case, force_n, count] = &words[..] else {
        return Err("say a case, a force in N, and how many poses".into());
    };
    let (force_n, count): (f64, u32) = (force_n.parse()?, count.parse()?);
    let march = March::start(Case::read(case.as_ref())?.build(1)?.test)?;
    println!("percent,xx,xy,xz,yx,yy,yz,zx,zy,zz,x_mm,y_mm,z_mm");
    for place in 0..count {
        let phase = f64::from(place) / f64::from(count);
        println!("{}", row(phase, &balanced(&march, phase, force_n)?));
    }
    Ok(())
}

fn balanced(march: &March, phase: f64, force_n: f64) -> Result<Pose, String> {
    let test = march.test();
    let chain = Chain::new(test.machine(), march.state().zero_mm, test.flexion_axis_mm);
    let bodies = Bodies {
        counterface: march.counterface(),
        insert: march.insert(),
        surface: &march.surface(),
    };
    let mut contact = test.contact.contact(bodies, ContactMemory::default());
    let mut machine = test.machine().clone();
    machine.joint_mut(knee::FLEXION).drive = Drive::Locked(flexion(test, phase));
    machine.joint_mut(knee::IS).drive = Drive::Loaded(Waveform::constant(-force_n));
    settle(
        &machine,
        &chain,
        contact.as_mut(),
        TOLERANCE_N,
        &mut SolverCounters::default(),
    )
    .map(|positions| chain.at(&positions).pose)
    .map_err(|failed| format!("no balance at {:.0} %: {failed:?}", 100.0 * phase))
}

fn flexion(test: &WearTest, phase: f64) -> f64 {
    match &test.machine().joint(knee::FLEXION).drive {
        Drive::Prescribed(waveform) => waveform.at(phase).0,
        Drive::Locked(at) => *at,
        Drive::Loaded(_) => 0.0,
    }
}

fn row(phase: f64, pose: &Pose) -> String {
    let rotation = pose.rotation.transpose();
    let numbers = rotation.iter().chain(pose.translation.iter());
    let numbers: Vec<String> = numbers.map(|number| format!("{number:.12}")).collect();
    format!("{:.1},{}", 100.0 * phase, numbers.join(","))
}
