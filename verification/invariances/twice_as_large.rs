//! A knee twice as large, loaded so that its pressures are the same.

use std::sync::Arc;

use condyle::{
    Vec3,
    evolve::{March, WearTest},
    geometry::{GenericInsertShape, Insert},
    machine::{Drive, JointKind, knee},
};
use condyle_mesh::columns::{ColumnGrid, Meshing};

use super::knee::EXACTLY;
use crate::{
    Row,
    marched::{marched, test_of},
};

const FACTOR: f64 = 2.0;

/// What the lengths that stand in the program leave, and what friction makes of it.
const TOLERANCE: f64 = 3e-5;

pub(super) fn rows() -> [Row; 3] {
    let [one, two] = [1.0, FACTOR].map(|factor| marched(test(factor)));
    let updates = [&one, &two].map(|march: &March| march.state().updates.last().expect("one"));
    let [one, two] = updates;
    [
        Row::relative(
            "volume, twice as large, over 8",
            "mm3",
            one.volume_loss_mm3,
            two.volume_loss_mm3 / FACTOR.powi(3),
            TOLERANCE,
        ),
        Row::relative(
            "depth, twice as large, over 2",
            "mm",
            one.max_depth_mm,
            two.max_depth_mm / FACTOR,
            TOLERANCE,
        ),
        Row::relative(
            "peak pressure, twice as large",
            "MPa",
            one.peaks.peak_pressure_mpa,
            two.peaks.peak_pressure_mpa,
            TOLERANCE,
        ),
    ]
}

/// A generic knee `factor` times as large.
fn test(factor: f64) -> WearTest {
    let femur = format!(
        "\
[femur]
distal_radius_mm = {:?}
posterior_radius_mm = {:?}
coronal_radius_mm = {:?}
spacing_mm = {:?}
[contact]
slip_tolerance_mm_per_s = {:?}
",
        38.0 * factor,
        22.0 * factor,
        24.0 * factor,
        46.0 * factor,
        10.0 * factor,
    );
    let mut test = test_of(&(femur + &EXACTLY.replace("100", "400")));
    test.insert = Arc::new(insert(factor));
    scale_machine(&mut test, factor);
    test
}

/// The middle of the generic insert's dishes, which the contact does not leave.
fn insert(factor: f64) -> Insert {
    let shape = GenericInsertShape::default();
    let grid = ColumnGrid::filling((-22.0, -34.0), (20.0, 34.0), 1.5, 1).expect("a grid");
    let column = |i, k| {
        let [x, z] = grid.place_mm(i, k).into();
        (-factor * shape.thickness_mm, factor * shape.height_mm(x, z))
    };
    let points = (0..=grid.cells.0).flat_map(|i| (0..=grid.cells.1).map(move |k| (i, k)));
    let columns: Vec<_> = points.map(|(i, k)| column(i, k)).collect();
    let built = grown(grid, factor).plan().hexahedra(
        &columns,
        Meshing {
            edge_mm: 1.5,
            layers: 1,
        },
    );
    Insert::new(built.mesh, &built.articulating, &built.backside).expect("an insert")
}

fn grown(grid: ColumnGrid, factor: f64) -> ColumnGrid {
    ColumnGrid {
        origin_mm: grid.origin_mm * factor,
        step_mm: grid.step_mm * factor,
        ..grid
    }
}

/// Loads, springs, inertia, damping and axes, so that pressures stay.
fn scale_machine(test: &mut WearTest, factor: f64) {
    let (square, cube) = (factor.powi(2), factor.powi(3));
    let machine = &mut test.activities[0].machine;
    for joint in &mut machine.joints {
        let (load, slow) = match joint.description.kind() {
            JointKind::Rotation => (cube, cube),
            JointKind::Translation => (square, factor),
        };
        joint.inertia *= slow;
        joint.damping *= slow;
        if let Drive::Loaded(waveform) = &mut joint.drive {
            *waveform = waveform.clone().scaled(load);
        }
    }
    for spring in &mut machine.springs {
        spring.offset_mm *= factor;
        spring.free_play *= factor;
        spring.positive_stiffness *= factor;
        spring.negative_stiffness *= factor;
    }
    machine.joint_mut(knee::VV).axis_point_mm = Vec3::new(0.0, -20.0 * factor, -5.0 * factor);
    test.time.force_tolerance_n *= square;
    test.time.repeat_tolerance_mm *= factor;
}
