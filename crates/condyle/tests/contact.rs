//! The foundation against closed forms, finite differences and itself.

use condyle::{
    Mat3, Vec3,
    contact::{
        Bodies, ContactCache, ContactLaw, ContactMemory, ContactModel, ContactState, Foundation,
        PressureLaw, PressureTable, Search, Tangent, TouchedNode, confined_modulus,
    },
    geometry::{
        ArticulatingSurface, Counterface, GenericFemur, GenericFemurShape, GenericInsertShape,
        Insert, Meshing, SmoothField, flat_insert,
    },
    spatial::{Mat6, Pose, RelativeMotion, Twist, Vec6, Wrench, body},
};

const MODULUS_MPA: f64 = 2142.0;

fn rubbing(pressure: PressureLaw) -> Foundation {
    Foundation::new(pressure, 0.07, 1.0)
}

/// Two bodies that contacts are made of.
struct Pair<'a> {
    counterface: &'a Counterface,
    insert: &'a Insert,
    surface: ArticulatingSurface,
}

impl<'a> Pair<'a> {
    fn new(counterface: &'a Counterface, insert: &'a Insert) -> Self {
        let surface = insert.surface();
        Self {
            counterface,
            insert,
            surface,
        }
    }

    /// A contact that knows nothing yet.
    fn contact<'b>(&'b self, law: &'b Foundation) -> Box<dyn ContactModel + 'b> {
        self.contact_after(ContactCache::default(), law)
    }

    /// A contact that knows what another knew.
    fn contact_after<'b>(
        &'b self,
        cache: ContactCache,
        law: &'b Foundation,
    ) -> Box<dyn ContactModel + 'b> {
        let bodies = Bodies {
            counterface: self.counterface,
            insert: self.insert,
            surface: &self.surface,
        };
        let state = ContactState::default();
        law.contact(bodies, ContactMemory { state, cache })
    }

    /// The wrench of a contact made for a motion.
    fn fresh(&self, law: &Foundation, motion: &RelativeMotion) -> Wrench {
        self.contact(law).respond(motion).wrench
    }
}

fn linear() -> Foundation {
    rubbing(PressureLaw::Linear {
        modulus_mpa: MODULUS_MPA,
    })
}

fn at(translation: Vec3) -> RelativeMotion {
    RelativeMotion::at_rest(Pose::new(Mat3::identity(), translation))
}

fn default_insert() -> Insert {
    GenericInsertShape::default()
        .insert(Meshing::default())
        .unwrap()
}

fn one_millimetre() -> Meshing {
    Meshing {
        edge_mm: 1.0,
        layers: 1,
    }
}

/// A small generator of repeatable numbers in -1..1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * size
    }
}

fn rotation(turn: &Vec3) -> Mat3 {
    nalgebra::Rotation3::new(*turn).into_inner()
}

/// The pose after a small turn and translation of the counterface, in the insert frame.
fn moved(pose: &Pose, small: &Vec6) -> Pose {
    let turn = rotation(&small.fixed_rows::<3>(0).into());
    let shift: Vec3 = small.fixed_rows::<3>(3).into();
    Pose::new(turn * pose.rotation, turn * pose.translation + shift)
}

fn by_differences(step: f64, mut wrench: impl FnMut(&Vec6) -> Vec6) -> Mat6 {
    let mut matrix = Mat6::zeros();
    for column in 0..6 {
        let small = Vec6::ith(column, step);
        matrix.set_column(column, &((wrench(&small) - wrench(&-small)) / (2.0 * step)));
    }
    matrix
}

fn check_tangent(contact: &mut dyn ContactModel, motion: &RelativeMotion, tolerance: f64) {
    contact.respond(motion);
    let tangent = contact.tangent();
    assert!(contact.evaluate(motion).touched.len() > 20);
    let by_pose = by_differences(1e-6, |small| {
        let pose = moved(&motion.pose, small);
        let moved = RelativeMotion { pose, ..*motion };
        contact.respond(&moved).wrench.numbers()
    });
    let by_twist = by_differences(1e-4, |small| {
        let twist = motion.twist + Twist::from_numbers(small);
        let faster = RelativeMotion { twist, ..*motion };
        contact.respond(&faster).wrench.numbers()
    });
    let error = (tangent.by_pose.matrix - by_pose).norm() / by_pose.norm();
    assert!(error < tolerance, "by pose: {error:e}");
    let error = (tangent.by_twist.matrix - by_twist).norm() / by_twist.norm();
    assert!(error < tolerance, "by twist: {error:e}");
}

fn random_motion(numbers: &mut Numbers, translation: Vec3) -> RelativeMotion {
    let turn = numbers.vector(0.05);
    let pose = Pose::new(rotation(&turn), translation + numbers.vector(0.05));
    let twist = Twist::new(numbers.vector(1.0), numbers.vector(20.0));
    RelativeMotion { pose, twist }
}

#[test]
fn tangent_is_the_derivative_over_random_poses_of_the_generic_pair() {
    let counterface = Counterface::Generic(GenericFemur::new(GenericFemurShape::default()));
    let insert = default_insert();
    let table =
        PressureTable::new(vec![(0.0, 0.0), (0.1, 20.0), (0.5, 150.0), (2.0, 900.0)]).unwrap();
    let mut numbers = Numbers(7);
    for law in [
        PressureLaw::Linear {
            modulus_mpa: MODULUS_MPA,
        },
        PressureLaw::Logarithmic {
            modulus_mpa: MODULUS_MPA,
        },
        PressureLaw::Tabulated(table),
        PressureLaw::Softening {
            modulus_mpa: MODULUS_MPA,
            softening_stress_mpa: 18.4,
        },
    ] {
        let law = rubbing(law);
        let pair = Pair::new(&counterface, &insert);
        let mut contact = pair.contact(&law);
        for _ in 0..10 {
            // The distal arc's lowest point is 22.96 mm below the counterface's origin.
            let motion = random_motion(&mut numbers, Vec3::new(-5.5, 22.4, 0.0));
            check_tangent(contact.as_mut(), &motion, 1e-5);
        }
    }
}

fn ball_mesh(edge_mm: f64) -> condyle::geometry::TriangleMesh {
    let rows = (std::f64::consts::PI * 24.0 / edge_mm) as u32;
    let columns = 2 * rows;
    let mut mesh = condyle::geometry::TriangleMesh::default();
    for row in 0..=rows {
        let theta = std::f64::consts::PI * f64::from(row) / f64::from(rows);
        for column in 0..columns {
            let phi = std::f64::consts::TAU * f64::from(column) / f64::from(columns);
            let (x, ring) = (theta.cos(), theta.sin());
            mesh.vertices
                .push(Vec3::new(x, ring * phi.cos(), ring * phi.sin()) * 24.0);
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let (a, b) = (
                row * columns + column,
                row * columns + (column + 1) % columns,
            );
            mesh.triangles
                .extend([[a, a + columns, b + columns], [a, b + columns, b]]);
        }
    }
    mesh
}

fn mesh_counterface(insert: &Insert) -> Counterface {
    let field = SmoothField::new(&ball_mesh(1.0), 1);
    Counterface::Mesh(field).prepared_for(insert.surface().mean_spread_mm2())
}

#[test]
fn tangent_is_the_derivative_for_a_mesh() {
    let insert = default_insert();
    let counterface = mesh_counterface(&insert);
    let law = linear();
    let pair = Pair::new(&counterface, &insert);
    let mut contact = pair.contact(&law);
    let mut numbers = Numbers(11);
    for _ in 0..10 {
        let motion = random_motion(&mut numbers, Vec3::new(0.3, 23.7, 23.0));
        check_tangent(contact.as_mut(), &motion, 1e-4);
    }
}

/// Overclosure of a ball of radius 24 mm on a linear foundation 9 mm thick under 2000 N.
fn overclosure_at_2000_n() -> f64 {
    let stiffness = MODULUS_MPA / 9.0;
    (2000.0 / (std::f64::consts::PI * stiffness * 24.0)).sqrt()
}

/// Exact force of a ball on a foundation of stiffness k, overclosure measured straight down: the
/// vertical component of pressure along the normal of a paraboloid is k d over its footprint,
/// but the foundation measures overclosure along the ball's normal, so it is integrated.
fn exact_ball_force(overclosure: f64) -> f64 {
    // On a plane at depth 24 - d below the centre: gap = sqrt(r^2 + h^2) - 24.
    let (radius, stiffness) = (24.0, MODULUS_MPA / 9.0);
    let h: f64 = radius - overclosure;
    // int 2 pi r k (R - s) h/s dr with s ds = r dr: 2 pi k h int (R - s) ds = pi k h d^2.
    std::f64::consts::PI * stiffness * h * overclosure * overclosure
}

#[test]
fn verify_ball_on_a_softening_foundation() {
    // A share has the pressure of its mean overclosure, which for a law that bends is 2.4 % of the
    // force too much at edges of 1 mm, and falls with their square.
    let fine = Meshing {
        edge_mm: 0.25,
        layers: 1,
    };
    let insert = flat_insert((24.0, 24.0), 9.0, fine).unwrap();
    let (overclosure, stress) = (overclosure_at_2000_n(), 18.4);
    let pressure = PressureLaw::Softening {
        modulus_mpa: MODULUS_MPA,
        softening_stress_mpa: stress,
    };
    let peak = pressure.pressure(overclosure, 9.0).0;
    // int p dd = p d - int d dp, with d = (t / K) (p + p^3 / s^2); then as for the linear law.
    let complement = peak.powi(2) / 2.0 + peak.powi(4) / (4.0 * stress * stress);
    let integral = peak * overclosure - 9.0 / MODULUS_MPA * complement;
    let exact = std::f64::consts::TAU * (24.0 - overclosure) * integral;
    let law = Foundation::new(pressure, 0.0, 1.0);
    let counterface = Counterface::sphere(24.0);
    let pair = Pair::new(&counterface, &insert);
    let mut contact = pair.contact(&law);
    for (x, z) in [(0.0, 0.0), (0.5, 0.5), (0.23, 0.41)] {
        let motion = at(Vec3::new(x, 24.0 - overclosure, z));
        let force = -contact.respond(&motion).wrench.force.y;
        assert!((force / exact - 1.0).abs() < 5e-3, "{force} {exact}");
    }
}

#[test]
fn verify_ball_on_a_flat_foundation() {
    let insert = flat_insert((24.0, 24.0), 9.0, one_millimetre()).unwrap();
    let overclosure = overclosure_at_2000_n();
    let law = Foundation::new(linear().pressure, 0.0, 1.0);
    let radius_exact = 2.0 * 24.0 * overclosure - overclosure * overclosure;
    let shapes = [Counterface::sphere(24.0), mesh_counterface(&insert)];
    for (counterface, tolerance) in shapes.iter().zip([1e-3, 3e-3]) {
        let pair = Pair::new(counterface, &insert);
        let mut contact = pair.contact(&law);
        for (x, z) in [(0.0, 0.0), (0.5, 0.5), (0.23, 0.41)] {
            let motion = at(Vec3::new(x, 24.0 - overclosure, z));
            let force = -contact.respond(&motion).wrench.force.y;
            let exact = exact_ball_force(overclosure);
            assert!((force / exact - 1.0).abs() < tolerance, "{force} {exact}");
            let area: f64 = contact
                .evaluate(&motion)
                .touched
                .iter()
                .map(|node| node.covered_mm2)
                .sum();
            let exact_area = std::f64::consts::PI * radius_exact;
            assert!(
                (area / exact_area - 1.0).abs() < 0.01,
                "{area} {exact_area}"
            );
        }
    }
}

#[test]
fn verify_highest_mean_pressure_under_a_ball_on_a_node() {
    let insert = flat_insert((24.0, 24.0), 9.0, one_millimetre()).unwrap();
    let (counterface, law) = (Counterface::sphere(24.0), linear());
    let overclosure = overclosure_at_2000_n();
    let pair = Pair::new(&counterface, &insert);
    let mut contact = pair.contact(&law);
    let motion = at(Vec3::new(0.0, 24.0 - overclosure, 0.0));
    contact.respond(&motion);
    let peak = contact
        .evaluate(&motion)
        .touched
        .iter()
        .map(|node| node.pressure_mpa)
        .fold(0.0, f64::max);
    // The share's mean overclosure is h^2/(12 r) less than that of its middle, r from the centre.
    let exact = MODULUS_MPA / 9.0 * (overclosure - 1.0 / (12.0 * (24.0 - overclosure)));
    assert!((peak / exact - 1.0).abs() < 1e-4, "{peak} {exact}");
}

/// Largest and smallest force of a ball slid across the dish at constant approach.
fn ripple(counterface: &Counterface, insert: &Insert) -> f64 {
    let law = Foundation::new(linear().pressure, 0.0, 1.0);
    let pair = Pair::new(counterface, insert);
    let mut contact = pair.contact(&law);
    let shape = GenericInsertShape::default();
    // The force changes as the dish does; the rest besides a smooth curve is ripple.
    let forces: Vec<f64> = (0..400)
        .map(|i| {
            let x = -4.0 + 0.02 * f64::from(i);
            let rs = shape.sagittal_radius_mm;
            let centre = rs - ((rs - 24.0 + 0.3).powi(2) - x * x).sqrt();
            let motion = at(Vec3::new(x, centre, 23.0));
            contact.respond(&motion).wrench.force.norm()
        })
        .collect();
    let mean = forces.iter().sum::<f64>() / forces.len() as f64;
    let smooth = |i: usize| forces[i - 50..=i + 50].iter().sum::<f64>() / 101.0;
    let worst = (50..350)
        .map(|i| (forces[i] - smooth(i)).abs())
        .fold(0.0, f64::max);
    println!("ripple {:e} of {mean} N", worst / mean);
    2.0 * worst / mean
}

#[test]
fn verify_force_ripple_of_a_sliding_ball_is_below_half_a_percent() {
    let insert = default_insert();
    assert!(ripple(&Counterface::sphere(24.0), &insert) < 5e-3);
    assert!(ripple(&mesh_counterface(&insert), &insert) < 5e-3);
}

#[test]
fn verify_a_rolling_ball_does_not_slide() {
    let insert = flat_insert((24.0, 24.0), 9.0, one_millimetre()).unwrap();
    let counterface = Counterface::sphere(24.0);
    let law = linear();
    let pair = Pair::new(&counterface, &insert);
    let mut contact = pair.contact(&law);
    // Rolls along x without slip: the material at the insert's plane stands still.
    let (speed, overclosure) = (3.0, 0.2);
    let mut motion = at(Vec3::new(0.0, 24.0 - overclosure, 0.0));
    motion.twist = Twist::new(Vec3::new(0.0, 0.0, -speed), Vec3::zeros());
    contact.respond(&motion);
    let fastest = contact
        .evaluate(&motion)
        .touched
        .iter()
        .map(|node| node.sliding_mm_per_s[0].hypot(node.sliding_mm_per_s[1]))
        .fold(0.0, f64::max);
    // At radius r the turn lifts the material by w r, of which r/R runs along the surface: w r^2/R,
    // at most 2 w d. A ball that slid instead of rolling would move at 72 mm/s.
    assert!(fastest <= 2.0 * speed * overclosure * 1.2, "{fastest}");
}

#[test]
fn force_does_not_depend_on_the_calls_before() {
    let counterface = Counterface::Generic(GenericFemur::new(GenericFemurShape::default()));
    let insert = default_insert();
    let law = linear();
    let pair = Pair::new(&counterface, &insert);
    let mut walked = pair.contact(&law);
    let mut numbers = Numbers(3);
    for _ in 0..50 {
        let motion = random_motion(&mut numbers, Vec3::new(-5.5, 22.4, 0.0));
        assert_eq!(walked.respond(&motion).wrench, pair.fresh(&law, &motion));
    }
}

#[test]
fn what_was_far_away_is_found_when_it_comes_near() {
    let insert = default_insert();
    let law = linear();
    for counterface in [Counterface::sphere(24.0), mesh_counterface(&insert)] {
        let pair = Pair::new(&counterface, &insert);
        let mut walked = pair.contact(&law);
        // In the air, beyond the rim, and from one dish to the other, in long steps and short ones.
        for i in 0..120 {
            let angle = 0.37 * f64::from(i);
            let height = 23.9 + if i % 5 == 0 { 15.0 } else { 0.0 };
            let place = Vec3::new(30.0 * angle.sin(), height, 45.0 * (0.61 * angle).cos());
            let near = Vec3::new(2.0 * angle.sin(), 23.8, 23.0 + angle.cos());
            let motion = at(if i % 3 == 0 { place } else { near });
            let fresh = pair.fresh(&law, &motion);
            assert_eq!(walked.respond(&motion).wrench, fresh, "step {i}");
        }
    }
}

/// A twist with all its parts.
fn sliding() -> Twist {
    Twist::new(Vec3::new(0.1, 0.2, 1.0), Vec3::new(20.0, 0.0, 1.0))
}

/// Motions asked for at an increment of a gait, each with whether it is farther from the one before
/// than a sample is extrapolated.
fn asked(increment: u32, round: u32, z_mm: f64) -> Vec<(RelativeMotion, bool)> {
    let angle = std::f64::consts::TAU * f64::from(increment) / 24.0;
    let drift_mm = 0.05 * f64::from(round);
    let place = Vec3::new(6.0 * angle.cos() - 4.0, 23.7 - drift_mm, z_mm + angle.sin());
    let turn = Vec3::new(
        0.02 * angle.sin(),
        0.1 * angle.cos(),
        -0.5 + 0.5 * angle.sin(),
    );
    let motion = |shift_mm: f64, lift_mm: f64| RelativeMotion {
        pose: Pose::new(rotation(&turn), place + Vec3::new(shift_mm, lift_mm, 0.0)),
        twist: sliding(),
    };
    let mut asked = vec![
        (motion(0.3, -0.1), true),
        (motion(0.04, 0.0), true),
        (motion(0.0, 0.0), true),
        (motion(0.005, 0.001), false),
    ];
    if increment % 5 == 3 {
        asked.insert(1 + increment as usize % 3, (motion(-3.0, 12.0), true));
        asked.insert(1, (motion(9.0, 0.5), true));
    }
    asked
}

/// The last answer of a foundation, to the bit.
fn answer(
    contact: &mut dyn ContactModel,
    motion: &RelativeMotion,
) -> (Wrench, Tangent, Vec<TouchedNode>) {
    let response = contact.respond(motion);
    let (wrench, tangent) = (response.wrench, contact.tangent());
    (wrench, tangent, contact.evaluate(motion).touched)
}

#[test]
fn what_is_known_of_the_cycle_before_changes_no_answer() {
    let (law, plain) = (linear(), brute_force());
    let generic = Counterface::Generic(GenericFemur::new(GenericFemurShape::default()));
    for (counterface, z_mm) in [(generic, 0.0), (mesh_counterface(&default_insert()), 23.0)] {
        let (mut insert, mut cache, mut touched) = (default_insert(), ContactCache::default(), 0);
        for round in 0..4 {
            let surface = insert.surface();
            let pair = Pair::new(&counterface, &insert);
            let mut knowing = pair.contact_after(cache, &law);
            let (mut untold, mut brute) = (pair.contact(&law), pair.contact(&plain));
            for increment in 0..24 {
                knowing.begin_increment(increment as usize);
                for (motion, is_far) in asked(increment, round, z_mm) {
                    let found = answer(knowing.as_mut(), &motion);
                    let place = format!("{round} {increment}");
                    assert_eq!(found, answer(untold.as_mut(), &motion), "{place}");
                    assert_eq!(found, answer(brute.as_mut(), &motion), "{place}");
                    let mut fresh = pair.contact(&law);
                    assert!(!is_far || found == answer(fresh.as_mut(), &motion));
                    touched += found.2.len();
                }
            }
            cache = knowing.into_memory().cache;
            drop((untold, brute));
            let depth_mm = |place: &Vec3| 0.03 * (1.0 + (place.x / 3.0).sin());
            // The third round finds the insert as the second left it.
            if round != 1 {
                let depth_mm: Vec<f64> = surface.positions.iter().map(depth_mm).collect();
                insert.wear_down(&surface, &depth_mm);
            }
        }
        assert!(touched > 10_000, "{touched}");
    }
}

/// The plain path.
fn brute_force() -> Foundation {
    let mut law = linear();
    law.settings.search = Search::BruteForce;
    law
}

#[test]
fn samples_that_are_not_reused_are_those_of_a_fresh_contact() {
    let mut law = linear();
    law.settings.sample_reuse_mm = 0.0;
    let insert = default_insert();
    let counterface = mesh_counterface(&insert);
    let pair = Pair::new(&counterface, &insert);
    let mut walked = pair.contact(&law);
    for step in 0..20 {
        let motion = at(Vec3::new(0.001 * f64::from(step), 23.8, 23.0));
        assert_eq!(walked.respond(&motion).wrench, pair.fresh(&law, &motion));
    }
}

#[test]
fn a_sample_from_before_the_wear_is_not_extrapolated() {
    let law = linear();
    let mut insert = default_insert();
    let counterface = mesh_counterface(&insert);
    let place = |shift_mm: f64| at(Vec3::new(shift_mm, 23.8, 23.0));
    let (cache, surface) = {
        let pair = Pair::new(&counterface, &insert);
        let mut contact = pair.contact(&law);
        contact.respond(&place(0.0));
        (contact.into_memory().cache, insert.surface())
    };
    insert.wear_down(&surface, &vec![0.001; surface.positions.len()]);
    let near = place(0.01);
    let pair = Pair::new(&counterface, &insert);
    let found = answer(pair.contact_after(cache, &law).as_mut(), &near);
    assert!(found.2.len() > 20);
    assert_eq!(found, answer(pair.contact(&law).as_mut(), &near));
}

#[test]
fn what_is_known_of_another_insert_is_forgotten() {
    let (law, counterface) = (linear(), Counterface::sphere(24.0));
    let (insert, flat) = (
        default_insert(),
        flat_insert((24.0, 24.0), 9.0, one_millimetre()).unwrap(),
    );
    let dished = Pair::new(&counterface, &insert);
    let mut contact = dished.contact(&law);
    contact.respond(&at(Vec3::new(0.0, 60.0, 0.0)));
    let cache = contact.into_memory().cache;
    let motion = at(Vec3::new(0.0, 23.9, 0.0));
    let pair = Pair::new(&counterface, &flat);
    let found = pair.contact_after(cache, &law).respond(&motion).wrench;
    assert_eq!(found, pair.fresh(&law, &motion));
}

#[test]
fn verify_wrench_is_the_sum_of_the_nodes_forces() {
    let counterface = Counterface::Generic(GenericFemur::new(GenericFemurShape::default()));
    let insert = default_insert();
    let law = linear();
    let pair = Pair::new(&counterface, &insert);
    let mut contact = pair.contact(&law);
    let motion = random_motion(&mut Numbers(5), Vec3::new(-5.5, 22.4, 0.0));
    let wrench = contact.respond(&motion).wrench;
    let of_node = |touched: &TouchedNode| {
        let place = insert.surface().shares[touched.node as usize].centre;
        Wrench::<body::Insert, body::Insert>::new(place.cross(&touched.force_n), touched.force_n)
    };
    let touched = contact.evaluate(&motion).touched;
    let sum = touched
        .iter()
        .map(of_node)
        .fold(Wrench::zero(), |a, b| a + b);
    let apart = sum.numbers() - wrench.numbers();
    assert!(apart.norm() < 1e-9 * sum.numbers().norm());
    assert!((confined_modulus(463.0, 0.46) - MODULUS_MPA).abs() < 2.0);
}

/// A counterface's pose on the way through a gait, pressed on the insert by about a thousand newtons.
fn on_the_way(part: f64, z_mm: f64, mut force_n: impl FnMut(&Pose) -> f64) -> Pose {
    let angle = std::f64::consts::TAU * part;
    let turn = Vec3::new(0.02 * angle.sin(), 0.06 * angle.cos(), 0.3 * angle.sin());
    let lowered = |height_mm: f64| {
        let place = Vec3::new(2.0 * angle.cos(), height_mm, z_mm + 0.5 * angle.sin());
        Pose::new(rotation(&turn), place)
    };
    let (mut low_mm, mut high_mm) = (20.0, 30.0);
    for _ in 0..20 {
        let middle_mm = (low_mm + high_mm) / 2.0;
        if force_n(&lowered(middle_mm)) > 1000.0 {
            low_mm = middle_mm;
        } else {
            high_mm = middle_mm;
        }
    }
    lowered(low_mm)
}

/// The pose that lies `step_mm` from another towards a third, by the way of a point on the surface.
fn towards(from: &Pose, to: &Pose, step_mm: f64) -> Pose {
    let turn = nalgebra::Rotation3::from_matrix_unchecked(to.rotation * from.rotation.transpose());
    let shift = to.translation - from.translation;
    let part = step_mm / (shift.norm() + 24.0 * turn.angle());
    Pose::new(
        rotation(&(turn.scaled_axis() * part)) * from.rotation,
        from.translation + shift * part,
    )
}

/// Largest difference of the force of a foundation that walked to a pose from that of one made
/// there, as a fraction of it, in small steps from many places of a gait.
fn walked_astray(counterface: &Counterface, z_mm: f64) -> f64 {
    let (insert, law) = (default_insert(), linear());
    let pair = Pair::new(counterface, &insert);
    let fresh = |motion: &RelativeMotion| pair.fresh(&law, motion).force;
    let still_n = |pose: &Pose| fresh(&RelativeMotion::at_rest(*pose)).norm();
    let mut walked = pair.contact(&law);
    let mut worst: f64 = 0.0;
    for place in 0..10 {
        let at = |part: f64| on_the_way(part / 10.0, z_mm, still_n);
        let (mut pose, goal) = (at(f64::from(place)), at(f64::from(place) + 1.0));
        for step_mm in [0.001, 0.003, 0.01, 0.02].repeat(8) {
            pose = towards(&pose, &goal, step_mm);
            let twist = sliding();
            let motion = RelativeMotion { pose, twist };
            let force_n = fresh(&motion);
            assert!(force_n.norm() > 100.0, "{place}: {force_n}");
            let apart = (walked.respond(&motion).wrench.force - force_n).norm();
            worst = worst.max(apart / force_n.norm());
        }
    }
    worst
}

#[test]
fn samples_extrapolated_in_small_steps_change_the_force_by_a_hundred_thousandth() {
    let insert = default_insert();
    let generic = Counterface::Generic(GenericFemur::new(GenericFemurShape::default()));
    for (name, counterface, z_mm) in [
        ("generic", generic, 0.0),
        ("ball", Counterface::sphere(24.0), 23.0),
        ("mesh", mesh_counterface(&insert), 23.0),
    ] {
        let astray = walked_astray(&counterface, z_mm);
        println!("{name}: {astray:.1e}");
        assert!(astray < 1e-5, "{name}: {astray:e}");
    }
}
