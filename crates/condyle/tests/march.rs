//! A wear test as a value: cloned, changed, stopped and gone on with.

use std::{ops::ControlFlow, sync::Arc};

use condyle::{
    contact::{
        Bodies, ContactLaw, ContactMemory, ContactModel, ContactResult, ContactState, Foundation,
        PressureLaw, Response, StateField, Tangent,
    },
    creep::LeePienkowski,
    evolve::{Activity, March, MarchError, MarchState, Schedule, Updates, WearTest},
    geometry::{Counterface, Insert, Meshing, flat_insert},
    machine::{
        Axis, Drive, Interpolation, JointDescription, JointIndex, Knot, Machine, TimeSettings,
        Waveform,
        knee::{self, KNEE},
    },
    spatial::RelativeMotion,
    wear::{Archard, FamilyConstants, MeanCycle, NamedLaw, NodeWear, WEAR_LAWS, WearLaw},
};

/// A contact that counts the steps it has accepted, and keeps the count as its history.
#[derive(Debug)]
struct Counting(Foundation);

struct CountingContact<'a> {
    inner: Box<dyn ContactModel + 'a>,
    accepted: f64,
}

impl ContactLaw for Counting {
    fn contact<'a>(
        &'a self,
        bodies: Bodies<'a>,
        memory: ContactMemory,
    ) -> Box<dyn ContactModel + 'a> {
        let accepted = memory
            .state
            .fields
            .first()
            .map_or(0.0, |field| field.values[0]);
        let inner = self.0.contact(bodies, memory);
        Box::new(CountingContact { inner, accepted })
    }

    fn stiffness_mpa_per_mm(&self, insert: &Insert, node: usize) -> f64 {
        self.0.stiffness_mpa_per_mm(insert, node)
    }

    fn with_slip_tolerance_times(&self, factor: f64) -> Arc<dyn ContactLaw> {
        self.0.with_slip_tolerance_times(factor)
    }
}

impl ContactModel for CountingContact<'_> {
    fn node_count(&self) -> usize {
        self.inner.node_count()
    }

    fn begin_increment(&mut self, increment: usize) {
        self.inner.begin_increment(increment);
    }

    fn respond(&mut self, motion: &RelativeMotion) -> Response {
        self.inner.respond(motion)
    }

    fn tangent(&self) -> Tangent {
        self.inner.tangent()
    }

    fn accept(&mut self, motion: &RelativeMotion) {
        self.accepted += 1.0;
        self.inner.accept(motion);
    }

    fn evaluate(&mut self, motion: &RelativeMotion) -> ContactResult {
        self.inner.evaluate(motion)
    }

    fn into_memory(self: Box<Self>) -> ContactMemory {
        let field = StateField {
            name: "accepted".to_owned(),
            values: vec![self.accepted],
        };
        ContactMemory {
            state: ContactState {
                fields: vec![field],
            },
            ..self.inner.into_memory()
        }
    }
}

/// A knee's machine that presses, and moves AP to and fro by `ap_mm`.
fn machine(ap_mm: f64) -> Machine {
    machine_along(knee::AP, ap_mm)
}

/// A knee's machine that presses, and moves one joint to and fro.
fn machine_along(joint: JointIndex, by_mm: f64) -> Machine {
    let mut machine = Machine::new(&KNEE);
    let knot = |percent, value| Knot { percent, value };
    let knots = vec![knot(0.0, -by_mm), knot(50.0, by_mm)];
    let to_and_fro = Waveform::new(knots, Interpolation::HalfCosine).unwrap();
    machine.joint_mut(joint).drive = Drive::Prescribed(to_and_fro);
    machine.joint_mut(knee::IS).drive = Drive::Loaded(Waveform::constant(-500.0));
    machine
}

fn foundation() -> Foundation {
    let modulus_mpa = 2142.0;
    Foundation::new(PressureLaw::Linear { modulus_mpa }, 0.07, 1.0)
}

/// A ball that rubs a plate, in four updates.
fn test() -> WearTest {
    let meshing = Meshing {
        edge_mm: 2.0,
        layers: 1,
    };
    WearTest {
        counterface: Arc::new(Counterface::sphere(24.0)),
        flexion_axis_mm: (0.0, 0.0),
        start_mm: (0.0, 0.0),
        start_height_mm: None,
        insert: Arc::new(flat_insert((32.0, 24.0), 9.0, meshing).unwrap()),
        contact: Arc::new(foundation()),
        activities: vec![Activity::only("rub", machine(3.0))],
        wear: Arc::new(Archard {
            wear_factor_mm3_per_nm: 2.64e-7,
        }),
        comparison_laws: Vec::new(),
        law_family: false,
        creep: None,
        density_mg_per_mm3: 0.93,
        time: TimeSettings {
            increments: 40,
            ..TimeSettings::default()
        },
        schedule: Schedule::fixed(4e5, 4),
    }
}

fn update(march: &mut March) {
    let update = march.update(&mut |_| ControlFlow::Continue(()));
    assert!(update.expect("it is solved").is_continue());
}

fn marched(test: WearTest) -> MarchState {
    let mut march = March::start(test).expect("a ball settles on a plate");
    while !march.is_done() {
        update(&mut march);
    }
    march.state().clone()
}

fn mass_mg(state: &MarchState) -> f64 {
    state.updates.last().expect("four updates").mass_loss_mg
}

#[test]
fn a_history_of_the_contact_is_marched_on_stored_and_gone_on_with() {
    let test = WearTest {
        contact: Arc::new(Counting(foundation())),
        ..test()
    };
    let accepted = |state: &MarchState| state.contact.fields[0].values[0];
    let mut whole = March::start(test.clone()).unwrap();
    update(&mut whole);
    let after_one = accepted(whole.state());
    assert!(after_one >= 40.0, "{after_one}");
    let mut resumed = March::resume(test.clone(), whole.state().clone());
    update(&mut whole);
    update(&mut resumed);
    assert!(accepted(whole.state()) > after_one + 39.0);
    assert!(whole.state() == resumed.state());
    // The snapshot of the second step holds the history that it began with.
    let late = whole.state().snapshots[1]
        .as_ref()
        .expect("a step before 79 %");
    assert_eq!(late.contact.fields[0].values[0], after_one);
    let mut again = March::from_snapshot(test, late, whole.state().zero_mm);
    update(&mut again);
    assert!(accepted(again.state()) > after_one);
}

#[test]
fn a_march_leaves_its_test_as_it_was() {
    let test = test();
    let before = test.insert.mesh().clone();
    let worn = marched(test.clone());
    assert!(mass_mg(&worn) > 0.0);
    assert_eq!(*test.insert.mesh(), before);
    assert_eq!(mass_mg(&marched(test)), mass_mg(&worn));
}

#[test]
fn tests_that_run_side_by_side_give_what_they_give_alone() {
    let scaled = |factor: f64| {
        let mut test = test();
        test.wear = Arc::new(Archard {
            wear_factor_mm3_per_nm: factor * 2.64e-7,
        });
        test
    };
    let alone = [1.0, 2.0].map(|factor| mass_mg(&marched(scaled(factor))));
    let together = std::thread::scope(|scope| {
        let runs = [1.0, 2.0].map(|factor| {
            let test = scaled(factor);
            scope.spawn(move || mass_mg(&marched(test)))
        });
        runs.map(|run| run.join().expect("two runs at once"))
    });
    assert_eq!(alone, together);
}

#[test]
fn activities_wear_by_their_shares() {
    let with = |activities: Vec<Activity>| {
        mass_mg(&marched(WearTest {
            activities,
            ..test()
        }))
    };
    let activity = |ap_mm: f64, share: f64| Activity {
        name: format!("{ap_mm} mm"),
        machine: machine(ap_mm),
        share,
    };
    let near = |found: f64, expected: f64| {
        assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    };
    let alone = with(vec![activity(3.0, 1.0)]);
    // The same activity in two parts is one.
    near(with(vec![activity(3.0, 0.4), activity(3.0, 0.6)]), alone);
    near(with(vec![activity(3.0, 1.0), activity(1.0, 0.0)]), alone);
    // On a flat plate volume is Kw F S: twice the way in half the cycles is the same wear.
    let mixed = with(vec![activity(2.0, 0.5), activity(4.0, 0.5)]);
    assert!((mixed / alone - 1.0).abs() < 2e-3, "{mixed} {alone}");
}

/// Every law that comes with condyle, with its defaults.
fn every_law() -> Vec<NamedLaw> {
    WEAR_LAWS.iter().map(|kind| kind.with_defaults()).collect()
}

#[test]
fn laws_beside_move_no_surface_and_the_same_law_wears_the_same() {
    let alone = marched(test());
    let together = marched(WearTest {
        comparison_laws: every_law(),
        law_family: true,
        ..test()
    });
    assert!(alone.mesh_nodes == together.mesh_nodes && alone.updates == together.updates);
    let laws = &together.comparison_laws;
    assert_eq!(laws.len(), WEAR_LAWS.len());
    let volume_mm3 = alone.updates[3].volume_loss_mm3;
    let of = |word: &str| laws.iter().find(|law| law.word == word).expect("is there");
    let archard = of("archard");
    let ratio = archard.volume_mm3 / volume_mm3;
    assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
    let ratio = archard.max_depth_mm() / alone.updates[3].max_depth_mm;
    assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    assert_eq!(archard.outside_mm3, None);
    // A ball that rubs along a line: nothing goes across.
    assert!(of("unified").volume_mm3 < 1e-3 * volume_mm3);
    // The family has the law with the default constants; its intervals are added by another rule.
    let law = FamilyConstants {
        circle_factor_mm3_per_nm: 1.57e-6,
        reference_pressure_mpa: 1.1,
        pressure_exponent: 0.43,
        cross_shear_saturation: 0.03,
        line_factor_ratio: 0.026,
    };
    let family = together.law_family.as_ref().expect("was asked for");
    let (family_mm3, family_mm) = family.volumes_and_depths(&[law])[0];
    let power = of("power-law");
    let ratios = [
        family_mm3 / power.volume_mm3,
        family_mm / power.max_depth_mm(),
    ];
    assert!(
        ratios.iter().all(|ratio| (ratio - 1.0).abs() < 0.03),
        "{ratios:?}"
    );
    let kang = of("kang");
    assert!(kang.outside_mm3.expect("is known") > 0.9 * kang.volume_mm3);
}

#[test]
fn laws_beside_go_on_from_a_state_as_if_never_stopped() {
    let test = WearTest {
        comparison_laws: every_law(),
        law_family: true,
        ..test()
    };
    let mut whole = March::start(test.clone()).unwrap();
    update(&mut whole);
    let mut resumed = March::resume(test, whole.state().clone());
    update(&mut whole);
    update(&mut resumed);
    assert!(whole.state() == resumed.state());
}

#[test]
fn verify_activities_across_each_other_have_the_cross_shear_of_both() {
    let activity = |name: &str, joint, share| Activity {
        name: name.to_owned(),
        machine: machine_along(joint, 3.0),
        share,
    };
    let mut march = March::start(WearTest {
        activities: vec![
            activity("forwards", knee::AP, 0.75),
            activity("aside", knee::ML, 0.25),
        ],
        ..test()
    })
    .unwrap();
    update(&mut march);
    let surface = march.last_cycle().expect("one is solved").surface;
    let mut nodes = surface.positions.iter();
    let middle = nodes.position(|place| place.x.hypot(place.z) < 1e-9);
    let middle = middle.expect("a node in the middle");
    let cross_shear = march.fields().cross_shear[middle];
    assert!((cross_shear - 0.25).abs() < 0.01, "{cross_shear}");
    let [forwards, up, aside] = march.fields().principal_direction[middle];
    assert!(forwards > 0.9999 && up.abs() < 0.01 && aside.abs() < 0.01);
}

#[test]
fn activities_share_out_all_of_the_wear() {
    let activity = |ap_mm: f64, share| Activity {
        name: format!("{ap_mm} mm"),
        machine: machine(ap_mm),
        share,
    };
    let state = marched(WearTest {
        activities: vec![activity(2.0, 0.4), activity(4.0, 0.6)],
        ..test()
    });
    let [short, long] = [0, 1].map(|number| state.activities[number].wear);
    let all = state.updates.last().expect("one was done").volume_loss_mm3;
    assert!(((short.volume_mm3 + long.volume_mm3) / all - 1.0).abs() < 1e-12);
    // Volume is Kw F S: 0.4 x 2 mm against 0.6 x 4 mm; and Archard's law knows no others' directions.
    assert!((long.volume_mm3 / short.volume_mm3 - 3.0).abs() < 0.01);
    assert!((short.alone_mm3 / short.volume_mm3 - 1.0).abs() < 0.02);
    assert!((long.alone_mm3 / long.volume_mm3 - 1.0).abs() < 0.02);
}

/// A test whose insert creeps.
fn creeping() -> WearTest {
    WearTest {
        creep: Some(LeePienkowski::default()),
        ..test()
    }
}

#[test]
fn creep_takes_the_surface_down_and_no_mass() {
    let (worn, crept) = (marched(test()), marched(creeping()));
    let [worn, crept] = [&worn, &crept].map(|state| state.updates.last().expect("one was done"));
    let creep = crept.creep.expect("it creeps");
    assert!(worn.creep.is_none() && creep.volume_mm3 > 0.0);
    // Force times way is the same, wherever the surface lies.
    assert!((crept.mass_loss_mg / worn.mass_loss_mg - 1.0).abs() < 0.02);
    assert!((crept.volume_loss_mesh_mm3 / crept.volume_loss_mm3 - 1.0).abs() < 0.05);
    let there = creep.wear_there_mm + creep.creep_there_mm;
    assert!((there / creep.max_penetration_mm - 1.0).abs() < 1e-12);
    assert!(creep.max_unloaded_depth_mm < creep.max_penetration_mm);
}

#[test]
fn creep_goes_on_from_any_update_as_if_never_stopped() {
    let mut whole = March::start(creeping()).unwrap();
    let mut resumed: Vec<March> = Vec::new();
    for _ in 0..4 {
        update(&mut whole);
        for march in &mut resumed {
            update(march);
            assert!(whole.state() == march.state());
        }
        resumed.push(March::resume(creeping(), whole.state().clone()));
    }
}

#[test]
fn an_insert_worn_and_crept_through_says_by_what() {
    let test = WearTest {
        wear: Arc::new(Archard {
            wear_factor_mm3_per_nm: 1e-3,
        }),
        ..creeping()
    };
    let mut march = March::start(test).unwrap();
    let error = (0..4).find_map(|_| march.update(&mut |_| ControlFlow::Continue(())).err());
    let said = error.expect("it wears through").to_string();
    assert!(
        said.contains("mm of wear and") && said.contains("mm of creep; use"),
        "{said}"
    );
}

#[test]
fn a_stop_that_was_asked_for_is_no_error_and_loses_no_update() {
    let mut march = March::start(test()).unwrap();
    update(&mut march);
    let before = march.state().clone();
    let stopped = march.update(&mut |_| ControlFlow::Break(()));
    assert!(stopped.expect("no error").is_break());
    assert!(*march.state() == before);
    update(&mut march);
    assert_eq!(march.state().updates.len(), 2);
}

#[test]
fn verify_sliding_distance_over_the_surface_is_area_in_contact_times_way() {
    let mut march = March::start(test()).unwrap();
    update(&mut march);
    let cycle = march.last_cycle().expect("one is solved");
    let shares = cycle.surface.shares.iter();
    let slid = shares.zip(&march.fields().sliding_distance_mm);
    let found_mm3: f64 = slid.map(|(share, slid)| share.area_mm2 * slid).sum();
    let areas = cycle.rows.iter().map(|row| row.contact_area_mm2);
    let mean_mm2 = areas.sum::<f64>() / cycle.rows.len() as f64;
    // To and fro by 3 mm about the middle.
    let expected_mm3 = 12.0 * mean_mm2;
    assert!(
        (found_mm3 / expected_mm3 - 1.0).abs() < 0.01,
        "{found_mm3} {expected_mm3}"
    );
}

#[test]
fn verify_pressures_of_the_last_cycle_carry_its_load_under_its_pose() {
    let mut march = March::start(test()).unwrap();
    assert!(march.last_cycle().is_none());
    update(&mut march);
    let cycle = march.last_cycle().expect("one is solved");
    for (increment, row) in cycle.rows.iter().enumerate() {
        let pressures_mpa = cycle.pressures_mpa(increment);
        // Pressure acts along the ball's normal, which leans away from the middle of the plate.
        let centre = cycle.pose(increment).translation;
        let down = |node: usize| -(cycle.surface.positions[node] - centre).normalize().y;
        let shares = cycle.surface.shares.iter().zip(&pressures_mpa).enumerate();
        let load_n: f64 = shares
            .map(|(node, (share, p))| share.area_mm2 * p * down(node))
            .sum();
        let load = format!("{load_n} {}", row.axial_force_n);
        assert!((load_n / row.axial_force_n - 1.0).abs() < 1e-3, "{load}");
        // A ball on a flat plate presses hardest below its middle.
        let highest = pressures_mpa.iter().copied().fold(0.0, f64::max);
        let node = pressures_mpa
            .iter()
            .position(|&p| p == highest)
            .expect("one is");
        let below = centre - cycle.surface.positions[node];
        assert!(
            below.x.abs() < 1.5 && below.z.abs() < 1.5 && below.y > 23.0,
            "{below}"
        );
    }
}

#[test]
fn neutral_is_where_ap_ml_and_is_read_zero() {
    let march = March::start(test()).unwrap();
    let pose = march.neutral_pose();
    assert!((pose.translation - march.state().zero_mm).norm() < 1e-12);
    assert!(
        pose.translation.y < 24.0 && pose.translation.y > 23.5,
        "the ball rests on the plate"
    );
}

#[test]
fn values_that_no_test_can_have_are_refused() {
    let message = |change: &dyn Fn(&mut WearTest)| {
        let mut test = test();
        change(&mut test);
        March::start(test).err().unwrap().to_string()
    };
    let mut twice = test().activities;
    twice.extend(twice.clone());
    let all_shares = message(&|test| test.activities = twice.clone());
    assert!(all_shares.contains("add up to 2"), "{all_shares}");
    assert!(message(&|test| test.activities.clear()).contains("add up to 0"));
    assert!(message(&|test| test.activities[0].share = f64::NAN).contains("shares"));
    assert!(message(&|test| test.schedule.cycles = 0.0).contains("cycles is 0"));
    assert!(message(&|test| test.schedule = Schedule::fixed(1.0, 0)).contains("no updates"));
    let never = Updates::Auto { tolerance: 0.0 };
    assert!(message(&|test| test.schedule.updates = never).contains("no updates"));
    let one_region = |test: &mut WearTest| {
        let insert = Insert::clone(&test.insert).with_one_region("plate");
        test.insert = Arc::new(insert);
    };
    assert!(message(&one_region).contains("insert: 1"));

    let of_joint = |change: fn(&mut JointDescription)| {
        let mut mechanism = KNEE.clone();
        change(&mut mechanism.joints[knee::AP.place()]);
        let machine = Machine::new(Box::leak(Box::new(mechanism)));
        message(&|test| test.activities[0].machine = machine.clone())
    };
    let long = of_joint(|joint| joint.axis = Axis::Along([1.0, 0.0, 1.0]));
    assert!(long.contains("has the length 1.41"), "{long}");
    assert!(of_joint(|joint| joint.axis = Axis::About([1.0, 0.0, 0.0])).contains("zeroed"));
}

#[test]
fn a_law_that_adds_material_ends_the_march() {
    #[derive(Debug)]
    struct Depth(f64);
    impl WearLaw for Depth {
        fn wear(&self, _cycle: &MeanCycle<'_>) -> NodeWear {
            NodeWear::of_depth(self.0)
        }
    }
    for depth_mm in [-1e-8, f64::NAN, f64::INFINITY] {
        let wear = Arc::new(Depth(depth_mm));
        let mut march = March::start(WearTest { wear, ..test() }).unwrap();
        let error = march.run().unwrap_err();
        let is_the_depth = matches!(error, MarchError::InvalidDepth { update: 1, .. });
        assert!(is_the_depth, "{error}");
        assert_eq!(march.cycles(), 0.0);
    }
}
