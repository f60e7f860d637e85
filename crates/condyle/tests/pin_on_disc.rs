//! A machine that is no knee: a pin that orbits on a disc, described as a table and held to closed forms.

use std::{f64::consts::TAU, ops::ControlFlow};

use condyle::{
    Vec3,
    contact::{ContactModel, ContactResult, MAX_REGIONS, Response, Tangent, TouchedNode},
    machine::{
        Axis, Chain, Channel, ChannelUnit, Cycle, CycleError, CycleQuantity, Drive, Integration,
        Interpolation, JointDescription, JointIndex, JointKind, Knot, Loading, Machine,
        MachineState, Mechanism, MovedBody, Region, Settling, Simulator, SolverCounters,
        TestedJoint, TimeSettings, Waveform, settle,
    },
    spatial::{Mat6, RelativeMotion, Wrench, WrenchByTwist},
};

static LOAD: Channel = Channel {
    name: "pin_load",
    about: "What presses the pin on the disc.",
    unit: ChannelUnit::Newton,
    sign: -1.0,
    least: 0.0,
    most: 1000.0,
};

/// A joint that is held unless a machine drives it.
const fn joint(name: &'static str, column: &'static str, axis: Axis) -> JointDescription {
    JointDescription {
        name,
        column,
        symbol: name,
        long_name: name,
        title: name,
        positive: "positive",
        decimals: 1,
        least_span: 1.0,
        axis,
        moves: MovedBody::Insert,
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

/// The disc (the insert) turns on a gimbal; the pin (the counterface) is pressed on it and orbits.
const JOINTS: [JointDescription; 6] = [
    joint("turn", "turn_deg", Axis::About(Y)),
    joint("tilt", "tilt_deg", Axis::About(X)),
    joint("roll", "roll_deg", Axis::About(Z)),
    JointDescription {
        moves: MovedBody::Counterface,
        settling: Settling::Driven,
        is_zeroed: true,
        load: Loading::By(&LOAD),
        ..joint("press", "press_mm", Axis::Along(Y))
    },
    JointDescription {
        moves: MovedBody::Counterface,
        ..joint("fore", "fore_mm", Axis::Along(X))
    },
    JointDescription {
        moves: MovedBody::Counterface,
        ..joint("aside", "aside_mm", Axis::Along(Z))
    },
];

const TURN: JointIndex = JointIndex::ALL[0];
const TILT: JointIndex = JointIndex::ALL[1];
const ROLL: JointIndex = JointIndex::ALL[2];
const PRESS: JointIndex = JointIndex::ALL[3];
const FORE: JointIndex = JointIndex::ALL[4];
const ASIDE: JointIndex = JointIndex::ALL[5];

static PIN_ON_DISC: Mechanism = Mechanism {
    tests: TestedJoint::Specimen,
    joints: JOINTS,
    in_files: &[FORE, ASIDE, TURN, PRESS, TILT, ROLL],
    channels: &[&LOAD],
    columns: &[
        CycleQuantity::Position(FORE),
        CycleQuantity::Position(ASIDE),
        CycleQuantity::Position(TURN),
        CycleQuantity::RegionForce(0),
    ],
    regions: &[Region {
        name: "pin",
        label: "Pin",
        column: "pin_force_n",
        title: "Pin force",
    }],
};

const LOAD_N: f64 = 80.0;
const FRICTION: f64 = 0.06;
const STIFFNESS_N_PER_MM: f64 = 4000.0;
const FACE_MM2: f64 = 2.0;

/// A flat disc at y = 0 that bears the pin's tip, the origin of its frame, by a spring; Coulomb friction.
#[derive(Default)]
struct Tip {
    accepted: usize,
}

impl Tip {
    /// Load on the disc, N, and the velocity of the tip past it along the disc, mm/s.
    fn at(motion: &RelativeMotion) -> (f64, Vec3) {
        let (pose, twist) = (&motion.pose, &motion.twist);
        let load_n = (-STIFFNESS_N_PER_MM * pose.translation.y).max(0.0);
        let velocity = twist.linear + twist.angular.cross(&pose.translation);
        (load_n, Vec3::new(velocity.x, 0.0, velocity.z))
    }

    /// Force on the disc, N.
    fn force_n(motion: &RelativeMotion) -> Vec3 {
        let (load_n, slip) = Self::at(motion);
        let along = slip.try_normalize(0.0).unwrap_or_default();
        along * (FRICTION * load_n) - Vec3::y() * load_n
    }
}

impl ContactModel for Tip {
    fn node_count(&self) -> usize {
        1
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response {
        let force = Self::force_n(motion);
        let wrench = Wrench::new(motion.pose.translation.cross(&force), force);
        let mean_slip = [Vec3::zeros(); MAX_REGIONS];
        Response { wrench, mean_slip }
    }

    /// The derivative by the pressing motion alone, since nothing else is free.
    fn tangent(&self) -> Tangent {
        let mut matrix = Mat6::zeros();
        matrix[(4, 4)] = STIFFNESS_N_PER_MM;
        Tangent {
            by_pose: WrenchByTwist::new(matrix),
            by_twist: WrenchByTwist::zero(),
        }
    }

    fn accept(&mut self, _: &RelativeMotion) {
        self.accepted += 1;
    }

    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult {
        let (load_n, slip) = Self::at(motion);
        let pressure_mpa = load_n / FACE_MM2;
        let node = TouchedNode {
            node: 0,
            region: 0,
            pressure_mpa,
            covered_mm2: FACE_MM2,
            force_n: Self::force_n(motion),
            sliding_mm_per_s: [slip.x, slip.z],
            along_mm: [0.0; 2],
        };
        ContactResult {
            touched: vec![node],
            peak_pressure_mpa: pressure_mpa,
        }
    }
}

/// A whole cosine that is `amplitude` at `percent` of the cycle.
fn cosine(amplitude: f64, percent: f64) -> Drive {
    let knots = [(percent, amplitude), (percent + 50.0, -amplitude)];
    let knots = knots.map(|(percent, value)| Knot { percent, value });
    let waveform = Waveform::new(knots.to_vec(), Interpolation::HalfCosine);
    Drive::Prescribed(waveform.expect("two good knots"))
}

/// The machine under its load, else at rest.
fn loaded() -> Machine {
    let mut machine = Machine::new(&PIN_ON_DISC);
    let load = Waveform::constant(LOAD_N).scaled(LOAD.factor());
    machine.joint_mut(PRESS).drive = Drive::Loaded(load);
    machine
}

fn time() -> TimeSettings {
    TimeSettings {
        force_tolerance_n: 1e-9,
        ..TimeSettings::default()
    }
}

/// A cycle of the machine whose pin stands at `place_mm` with its joints at zero.
fn cycle(machine: &Machine, place_mm: Vec3, time: &TimeSettings) -> Result<Cycle, CycleError> {
    let chain = Chain::new(machine, place_mm, (0.0, 0.0));
    let mut tip = Tip::default();
    let mut simulator = Simulator::new(machine, &chain, &mut tip, time);
    let mut start = MachineState::at_rest(machine, [0.0; 6]);
    start.now.positions[PRESS.place()] = -LOAD_N / STIFFNESS_N_PER_MM;
    let mut watch = |_| ControlFlow::Continue(());
    let solved = simulator.cycle(&start, &mut watch)?;
    Ok(solved.continue_value().expect("no watch stops it"))
}

/// Work of friction over a cycle, N mm, from what the disc went through.
fn work_nmm(cycle: &Cycle) -> f64 {
    let work = cycle.history.moments(0).map(|moment| {
        let slip_mm = moment.slip_mm[0].hypot(moment.slip_mm[1]);
        FRICTION * moment.pressure_mpa * FACE_MM2 * slip_mm
    });
    work.sum()
}

#[test]
fn verify_the_work_of_a_pin_on_a_circle() {
    const RADIUS_MM: f64 = 5.0;
    let mut machine = loaded();
    machine.joint_mut(FORE).drive = cosine(RADIUS_MM, 0.0);
    machine.joint_mut(ASIDE).drive = cosine(RADIUS_MM, 25.0);
    let cycle = cycle(&machine, Vec3::zeros(), &time()).expect("a solved cycle");
    let exact_nmm = FRICTION * LOAD_N * TAU * RADIUS_MM;
    assert!(cycle.repeats);
    assert!((work_nmm(&cycle) / exact_nmm - 1.0).abs() < 1e-9);
    for row in &cycle.rows {
        let radius_mm = FORE.of(&row.positions).hypot(ASIDE.of(&row.positions));
        assert!((radius_mm - RADIUS_MM).abs() < 1e-9);
        assert!((row.region_force_n[0] - LOAD_N).abs() < 1e-6);
        assert_eq!(row.region_force_n[0], row.axial_force_n);
    }
}

#[test]
fn verify_the_work_of_a_pin_on_a_disc_that_turns_to_and_fro() {
    const LEVER_MM: f64 = 12.0;
    const ANGLE: f64 = 0.7;
    let mut machine = loaded();
    let axis_point_mm = Vec3::new(3.0, 0.0, -2.0);
    let turn = machine.joint_mut(TURN);
    turn.axis_point_mm = axis_point_mm;
    turn.drive = cosine(ANGLE, 0.0);
    let place_mm = axis_point_mm + Vec3::z() * LEVER_MM;
    let cycle = cycle(&machine, place_mm, &time()).expect("a solved cycle");
    let exact_nmm = FRICTION * LOAD_N * 4.0 * ANGLE * LEVER_MM;
    // The rule of the increments is of second order, and speed turns round with a kink.
    assert!((work_nmm(&cycle) / exact_nmm - 1.0).abs() < 1e-4);
}

#[test]
fn explicit_steps_do_the_same_work_and_are_all_accepted() {
    const RADIUS_MM: f64 = 5.0;
    let mut machine = loaded();
    machine.joint_mut(FORE).drive = cosine(RADIUS_MM, 0.0);
    machine.joint_mut(ASIDE).drive = cosine(RADIUS_MM, 25.0);
    machine.joint_mut(PRESS).damping = 1.0;
    let time = TimeSettings {
        integration: Integration::Explicit { least_step_s: 0.0 },
        ..time()
    };
    let chain = Chain::new(&machine, Vec3::zeros(), (0.0, 0.0));
    let mut tip = Tip::default();
    let mut start = MachineState::at_rest(&machine, [0.0; 6]);
    start.now.positions[PRESS.place()] = -LOAD_N / STIFFNESS_N_PER_MM;
    let mut simulator = Simulator::new(&machine, &chain, &mut tip, &time);
    let mut watch = |_| ControlFlow::Continue(());
    let solved = simulator.cycle(&start, &mut watch);
    let steps = simulator.counters.explicit_steps;
    let cycle = solved.expect("a solved cycle").continue_value();
    let exact_nmm = FRICTION * LOAD_N * TAU * RADIUS_MM;
    let work_nmm = work_nmm(&cycle.expect("no watch stops it"));
    assert!((work_nmm / exact_nmm - 1.0).abs() < 1e-6);
    assert_eq!(tip.accepted as u64, steps);
}

#[test]
fn a_stop_that_was_asked_for_is_no_error() {
    let machine = loaded();
    let (chain, time) = (Chain::new(&machine, Vec3::zeros(), (0.0, 0.0)), time());
    let mut tip = Tip::default();
    let mut simulator = Simulator::new(&machine, &chain, &mut tip, &time);
    let start = MachineState::at_rest(&machine, [0.0; 6]);
    let mut watch = |solved| {
        if solved == 3 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let stopped = simulator.cycle(&start, &mut watch);
    assert!(stopped.expect("no error").is_break());
    assert!(tip.accepted >= 3);
}

#[test]
fn verify_the_pin_settles_where_the_disc_bears_it_and_reads_zero_there() {
    let machine = loaded();
    // The pin begins half a millimetre above the disc.
    let above = Chain::new(&machine, Vec3::new(1.0, 0.5, 2.0), (0.0, 0.0));
    let mut counters = SolverCounters::default();
    let settled = settle(&machine, &above, &mut Tip::default(), 1e-9, &mut counters)
        .expect("a disc bears a pin");
    let sunk_mm = LOAD_N / STIFFNESS_N_PER_MM;
    assert!((PRESS.of(&settled) + 0.5 + sunk_mm).abs() < 1e-9);
    let (zeroed, positions) = above.zeroed_at(&machine, &settled);
    assert_eq!(PRESS.of(&positions), 0.0);
    assert!((zeroed.zero_mm().y + sunk_mm).abs() < 1e-9);
}

#[test]
fn names_and_units_are_those_of_the_table() {
    assert_eq!(
        PIN_ON_DISC.column_names::<4>(),
        ["fore_mm", "aside_mm", "turn_deg", "pin_force_n"]
    );
    assert_eq!(PIN_ON_DISC.joint(TURN).kind(), JointKind::Rotation);
    assert_eq!(PIN_ON_DISC.channel("pin_load"), Some(&LOAD));
    assert_eq!(
        PIN_ON_DISC.readings(&[0.1, 0.0, 0.0, -0.02, 5.0, 0.0]),
        "fore 5.0 mm, aside 0.0 mm, press -0.0 mm, turn 5.7 deg, tilt 0.0 deg, roll 0.0 deg"
    );
    let mut weightless = loaded();
    weightless.joint_mut(PRESS).inertia = 0.0;
    let time = TimeSettings {
        integration: Integration::Explicit { least_step_s: 0.0 },
        ..time()
    };
    let refused = cycle(&weightless, Vec3::zeros(), &time).err();
    let message = refused.expect("explicit steps need inertia").to_string();
    assert!(message.contains("press has none"), "{message}");
}
