//! The insert that yields under a ball and under a cylinder, against closed forms and other finite elements.

mod half_space;
mod rolling;

use std::f64::consts::PI;

use condyle::{
    Mat3, Vec3,
    contact::{
        Backside, Bodies, ContactLaw, ContactMemory, ContactModel, ContactResult, ContactState,
        Deformable, Settled,
    },
    geometry::{ArticulatingSurface, Counterface, Insert},
    spatial::{Pose, RelativeMotion},
};
use condyle_fem::{Elastic, ElasticPlastic, Hardening};
use half_space::half_space;
use rolling::Rolling;

const RADIUS_MM: f64 = 24.0;
const MODULUS_MPA: f64 = 463.0;
const YIELD_MPA: f64 = 14.0;
const EDGE_MM: f64 = 0.3;

struct Pair {
    counterface: Counterface,
    insert: Insert,
    surface: ArticulatingSurface,
    law: Deformable,
}

impl Pair {
    fn new(ratio: f64, hardening: Option<Hardening>) -> Self {
        let insert = half_space(EDGE_MM, 13);
        let elastic = Elastic::new(MODULUS_MPA, ratio).unwrap();
        let mut law = Deformable::new(elastic, 0.0, 1.0, Backside::Bonded, &insert).unwrap();
        if let Some(hardening) = hardening {
            law = law.with_material(ElasticPlastic { elastic, hardening });
        }
        Self {
            counterface: Counterface::sphere(RADIUS_MM),
            surface: insert.surface(),
            insert,
            law,
        }
    }

    fn contact(&self, state: ContactState) -> Box<dyn ContactModel + '_> {
        let memory = ContactMemory {
            state,
            ..ContactMemory::default()
        };
        let bodies = Bodies {
            counterface: &self.counterface,
            insert: &self.insert,
            surface: &self.surface,
        };
        self.law.contact(bodies, memory)
    }

    fn loads(&self, evaluated: &ContactResult) -> Vec<(u32, f64)> {
        let load = |node: &condyle::contact::TouchedNode| {
            let normal = self.surface.normals[node.node as usize];
            (node.node, -normal.dot(&node.force_n))
        };
        evaluated.touched.iter().map(load).collect()
    }
}

fn deep(depth_mm: f64) -> RelativeMotion {
    RelativeMotion::at_rest(Pose::new(
        Mat3::identity(),
        Vec3::new(0.0, RADIUS_MM - depth_mm, 0.0),
    ))
}

/// Presses the ball to a depth, the flow found, and accepts it.
fn press(contact: &mut dyn ContactModel, depth_mm: f64) -> ContactResult {
    let motion = deep(depth_mm);
    for _ in 0..60 {
        contact.respond(&motion);
        if contact.settle(&motion).unwrap() == Settled::Yes {
            break;
        }
    }
    contact.accept(&motion);
    contact.evaluate(&motion)
}

fn force_n(evaluated: &ContactResult) -> f64 {
    -evaluated
        .touched
        .iter()
        .map(|node| node.force_n.y)
        .sum::<f64>()
}

fn contact_modulus(ratio: f64) -> f64 {
    MODULUS_MPA / (1.0 - ratio * ratio)
}

/// Von Mises stress over the highest pressure on the axis of Hertz's contact, at a depth over the radius of contact;
/// the largest shear stress is half of it (Johnson 1985, section 3.4).
fn on_axis(ratio: f64, depth: f64) -> f64 {
    let radial = (1.0 + ratio) * (1.0 - depth * (1.0 / depth).atan());
    (radial - 1.5 / (1.0 + depth * depth)).abs()
}

/// The depth where that is largest, over the radius of contact, and how large it is.
fn largest_on_axis(ratio: f64) -> (f64, f64) {
    let depths = (1..2000).map(|i| f64::from(i) * 1e-3);
    let values = depths.map(|depth| (depth, on_axis(ratio, depth)));
    values.fold(
        (0.0, 0.0),
        |most, next| if next.1 > most.1 { next } else { most },
    )
}

#[test]
fn verify_stress_under_a_ball_against_hertz() {
    let of_steel = largest_on_axis(0.3);
    assert!((of_steel.0 - 0.48).abs() < 0.005 && (of_steel.1 / 2.0 - 0.31).abs() < 0.001);
    for ratio in [0.3, 0.46] {
        let pair = Pair::new(ratio, None);
        let mut contact = pair.contact(ContactState::default());
        let depth_mm = 0.09;
        let evaluated = press(contact.as_mut(), depth_mm);
        let force_n = force_n(&evaluated);
        let modulus = contact_modulus(ratio);
        let radius_mm = (0.75 * force_n * RADIUS_MM / modulus).cbrt();
        let peak_mpa = 1.5 * force_n / (PI * radius_mm * radius_mm);
        let loads = pair.loads(&evaluated);
        let under = pair
            .law
            .under_surface(&pair.insert, &ContactState::default(), 0, &loads)
            .unwrap();
        let largest = |values: &[f64]| {
            let most = values.iter().enumerate();
            let (element, most) = most.max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
            let corners = pair.insert.mesh().corners(element);
            let centre = corners.iter().sum::<Vec3>() / 8.0;
            (most / peak_mpa, -centre.y / radius_mm)
        };
        let (shear, shear_depth) = largest(&under.max_shear_mpa);
        let (von_mises, _) = largest(&under.von_mises_mpa);
        let (exact_depth, exact) = largest_on_axis(ratio);
        println!(
            "v {ratio}: shear {shear:.4} p0 at {shear_depth:.3} a, exactly {:.4} at {exact_depth:.3}; von Mises {von_mises:.4}, exactly {exact:.4}",
            exact / 2.0
        );
        assert!((shear / (exact / 2.0) - 1.0).abs() < 0.03);
        assert!((von_mises / exact - 1.0).abs() < 0.03);
        // To half an element.
        assert!((shear_depth - exact_depth).abs() * radius_mm < 0.5 * EDGE_MM + 0.05);
    }
}

/// Returns the state of the elements that have yielded; empty if none has.
fn plastic_strains(state: &ContactState) -> Vec<f64> {
    let mut fields = state.fields.iter();
    let field = fields.find(|field| field.name.starts_with("plastic_strain"));
    field.map_or(Vec::new(), |field| field.values.clone())
}

#[test]
fn verify_first_yield_below_the_surface_and_shakedown_on_the_second_press() {
    let ratio = 0.46;
    let hardening = Hardening::new(vec![(0.0, YIELD_MPA), (0.02, 24.0)], 0.0).unwrap();
    let pair = Pair::new(ratio, Some(hardening));
    let mut contact = pair.contact(ContactState::default());
    let (_, most) = largest_on_axis(ratio);
    let peak_mpa = YIELD_MPA / most;
    let modulus = contact_modulus(ratio);
    let exact_n = PI.powi(3) * RADIUS_MM.powi(2) * peak_mpa.powi(3) / (6.0 * modulus.powi(2));
    let mut depth_mm = 0.06;
    let first_n = loop {
        let evaluated = press(contact.as_mut(), depth_mm);
        contact = {
            let state = contact.into_memory().state;
            if !plastic_strains(&state).is_empty() {
                break force_n(&evaluated);
            }
            pair.contact(state)
        };
        depth_mm += 0.001;
        assert!(depth_mm < 0.2);
    };
    println!("first yield {first_n:.1} N, exactly {exact_n:.1} N");
    // The stress of an element at its Gauss points errs by 2 %, and the force goes with the cube of stress.
    let of_stress = (first_n / exact_n).cbrt();
    assert!((of_stress - 1.0).abs() < 0.03, "{first_n} {exact_n}");

    // Pressed three times as deep, let go, and pressed to the same depth.
    let mut contact = pair.contact(ContactState::default());
    for step in 1..=10 {
        press(contact.as_mut(), 0.02 * f64::from(step));
    }
    let loaded = press(contact.as_mut(), 0.2);
    for step in (0..10).rev() {
        press(contact.as_mut(), 0.02 * f64::from(step));
    }
    let state = contact.into_memory().state;
    let under = pair
        .law
        .under_surface(&pair.insert, &state, 0, &[])
        .unwrap();
    let plastic = under.plastic.unwrap();
    let set_mm = plastic.permanent_set_mm.iter().copied().fold(0.0, f64::max);
    println!("set {set_mm:.4} mm under {:.1} N", force_n(&loaded));
    assert!(set_mm > 0.002 && set_mm < 0.1, "{set_mm}");
    // It yields below the surface, not at it.
    let deepest = plastic.plastic_strain.iter().enumerate();
    let (element, _) = deepest.max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
    let corners = pair.insert.mesh().corners(element);
    let centre = corners.iter().sum::<Vec3>() / 8.0;
    assert!(
        centre.y < -0.3 && centre.x.hypot(centre.z) < 0.5,
        "{centre}"
    );

    let before = state.clone();
    let mut contact = pair.contact(state);
    for step in 1..=10 {
        press(contact.as_mut(), 0.02 * f64::from(step));
    }
    let again = press(contact.as_mut(), 0.2);
    assert!((force_n(&again) / force_n(&loaded) - 1.0).abs() < 1e-3);
    let after = plastic_strains(&contact.into_memory().state);
    let before = plastic_strains(&before);
    assert_eq!(after.len(), before.len());
    // The second press is elastic, but for what the first one was found to.
    for (place, (after, before)) in after.iter().zip(&before).enumerate() {
        if place % 106 > 1 {
            assert!((after - before).abs() < 2e-5, "{place} {after} {before}");
        }
    }
}

#[test]
fn verify_a_ball_deep_in_yield_against_axisymmetric_finite_elements() {
    // By validation/plastic-ball/axisymmetric.py, right to 1 %, for a yield stress of E / (1 - v^2) / 200.
    let exact_n = [(0.02, 8.46), (0.05, 28.8)];
    let ratio = 0.3;
    let yield_mpa = contact_modulus(ratio) / 200.0;
    let hardening = Hardening::perfectly_plastic(yield_mpa).unwrap();
    let pair = Pair::new(ratio, Some(hardening));
    let mut contact = pair.contact(ContactState::default());
    let mut depth_mm = 0.0;
    for (deepest_mm, exact_n) in exact_n {
        let evaluated = loop {
            depth_mm += 0.005;
            let evaluated = press(contact.as_mut(), depth_mm);
            if depth_mm > deepest_mm - 1e-9 {
                break evaluated;
            }
        };
        let force_n = force_n(&evaluated);
        let area_mm2: f64 = evaluated.touched.iter().map(|node| node.covered_mm2).sum();
        let elastic_n = 4.0 / 3.0 * contact_modulus(ratio) * (RADIUS_MM * depth_mm.powi(3)).sqrt();
        println!(
            "{depth_mm:.3} mm: {force_n:.2} N, axisymmetric {exact_n} N, elastic {elastic_n:.1} N; mean pressure {:.2} Y",
            force_n / area_mm2 / yield_mpa
        );
        assert!(
            (force_n / exact_n - 1.0).abs() < 0.03,
            "{force_n} {exact_n}"
        );
        assert!(force_n < 0.95 * elastic_n);
    }
}

/// What the passes after the first few add, if the insert is rolled over that often.
fn in_the_third_pass(rolling: &mut Rolling, peak_over_shear_yield: f64) -> f64 {
    let flows = rolling.flows(peak_over_shear_yield, 3);
    println!("{peak_over_shear_yield} k: {flows:?}");
    assert!(flows[2] > 0.8 * flows[1], "{flows:?}");
    flows[2]
}

#[test]
fn verify_the_shakedown_limit_of_line_contact_by_repeated_rolling() {
    let mut rolling = Rolling::new();
    let below = rolling.flows(3.8, 7);
    println!("3.8 k: {below:?}");
    assert!(below[0] > 1e-3 && below[6] < 1e-6, "{below:?}");
    // What is added in a pass begins at the limit, and goes with what is above it.
    let [low, high] = [4.2, 4.4].map(|times| in_the_third_pass(&mut rolling, times));
    let limit = 4.2 - 0.2 * low / (high - low);
    println!("nothing is added below {limit:.3} k");
    assert!((limit / 4.0 - 1.0).abs() < 0.03, "{limit}");
}
