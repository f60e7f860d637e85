//! A wear law of one's own: implement [`WearLaw`] and give it to a test.
//!
//! It teaches what a law sees of a node ([`MeanCycle`]), how another law is evaluated for comparison on the same
//! cycles, and a check against a closed form. View `rigid_test` first.
//!
//! Run: `cargo run --release -p condyle --example custom_wear_law`

use std::{error::Error, sync::Arc};

use condyle::{machine::knee, prelude::*};

/// Archard's law with a wear factor that falls with the pressure: Kw (p0 / p)^exponent for each increment.
#[derive(Debug)]
struct FallingWearFactor {
    wear_factor_mm3_per_nm: f64,
    reference_pressure_mpa: f64,
    exponent: f64,
}

impl WearLaw for FallingWearFactor {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        // Every instant that the node is pressed, weighted by the share of its activity and the loaded part of its surface.
        let depth_mm = |(share, moment): (f64, condyle::contact::Moment)| {
            let relative = self.reference_pressure_mpa / moment.pressure_mpa;
            let factor_mm2_per_n =
                self.wear_factor_mm3_per_nm / 1000.0 * relative.powf(self.exponent);
            share * factor_mm2_per_n * moment.pressure_mpa * moment.distance_mm()
        };
        let pressed = cycle
            .moments()
            .filter(|(_, moment)| moment.pressure_mpa > 0.0);
        NodeWear::of_depth(pressed.map(depth_mm).sum())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let law = FallingWearFactor {
        wear_factor_mm3_per_nm: 2.64e-7,
        reference_pressure_mpa: 10.0,
        exponent: 0.5,
    };
    let mut march = March::start(ball_on_plate(Arc::new(law))?)?;
    march.run()?;
    let state = march.state();
    let own_mm3 = state.updates[0].volume_loss_mm3;
    let archard_mm3 = state.comparison_laws[0].volume_mm3;
    println!("own law {own_mm3:.4} mm3, Archard {archard_mm3:.4} mm3");

    // On a flat plate Archard's law wears Kw F S, whatever the pressure: 500 N over 12 mm a cycle.
    let exact_mm3 = 2.64e-7 * 500.0 * 12.0 / 1000.0 * 1e5;
    assert!(
        (archard_mm3 / exact_mm3 - 1.0).abs() < 0.01,
        "{archard_mm3} {exact_mm3}"
    );
    // The ball presses with more than 10 MPa almost everywhere: the factor is smaller.
    assert!(own_mm3 < archard_mm3);
    Ok(())
}

/// A ball of 24 mm radius, pressed by 500 N, that rubs 6 mm to and fro on a plate; the test also evaluates
/// Archard's law.
fn ball_on_plate(wear: Arc<dyn WearLaw>) -> Result<WearTest, Box<dyn Error>> {
    let meshing = Meshing {
        edge_mm: 1.0,
        layers: 1,
    };
    let mut machine = Machine::new(&knee::KNEE);
    let knot = |percent, value| Knot { percent, value };
    let to_and_fro = vec![knot(0.0, -3.0), knot(50.0, 3.0)];
    machine.joint_mut(knee::AP).drive =
        Drive::Prescribed(Waveform::new(to_and_fro, Interpolation::HalfCosine)?);
    machine.joint_mut(knee::IS).drive = Drive::Loaded(Waveform::constant(-500.0));
    let pressure = PressureLaw::Linear {
        modulus_mpa: 2142.0,
    };
    let archard = WEAR_LAWS.iter().find(|kind| kind.word == "archard");
    let archard = archard.expect("it is built in").with_defaults();
    Ok(WearTest {
        counterface: Arc::new(Counterface::sphere(24.0)),
        flexion_axis_mm: (0.0, 0.0),
        start_mm: (0.0, 0.0),
        start_height_mm: None,
        insert: Arc::new(flat_insert((32.0, 24.0), 9.0, meshing)?),
        contact: Arc::new(Foundation::new(pressure, 0.07, 1.0)),
        activities: vec![Activity::only("rub", machine)],
        wear,
        comparison_laws: vec![archard],
        law_family: false,
        creep: None,
        density_mg_per_mm3: 0.93,
        time: TimeSettings {
            increments: 80,
            ..TimeSettings::default()
        },
        schedule: Schedule::fixed(1e5, 1),
    })
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
