//! A layer on its tray, against closed forms and balances.

use nalgebra::DVector;

use super::tray::{Rest, Tray};
use crate::{
    Vec3,
    contact::{
        deformable::{elastic_surface::ElasticSurface, history::NodeLoad},
        model::NotBorne,
    },
    geometry::{Insert, Meshing, Share, flat_insert},
};

const MODULUS_MPA: f64 = 463.0;
const POISSON: f64 = 0.46;
const THICKNESS_MM: f64 = 9.0;

/// A flat layer that rests on its tray.
struct Layer {
    insert: Insert,
    surface: ElasticSurface,
    tray: std::sync::Arc<Tray>,
}

/// A state of a layer: loads, how far they move the surface, and the rest of the backside under them.
struct Loaded {
    loads: Vec<NodeLoad>,
    moved_mm: Vec<f64>,
    forces_n: DVector<f64>,
    rest: Rest,
}

impl Layer {
    fn new(size_mm: (f64, f64), meshing: Meshing, spacing_mm: f64) -> Self {
        let insert = flat_insert(size_mm, THICKNESS_MM, meshing).unwrap();
        let elastic = condyle_fem::Elastic::new(MODULUS_MPA, POISSON).unwrap();
        let surface = ElasticSurface::new(&insert, insert.unworn_nodes(), elastic, true).unwrap();
        let tray = surface.tray(spacing_mm);
        Self {
            insert,
            surface,
            tray,
        }
    }

    fn loads(&self, pressure_mpa: impl Fn(&Vec3) -> f64) -> Vec<NodeLoad> {
        let surface = self.insert.surface();
        let nodes = surface.positions.iter().zip(&surface.shares).zip(0..);
        let load = |((place, share), node): ((&Vec3, &Share), u32)| {
            (node, share.area_mm2 * pressure_mpa(place))
        };
        nodes.map(load).collect()
    }

    fn at_rest(&self, loads: Vec<NodeLoad>, friction: f64, from_mm: &[f64]) -> Loaded {
        let forces_n = self.surface.forces_on_tray(&self.tray, &loads);
        let begin = DVector::from_column_slice(from_mm);
        let rest = self
            .tray
            .rest(friction, from_mm, &forces_n, &begin)
            .unwrap();
        let moved_mm = self
            .surface
            .moved_with_tray(&loads, &self.tray, &rest.moved_mm);
        Loaded {
            moved_mm: self.surface.along_normals(&moved_mm),
            loads,
            forces_n,
            rest,
        }
    }

    fn made(&self) -> Vec<f64> {
        vec![0.0; self.tray.freedoms()]
    }

    /// The node of the surface that is nearest to the middle.
    fn middle(&self) -> usize {
        let surface = self.insert.surface();
        let apart = |node: &usize| surface.positions[*node].xz().norm();
        (0..surface.positions.len())
            .min_by(|a, b| apart(a).total_cmp(&apart(b)))
            .unwrap()
    }
}

/// Blocks of 72 mm on hexahedra of 1.8 mm.
fn wide(spacing_mm: f64) -> Layer {
    let meshing = Meshing {
        edge_mm: 1.8,
        layers: 5,
    };
    Layer::new((72.0, 72.0), meshing, spacing_mm)
}

fn small(spacing_mm: f64) -> Layer {
    let meshing = Meshing {
        edge_mm: 2.0,
        layers: 4,
    };
    Layer::new((24.0, 18.0), meshing, spacing_mm)
}

/// Pressure of a ball: `peak_mpa` in the middle of a disc of that radius.
fn ball(peak_mpa: f64, radius_mm: f64) -> impl Fn(&Vec3) -> f64 {
    move |place| {
        let r = place.xz().norm() / radius_mm;
        peak_mpa * (1.0 - r * r).max(0.0).sqrt()
    }
}

#[test]
fn verify_a_block_under_even_pressure_on_a_smooth_tray_and_on_a_rough_one() {
    let layer = small(5.0);
    let pressure_mpa = 4.0;
    let even = layer.loads(|_| pressure_mpa);
    // On a smooth tray it widens freely: strain p / E, and v p / E along the tray.
    let smooth = layer.at_rest(even.clone(), 0.0, &layer.made());
    let strain = pressure_mpa / MODULUS_MPA;
    for moved_mm in &smooth.moved_mm {
        assert!((moved_mm / (strain * THICKNESS_MM) - 1.0).abs() < 1e-5);
    }
    let points = layer.tray.points.iter();
    let (moved, pushes) = (&smooth.rest.moved_mm, &smooth.rest.pushes_n);
    for (at, point) in points.enumerate() {
        let exact = point.position * (POISSON * strain);
        let apart = (moved[3 * at] - exact.x).hypot(moved[3 * at + 1] - exact.z);
        assert!(apart < 1e-5 && moved[3 * at + 2] == 0.0, "{apart}");
        let push_mpa = pushes[3 * at + 2] / point.area_mm2;
        assert!((push_mpa / pressure_mpa - 1.0).abs() < 1e-3, "{push_mpa}");
    }
    // On a rough one it presses everywhere and slips nowhere: that is the bonded block.
    let rough = layer.at_rest(even.clone(), 1e3, &layer.made());
    assert!(rough.rest.moved_mm.iter().all(|moved| *moved == 0.0));
    let bonded = layer.surface.moved_by(&even, &Default::default());
    let bonded = layer.surface.along_normals(&bonded);
    for (rough, bonded) in rough.moved_mm.iter().zip(bonded) {
        assert!((rough - bonded).abs() < 1e-12);
    }
}

/// Pressure of a bell, as wide as the contact of a ball, and smooth.
const PEAK_MPA: f64 = 20.0;
const WIDTH_MM: f64 = 5.0;

/// How far the middle of a layer deflects under the pressure of a bell, mm: the Hankel transform with the transfer
/// function of a layer on a smooth rigid base, or of one that is bonded to it.
fn of_transform(bonded: bool) -> f64 {
    let v = POISSON;
    let transfer = |x: f64| {
        // Beyond, both are those of the half-space.
        if x > 30.0 {
            1.0
        } else if bonded {
            ((3.0 - 4.0 * v) * (2.0 * x).sinh() - 2.0 * x)
                / ((3.0 - 4.0 * v) * (2.0 * x).cosh() + 2.0 * x * x + 5.0 - 12.0 * v + 8.0 * v * v)
        } else {
            x.sinh().powi(2) / (x.sinh() * x.cosh() + x)
        }
    };
    let of_pressure = |x: f64| (-0.5 * x * x).exp();
    let step = 1e-3;
    let part = |i: u32| {
        let k = (f64::from(i) + 0.5) * step;
        transfer(k * THICKNESS_MM) * of_pressure(k * WIDTH_MM) * step
    };
    let integral: f64 = (0..4_000).map(part).sum();
    2.0 * (1.0 - v * v) / MODULUS_MPA * PEAK_MPA * WIDTH_MM * WIDTH_MM * integral
}

#[test]
fn verify_a_bell_of_pressure_on_a_layer_on_a_smooth_base_and_on_a_bonded_one() {
    // An even pressure next to it keeps the layer on its base; without friction it adds what it does alone.
    let (layer, even_mpa) = (wide(5.0), 10.0);
    let (middle, bell) = (layer.middle(), |place: &Vec3| {
        PEAK_MPA * (-0.5 * place.xz().norm_squared() / (WIDTH_MM * WIDTH_MM)).exp()
    });
    let both = layer.loads(|place| even_mpa + bell(place));
    let smooth = layer.at_rest(both, 0.0, &layer.made());
    assert!(smooth.rest.pushes_n.chunks(3).all(|push| push[2] > 0.0));
    let smooth = smooth.moved_mm[middle] - even_mpa / MODULUS_MPA * THICKNESS_MM;
    let exact = of_transform(false);
    let bonded = layer
        .surface
        .moved_by(&layer.loads(bell), &Default::default());
    let bonded = layer.surface.along_normals(&bonded)[middle];
    let exact_bonded = of_transform(true);
    println!("smooth {smooth:.5} of {exact:.5}, bonded {bonded:.5} of {exact_bonded:.5}");
    for ratio in [smooth / exact, bonded / exact_bonded] {
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }
    // What the elements err by is common to both.
    let (ratio, exact) = (smooth / bonded, exact / exact_bonded);
    assert!(
        exact > 1.3 && (ratio / exact - 1.0).abs() < 0.01,
        "{ratio} {exact}"
    );
}

#[test]
fn friction_leads_from_the_smooth_base_to_the_rough_one() {
    let (layer, ball) = (small(3.0), ball(30.0, 6.0));
    let middle = layer.middle();
    let moved = |friction: f64| {
        let loaded = layer.at_rest(layer.loads(&ball), friction, &layer.made());
        loaded.moved_mm[middle]
    };
    let moved: Vec<f64> = [0.0, 0.05, 0.1, 0.2, 0.4, 1.0, 10.0].map(moved).to_vec();
    println!("{moved:?}");
    assert!(moved.windows(2).all(|two| two[1] < two[0] + 1e-7));
    assert!(moved[0] > 1.05 * moved[6]);
}

#[test]
fn what_pushes_the_backside_is_what_presses_the_surface() {
    let layer = small(4.0);
    // Off the middle, so that the far end lifts.
    let off = Vec3::new(6.0, 0.0, 4.0);
    let ball = ball(30.0, 5.0);
    let loaded = layer.at_rest(
        layer.loads(|place| ball(&(place - off))),
        0.2,
        &layer.made(),
    );
    let sum = |of: &dyn Fn(&Vec3) -> f64| -> [f64; 2] {
        let surface = layer.insert.surface();
        let loads = loaded.loads.iter();
        let above = loads.map(|&(node, load_n)| load_n * of(&surface.positions[node as usize]));
        let points = layer.tray.points.iter().zip(loaded.rest.pushes_n.chunks(3));
        let below = points.map(|(point, push)| push[2] * of(&point.position));
        [above.sum(), below.sum()]
    };
    for of in [
        |_: &Vec3| 1.0,
        |place: &Vec3| place.x,
        |place: &Vec3| place.z,
    ] {
        let [above, below] = sum(&of);
        assert!((above / below - 1.0).abs() < 1e-5, "{above} {below}");
    }
    let lifted = loaded
        .rest
        .moved_mm
        .chunks(3)
        .filter(|point| point[2] > 1e-4);
    assert!(lifted.count() > 3);
    for (moved, push) in loaded
        .rest
        .moved_mm
        .chunks(3)
        .zip(loaded.rest.pushes_n.chunks(3))
    {
        assert!(moved[2] >= 0.0 && push[2] >= 0.0 && moved[2] * push[2] == 0.0);
        assert!(push[0].hypot(push[1]) <= 0.2 * push[2] * (1.0 + 1e-9) + 1e-12);
    }
}

#[test]
fn the_work_of_the_loads_is_stored_or_rubbed_away() {
    let (layer, friction) = (small(4.0), 0.15);
    let (one, other) = (ball(30.0, 6.0), ball(25.0, 5.0));
    let off = Vec3::new(5.0, 0.0, -3.0);
    let path = |step: usize| {
        let (a, b) = [
            (0.0, 0.0),
            (0.5, 0.0),
            (1.0, 0.0),
            (0.7, 0.5),
            (0.3, 1.0),
            (0.6, 0.4),
            (1.0, 0.0),
        ][step];
        layer.loads(|place| a * one(place) + b * other(&(place - off)))
    };
    let energy = |loaded: &Loaded| {
        let loads = loaded.loads.iter();
        let by_loads = loads.map(|&(node, load_n)| load_n * loaded.moved_mm[node as usize]);
        // Half of the loads' work, and half of that of what pushes the backside.
        let pushes = loaded.rest.pushes_n.iter().zip(&loaded.rest.moved_mm);
        0.5 * (by_loads.sum::<f64>() + pushes.map(|(push, moved)| push * moved).sum::<f64>())
    };
    let mut before = layer.at_rest(path(0), friction, &layer.made());
    let (mut work, mut rubbed) = (0.0, 0.0);
    let mut loop_began = 0.0;
    for step in 1..7 {
        let after = layer.at_rest(path(step), friction, &before.rest.moved_mm);
        for (a, b) in before.loads.iter().zip(&after.loads) {
            let node = a.0 as usize;
            work += 0.5 * (a.1 + b.1) * (after.moved_mm[node] - before.moved_mm[node]);
        }
        let way = after.rest.moved_mm.iter().zip(&before.rest.moved_mm);
        let pushes = after.rest.pushes_n.iter().zip(&before.rest.pushes_n);
        let rubs = way
            .zip(pushes)
            .map(|((to, from), (a, b))| 0.5 * (a + b) * (from - to));
        rubbed += rubs.sum::<f64>();
        let stored = energy(&after);
        println!("{step}: work {work:.6}, stored {stored:.6}, rubbed {rubbed:.6} mJ");
        assert!((work - stored - rubbed).abs() < 1e-5 * stored, "{step}");
        if step == 2 {
            loop_began = rubbed;
        }
        before = after;
    }
    assert!(rubbed > loop_began && loop_began > 0.0);
    assert!(before.forces_n.amax() > 0.0);
}

#[test]
fn a_finer_grid_of_points_says_the_same() {
    let ball = ball(20.0, 9.0);
    let moved = |spacing_mm: f64| {
        let layer = wide(spacing_mm);
        let loaded = layer.at_rest(layer.loads(&ball), 0.2, &layer.made());
        loaded.moved_mm[layer.middle()]
    };
    let [coarse, default, fine, finest] = [10.0, 5.0, 4.0, 3.0].map(moved);
    println!("{coarse:.6} {default:.6} {fine:.6} {finest:.6}");
    assert!((default / finest - 1.0).abs() < 0.01);
    assert!((fine / finest - 1.0).abs() < (default / finest - 1.0).abs());
    assert!((default / finest - 1.0).abs() < (coarse / finest - 1.0).abs());
}

#[test]
fn the_lock_carries_what_pushes_along_a_smooth_tray() {
    let layer = small(4.0);
    let mut forces_n = DVector::zeros(layer.tray.freedoms());
    let area_mm2: f64 = layer.tray.points.iter().map(|point| point.area_mm2).sum();
    for (at, point) in layer.tray.points.iter().enumerate() {
        forces_n[3 * at] = 50.0 * point.area_mm2 / area_mm2;
        forces_n[3 * at + 2] = -500.0 * point.area_mm2 / area_mm2;
    }
    let made = layer.made();
    let rest_at = |friction| {
        layer
            .tray
            .rest(friction, &made, &forces_n, &made.clone().into())
    };
    let found = rest_at(0.0).unwrap();
    let lock = layer.tray.lock_load(&found.moved_mm.clone().into());
    assert!((lock[0] - 50.0).abs() < 0.1 && lock[1] < 1.0, "{lock:?}");
    // With friction enough it carries nothing.
    let found = rest_at(0.5).unwrap();
    assert_eq!(layer.tray.lock_load(&found.moved_mm.into())[0], 0.0);
}

#[test]
fn an_insert_that_is_pulled_off_tips() {
    let layer = small(6.0);
    let mut forces_n = DVector::zeros(layer.tray.freedoms());
    forces_n[2] = 10.0;
    let made = layer.made();
    let tipped = layer.tray.rest(0.2, &made, &forces_n, &made.clone().into());
    assert!(matches!(tipped, Err(NotBorne::Tipped { moved_mm }) if moved_mm > 10.0));
}
