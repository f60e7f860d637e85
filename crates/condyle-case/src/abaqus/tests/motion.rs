//! The mechanism of the file moves as condyle's chain does.

use condyle::Vec3;
use condyle::evolve::March;
use condyle::machine::Chain;
use condyle::spatial::Pose;

use super::super::{AbaqusOptions, model::Model};
use super::reader::Deck;
use super::{COARSE, parsed, written};

/// A turn by `angle` about an axis along `axis` (0 x, 1 y, 2 z) through `centre`.
fn turned(axis: usize, angle: f64, centre: &Vec3, point: &Vec3) -> Vec3 {
    let (sine, cosine) = angle.sin_cos();
    let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
    let from = point - centre;
    let mut to = from;
    to[j] = cosine * from[j] - sine * from[k];
    to[k] = sine * from[j] + cosine * from[k];
    centre + to
}

/// The insert's material at `point` of the file, moved by the carriage's U1, U3, UR2 and the
/// hinge's CUR1.
fn insert_moved(deck: &Deck, q: &[f64; 6], point: &Vec3) -> Vec3 {
    let [vv, ie, ml, ap, _, _] = *q;
    let hinged = turned(0, vv, &deck.point("INSERT-REF"), point);
    turned(1, ie, &deck.point("CARRIAGE"), &hinged) + Vec3::new(ap, 0.0, ml)
}

/// The femur's material, moved by its reference node's U2 and UR3.
fn femur_moved(deck: &Deck, q: &[f64; 6], point: &Vec3) -> Vec3 {
    let [_, _, _, _, is, flexion] = *q;
    turned(2, flexion, &deck.point("FEMUR-REF"), point) + Vec3::y() * is
}

#[test]
fn cross_the_nodes_and_hinges_of_the_file_move_as_the_chain() {
    let case = parsed(&format!("{COARSE}[machine]\nie_axis_anterior_mm = 3.0\n"));
    for explicit in [false, true] {
        let options = AbaqusOptions {
            deformable: false,
            explicit,
        };
        let deck = Deck::read(&written(&case, options));
        let march = March::start(case.build(1).unwrap().test).unwrap();
        let model = Model::new(&case, &march, options).unwrap();
        let test = march.test();
        let chain = Chain::new(test.machine(), march.state().zero_mm, test.flexion_axis_mm);
        let away = [0.03, -0.12, 1.2, -3.0, 0.4, 0.7];
        let mut positions = model.placing.positions;
        positions.iter_mut().zip(away).for_each(|(q, d)| *q += d);
        let pose: Pose = chain.at(&positions).pose;
        for point in [
            Vec3::new(1.0, -20.0, 23.0),
            Vec3::zeros(),
            Vec3::new(-9.0, 4.0, -23.0),
        ] {
            let of_femur = femur_moved(&deck, &away, &model.placing.femur.to_insert(&point));
            let beside = model.placing.insert_point(&pose.to_insert(&point));
            let of_insert = insert_moved(&deck, &away, &beside);
            assert!(
                (of_femur - of_insert).norm() < 1e-9,
                "{of_femur} {of_insert}"
            );
        }
    }
}

#[test]
fn an_explicit_file_begins_without_overlap() {
    let case = parsed(COARSE);
    let march = March::start(case.build(1).unwrap().test).unwrap();
    let smallest = |explicit: bool| {
        let options = AbaqusOptions {
            deformable: false,
            explicit,
        };
        let model = Model::new(&case, &march, options).unwrap();
        model
            .placing
            .gaps_mm(march.test())
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    };
    assert!(smallest(false) < -0.005, "{}", smallest(false));
    assert!(
        (0.005..0.01).contains(&smallest(true)),
        "{}",
        smallest(true)
    );
}
