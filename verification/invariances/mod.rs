//! The same knee, said in another way.

mod contact_turned;
mod knee;
mod twice_as_large;

use condyle::{Vec3, machine::knee::IE};

use crate::{Case, Row, marched::marched};
use knee::{Knee, Worn};

pub(crate) const CASE: Case = Case {
    name: "invariances",
    readme: include_str!("README.md"),
    rows,
};

/// Accepted part of the volume and of the largest depth: round-off, grown by contact and friction.
const ROUND_OFF: f64 = 1e-8;

fn rows() -> Vec<Row> {
    let plain = worn(&Knee::default());
    let mut rows = Vec::new();
    for (what, knee) in retold() {
        rows.extend(compared(&plain, &worn(&knee), what));
    }
    rows.extend(compared(&plain, &shifted(), "everything shifted"));
    rows.extend(twice_as_large::rows());
    rows.extend(contact_turned::rows());
    rows
}

/// The same knee in other files.
fn retold() -> [(&'static str, Knee); 5] {
    let knee = Knee::default;
    let turned = |v: &Vec3| Vec3::new(-v.x, v.y, -v.z);
    let away = Vec3::new(3.0, -7.0, 0.0);
    [
        (
            "files in metres",
            Knee {
                unit: "m",
                per_mm: 1e-3,
                ..knee()
            },
        ),
        (
            "femur turned in its file",
            Knee {
                femur: knee().femur.mapped(turned),
                femur_axes: ["posterior", "superior", "left"],
                ..knee()
            },
        ),
        (
            "insert turned in its file",
            Knee {
                insert: knee().insert.mapped(|v| Vec3::new(-v.z, v.x, -v.y)),
                insert_axes: ["left", "anterior", "inferior"],
                ..knee()
            },
        ),
        ("left knee", knee().mirrored()),
        (
            "femur's origin elsewhere",
            Knee {
                femur: knee().femur.mapped(|v| v + away),
                flexion_axis_mm: [away.x, away.y],
                start_mm: knee().start_of_axis_mm(away),
                ..knee()
            },
        ),
    ]
}

fn worn(knee: &Knee) -> Worn {
    Worn::of(&marched(knee.test()))
}

/// Bodies and machine moved together.
fn shifted() -> Worn {
    let by = Vec3::new(2.5, -4.0, 1.75);
    let knee = Knee::default();
    let [x, z] = knee.start_mm;
    let moved = Knee {
        insert: knee.insert.mapped(|v| v + by),
        start_mm: [x + by.x, z + by.z],
        vv_axis_medial_mm: knee.vv_axis_medial_mm - by.z,
        ie_axis_anterior_mm: knee.ie_axis_anterior_mm + by.x,
        ..Knee::default()
    };
    let mut test = moved.test();
    // A case has the IE axis in the middle.
    let machine = &mut test.activities[0].machine;
    machine.joint_mut(IE).axis_point_mm.z += by.z;
    Worn::of(&marched(test))
}

fn compared(plain: &Worn, other: &Worn, what: &str) -> [Row; 2] {
    [
        Row::relative(
            format!("volume, {what}"),
            "mm3",
            plain.volume_mm3,
            other.volume_mm3,
            ROUND_OFF,
        ),
        Row::absolute(
            format!("largest difference of depth, {what}"),
            "mm",
            0.0,
            plain.farthest_depth_mm(other),
            ROUND_OFF * plain.deepest_mm(),
        ),
    ]
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_invariances() {
        super::CASE.assert_holds();
    }
}
