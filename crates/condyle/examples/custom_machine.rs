//! A machine that is no knee simulator: a ball that orbits on a disc, described as a table of six joints.
//!
//! It teaches how a [`Mechanism`] names its joints and axes, what each does while the machine settles, and how a
//! machine drives them. A flat disc wears Kw F s on every path, which checks the run. View `rigid_test` first.
//!
//! Run: `cargo run --release -p condyle --example custom_machine`

use std::{error::Error, f64::consts::PI, sync::Arc};

use condyle::{
    machine::{
        Axis, Channel, ChannelUnit, CycleQuantity, JointDescription, JointIndex, Loading,
        MovedBody, Region, Settling, TestedJoint,
    },
    prelude::*,
};

/// The load on the ball as a case file would name it; compression is positive there, and negative along y.
static LOAD: Channel = Channel {
    name: "ball_load",
    about: "Load that presses the ball on the disc.",
    unit: ChannelUnit::Newton,
    sign: -1.0,
    least: 0.0,
    most: 1000.0,
};

/// A joint that is held at zero unless a machine drives it.
const fn held(name: &'static str, column: &'static str, axis: Axis) -> JointDescription {
    JointDescription {
        name,
        column,
        symbol: name,
        long_name: name,
        title: name,
        positive: "positive",
        decimals: 3,
        least_span: 1.0,
        axis,
        moves: MovedBody::Counterface,
        settling: Settling::HeldAtZero,
        is_zeroed: false,
        inertia: 1e-3,
        damping: 0.0,
        motion: None,
        load: Loading::None,
    }
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// From the disc (the insert) to the ball (the counterface): three rotations that stay locked, then the orbit and the load.
const JOINTS: [JointDescription; 6] = [
    held("turn", "turn_deg", Axis::About(Y)),
    held("tilt", "tilt_deg", Axis::About(X)),
    held("roll", "roll_deg", Axis::About(Z)),
    held("fore", "fore_mm", Axis::Along(X)),
    held("aside", "aside_mm", Axis::Along(Z)),
    JointDescription {
        settling: Settling::Driven,
        is_zeroed: true,
        load: Loading::By(&LOAD),
        ..held("press", "press_mm", Axis::Along(Y))
    },
];

const TURN: JointIndex = JointIndex::ALL[0];
const TILT: JointIndex = JointIndex::ALL[1];
const ROLL: JointIndex = JointIndex::ALL[2];
const FORE: JointIndex = JointIndex::ALL[3];
const ASIDE: JointIndex = JointIndex::ALL[4];
const PRESS: JointIndex = JointIndex::ALL[5];

static BALL_ON_DISC: Mechanism = Mechanism {
    joints: JOINTS,
    tests: TestedJoint::Specimen,
    in_files: &[FORE, ASIDE, PRESS, TURN, TILT, ROLL],
    channels: &[&LOAD],
    columns: &[
        CycleQuantity::Position(FORE),
        CycleQuantity::Position(ASIDE),
        CycleQuantity::AxialForce,
        CycleQuantity::PeakPressure,
    ],
    regions: &[Region {
        name: "disc",
        label: "Disc",
        column: "disc_force_n",
        title: "Force on the disc",
    }],
};

const LOAD_N: f64 = 80.0;
const ORBIT_MM: f64 = 5.0;
const CYCLES: f64 = 1e6;
const WEAR_FACTOR_MM3_PER_NM: f64 = 1e-7;

fn main() -> Result<(), Box<dyn Error>> {
    let mut march = March::start(ball_on_disc()?)?;
    march.run()?;
    let updates = &march.state().updates;
    let worn_mm3 = updates[updates.len() - 1].volume_loss_mm3;
    let path_m = 2.0 * PI * ORBIT_MM / 1000.0 * CYCLES;
    let exact_mm3 = WEAR_FACTOR_MM3_PER_NM * LOAD_N * path_m;
    println!("worn {worn_mm3:.4} mm3, Kw F s = {exact_mm3:.4} mm3");
    assert!((worn_mm3 / exact_mm3 - 1.0).abs() < 0.01);

    // The columns that the table declares, at the end of the last cycle's first increment.
    let cycle = march.last_cycle().ok_or("no cycle was solved")?;
    for &quantity in BALL_ON_DISC.columns {
        let value = BALL_ON_DISC.value(quantity, &cycle.rows[0]);
        println!("{:>20} {value:.3}", BALL_ON_DISC.column(quantity));
    }
    Ok(())
}

fn ball_on_disc() -> Result<WearTest, Box<dyn Error>> {
    // A half-cosine through two knots is a whole cosine; a quarter of a cycle apart, two of them are an orbit.
    let cosine = |percent: f64| {
        let knot = |percent, value| Knot { percent, value };
        let knots = vec![knot(percent, -ORBIT_MM), knot(percent + 50.0, ORBIT_MM)];
        Waveform::new(knots, Interpolation::HalfCosine)
    };
    let mut machine = Machine::new(&BALL_ON_DISC);
    machine.joint_mut(FORE).drive = Drive::Prescribed(cosine(0.0)?);
    machine.joint_mut(ASIDE).drive = Drive::Prescribed(cosine(25.0)?);
    machine.joint_mut(PRESS).drive = Drive::Loaded(Waveform::constant(-LOAD_N));
    let meshing = Meshing {
        edge_mm: 1.0,
        layers: 1,
    };
    let pressure = PressureLaw::Linear {
        modulus_mpa: 2142.0,
    };
    Ok(WearTest {
        counterface: Arc::new(Counterface::sphere(24.0)),
        flexion_axis_mm: (0.0, 0.0),
        start_mm: (0.0, 0.0),
        start_height_mm: None,
        insert: Arc::new(flat_insert((24.0, 24.0), 9.0, meshing)?.with_one_region("disc")),
        contact: Arc::new(Foundation::new(pressure, 0.05, 1.0)),
        activities: vec![Activity::only("orbit", machine)],
        wear: Arc::new(Archard {
            wear_factor_mm3_per_nm: WEAR_FACTOR_MM3_PER_NM,
        }),
        comparison_laws: Vec::new(),
        law_family: false,
        creep: None,
        density_mg_per_mm3: 0.93,
        time: TimeSettings {
            increments: 80,
            ..TimeSettings::default()
        },
        schedule: Schedule::fixed(CYCLES, 2),
    })
}

#[test]
fn the_example_runs() -> Result<(), Box<dyn Error>> {
    main()
}
