//! A wear test of a knee from two parametric shapes, with rigid bodies on an elastic foundation.
//!
//! It teaches how bodies, machine, contact law and wear law make a [`WearTest`], how a [`March`] runs it update
//! by update, and how to read the results. View this example first.
//!
//! Run: `cargo run --release -p condyle --example rigid_test`

use std::{error::Error, sync::Arc};

use condyle::{contact::confined_modulus, machine::knee, prelude::*};

fn main() -> Result<(), Box<dyn Error>> {
    // 1. Two shapes. The coarse mesh keeps the example quick; shipped cases use 1.05 mm.
    let counterface = GenericFemur::new(GenericFemurShape::default());
    let meshing = Meshing {
        edge_mm: 2.5,
        layers: 2,
    };
    let insert = GenericInsertShape::default().insert(meshing)?;

    // 2. The contact: polyethylene of 463 MPa, a linear foundation, Coulomb friction.
    let pressure = PressureLaw::Linear {
        modulus_mpa: confined_modulus(463.0, 0.46),
    };
    let contact = Foundation::new(pressure, 0.07, 1.0);

    // 3. The test: 2 million cycles, the surface updated four times.
    let test = WearTest {
        counterface: Arc::new(Counterface::Generic(counterface)),
        flexion_axis_mm: (0.0, 0.0),
        start_mm: (0.0, 0.0),
        start_height_mm: None,
        insert: Arc::new(insert),
        contact: Arc::new(contact),
        activities: vec![Activity::only("walking", walking()?)],
        wear: Arc::new(Archard {
            wear_factor_mm3_per_nm: 2.64e-7,
        }),
        comparison_laws: Vec::new(),
        law_family: false,
        creep: None,
        density_mg_per_mm3: 0.93,
        time: TimeSettings {
            increments: 60,
            ..TimeSettings::default()
        },
        schedule: Schedule::fixed(2e6, 4),
    };

    // 4. Lower the counterface until it rests, then march until all cycles are done. `March::update` takes one step,
    //    and its closure can stop it after any increment.
    let mut march = March::start(test)?;
    march.run()?;
    println!("cycles      mass (mg)  depth (mm)  peak pressure (MPa)");
    for update in &march.state().updates {
        println!(
            "{:>9.0}  {:>9.3}  {:>10.4}  {:>19.2}",
            update.cycles, update.mass_loss_mg, update.max_depth_mm, update.peaks.peak_pressure_mpa
        );
    }

    // 5. Two estimates of the worn volume agree: depth times area, and the change of the mesh.
    let updates = &march.state().updates;
    let end = &updates[updates.len() - 1];
    let difference = end.volume_loss_mm3 / end.volume_loss_mesh_mm3 - 1.0;
    println!(
        "volume from depth and from the mesh differ by {:.2} %",
        100.0 * difference
    );
    assert!(difference.abs() < 0.02);
    assert!(end.mass_loss_mg > updates[0].mass_loss_mg);
    Ok(())
}

/// Flexion and AP motion are prescribed, the axial load has two peaks, varus-valgus is free; the other joints
/// stay locked.
fn walking() -> Result<Machine, Box<dyn Error>> {
    let wave = |points: &[(f64, f64)]| {
        let knot = |&(percent, value): &(f64, f64)| Knot { percent, value };
        Waveform::new(points.iter().map(knot).collect(), Interpolation::HalfCosine)
    };
    let mut machine = Machine::new(&knee::KNEE);
    let degree = 1_f64.to_radians();
    let flexion = [
        (0.0, 0.0),
        (15.0, 18.0 * degree),
        (40.0, 5.0 * degree),
        (70.0, 58.0 * degree),
    ];
    machine.joint_mut(knee::FLEXION).drive = Drive::Prescribed(wave(&flexion)?);
    machine.joint_mut(knee::AP).drive = Drive::Prescribed(wave(&[(0.0, 0.0), (60.0, 5.0)])?);
    let axial_n = [
        (0.0, -170.0),
        (13.0, -2600.0),
        (25.0, -850.0),
        (45.0, -2450.0),
        (65.0, -170.0),
    ];
    machine.joint_mut(knee::IS).drive = Drive::Loaded(wave(&axial_n)?);
    machine.joint_mut(knee::VV).drive = Drive::Loaded(Waveform::constant(0.0));
    Ok(machine)
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
