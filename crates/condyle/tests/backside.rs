//! A deformable insert that rests on its tray, under a counterface.

use condyle::{
    Mat3, Vec3,
    contact::{
        Backside, Bodies, ContactLaw, ContactMemory, ContactModel, ContactState, Deformable,
        Settled,
    },
    geometry::{
        ArticulatingSurface, Counterface, GenericFemur, GenericFemurShape, GenericInsertShape,
        Insert, Meshing, flat_insert,
    },
    spatial::{Mat6, Pose, RelativeMotion, Vec6},
};
use condyle_fem::Elastic;

const MODULUS_MPA: f64 = 463.0;
const POISSON: f64 = 0.46;

/// Two bodies, and the law of their contact.
struct Pair {
    counterface: Counterface,
    insert: Insert,
    surface: ArticulatingSurface,
    law: Deformable,
}

impl Pair {
    fn new(counterface: Counterface, insert: Insert, backside: Backside) -> Self {
        let elastic = Elastic::new(MODULUS_MPA, POISSON).unwrap();
        let law = Deformable::new(elastic, 0.07, 1.0, backside, &insert).unwrap();
        Self {
            surface: insert.surface(),
            counterface,
            insert,
            law,
        }
    }

    fn contact(&self, state: ContactState) -> Box<dyn ContactModel + '_> {
        let bodies = Bodies {
            counterface: &self.counterface,
            insert: &self.insert,
            surface: &self.surface,
        };
        let memory = ContactMemory {
            state,
            ..ContactMemory::default()
        };
        self.law.contact(bodies, memory)
    }
}

const fn resting(friction: f64) -> Backside {
    Backside::Resting {
        friction,
        spacing_mm: 5.0,
    }
}

/// A ball of about the relative radius of a knee on a layer as thick as an insert.
fn on_a_layer(backside: Backside) -> Pair {
    let meshing = Meshing {
        edge_mm: 1.5,
        layers: 6,
    };
    let layer = flat_insert((45.0, 45.0), 9.0, meshing).unwrap();
    Pair::new(Counterface::sphere(BALL_MM), layer, backside)
}

const BALL_MM: f64 = 121.0;

fn at_depth(depth_mm: f64, x: f64) -> RelativeMotion {
    let middle = Vec3::new(x, BALL_MM - depth_mm, 0.0);
    RelativeMotion::at_rest(Pose::new(Mat3::identity(), middle))
}

/// Ends an increment at a motion; the force down.
fn settled_n(contact: &mut dyn ContactModel, motion: &RelativeMotion) -> f64 {
    for _ in 0..20 {
        let down_n = -contact.respond(motion).wrench.force.y;
        if contact.settle(motion).unwrap() == Settled::Yes {
            contact.accept(motion);
            contact.evaluate(motion);
            return down_n;
        }
    }
    panic!("loads and backside do not agree");
}

#[test]
fn a_backside_that_sticks_gives_way_less_than_one_that_slips_and_more_than_a_bonded_one() {
    let backsides = [
        resting(0.0),
        resting(0.2),
        resting(0.5),
        resting(100.0),
        Backside::Bonded,
    ];
    let force_n = backsides.map(|backside| {
        let pair = on_a_layer(backside);
        let mut contact = pair.contact(ContactState::default());
        settled_n(contact.as_mut(), &at_depth(0.15, 0.0))
    });
    println!("{force_n:?}");
    assert!(force_n.windows(2).all(|two| two[0] < two[1]), "{force_n:?}");
    // What lifts around the ball is all that a rough tray differs by from a bond.
    assert!(force_n[3] > 0.97 * force_n[4], "{force_n:?}");
}

#[test]
fn a_contact_goes_on_from_where_the_one_before_left_the_backside() {
    let pair = on_a_layer(resting(0.1));
    let path = [(0.1, 0.0), (0.15, 3.0), (0.1, 6.0), (0.12, 2.0)];
    let go = |contact: &mut dyn ContactModel, (depth_mm, x): (f64, f64)| {
        settled_n(contact, &at_depth(depth_mm, x))
    };
    let mut whole = pair.contact(ContactState::default());
    whole.begin_cycle();
    let whole_n = path.map(|to| go(whole.as_mut(), to));
    let mut first = pair.contact(ContactState::default());
    first.begin_cycle();
    for to in &path[..2] {
        go(first.as_mut(), *to);
    }
    let state = first.into_memory().state;
    assert_eq!(state.fields.len(), 2);
    let mut second = pair.contact(state);
    second.begin_cycle();
    for (to, whole_n) in path[2..].iter().zip(&whole_n[2..]) {
        let down_n = go(second.as_mut(), *to);
        assert!((down_n / whole_n - 1.0).abs() < 1e-4, "{down_n} {whole_n}");
    }
    // One that has forgotten it slips another way.
    let mut fresh = pair.contact(ContactState::default());
    fresh.begin_cycle();
    let down_n = go(fresh.as_mut(), path[2]);
    assert!(
        (down_n / whole_n[2] - 1.0).abs() > 3e-4,
        "{down_n} {whole_n:?}"
    );
}

#[test]
fn tangent_with_the_backside_at_rest_is_the_derivative_of_the_wrench() {
    let meshing = Meshing {
        edge_mm: 2.0,
        layers: 3,
    };
    let insert = GenericInsertShape::default().insert(meshing).unwrap();
    let counterface = GenericFemurShape::default();
    let counterface = Counterface::Generic(GenericFemur::new(counterface));
    let pair = Pair::new(counterface, insert, resting(0.2));
    let mut contact = pair.contact(ContactState::default());
    let gap = |y: f64| {
        let pose = Pose::new(Mat3::identity(), Vec3::new(0.5, y, 0.2));
        let gaps = pair.surface.positions.iter();
        let gaps = gaps.map(|place| pair.counterface.gap_mm(&pose.to_counterface(place)));
        gaps.fold(f64::INFINITY, f64::min)
    };
    let mut high = 60.0;
    while gap(high) > 1e-3 {
        high -= gap(high);
    }
    let pose = Pose::new(Mat3::identity(), Vec3::new(0.5, high - 0.2, 0.2));
    let motion = RelativeMotion::at_rest(pose);
    // What the response is asked for next is with the backside where it was found: the machine solves in turns.
    for _ in 0..3 {
        contact.respond(&motion);
        contact.settle(&motion).unwrap();
    }
    contact.respond(&motion);
    let tangent = contact.tangent().by_pose.matrix;
    let mut by_differences = Mat6::zeros();
    let step = 1e-6;
    for column in 0..6 {
        let mut wrench = |by: f64| {
            let small = Vec6::ith(column, by);
            let turn: Vec3 = small.fixed_rows::<3>(0).into();
            let turn = nalgebra::Rotation3::new(turn).into_inner();
            let shift: Vec3 = small.fixed_rows::<3>(3).into();
            let pose = Pose::new(turn * pose.rotation, turn * pose.translation + shift);
            let motion = RelativeMotion { pose, ..motion };
            contact.respond(&motion).wrench.numbers()
        };
        let change = wrench(step) - wrench(-step);
        by_differences.set_column(column, &(change / (2.0 * step)));
    }
    let error = (tangent - by_differences).amax() / by_differences.amax();
    assert!(error < 2e-4, "{error}");
}
