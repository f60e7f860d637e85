//! A counterface that settles where its load rests on few nodes of a coarse mesh.

use std::sync::Arc;

use condyle::{
    Vec3,
    contact::{Foundation, PressureLaw, confined_modulus},
    evolve::{Activity, March, PlacementError, Schedule, WearTest},
    geometry::{Counterface, GenericFemur, GenericFemurShape, GenericInsertShape, Meshing},
    machine::{
        Drive, Machine, TimeSettings, Waveform,
        knee::{self, KNEE},
    },
    wear::Archard,
};

/// The machine of a Stanmore simulator at the start of its cycle.
fn machine(low_point_mm: Vec3) -> Machine {
    let mut machine = Machine::new(&KNEE);
    for index in [knee::VV, knee::IE, knee::ML, knee::AP] {
        machine.joint_mut(index).drive = Drive::Loaded(Waveform::constant(0.0));
    }
    machine.joint_mut(knee::IS).drive = Drive::Loaded(Waveform::constant(-98.228));
    let flexion_rad = 1.118_f64.to_radians();
    machine.joint_mut(knee::FLEXION).drive = Drive::Prescribed(Waveform::constant(flexion_rad));
    machine.joint_mut(knee::VV).axis_point_mm =
        Vec3::new(low_point_mm.x, low_point_mm.y - 20.0, -6.427);
    machine
}

/// Found among random designs: the counterface comes to rest where one arc of it passes into the next.
fn test(edge_mm: f64) -> WearTest {
    let counterface = GenericFemurShape {
        distal_radius_mm: 16.723,
        posterior_radius_mm: 12.443,
        transition_deg: 16.31,
        coronal_radius_mm: 58.76,
        spacing_mm: 37.214,
    };
    let insert = GenericInsertShape {
        sagittal_radius_mm: 32.127,
        coronal_radius_mm: 63.363,
        spacing_mm: 37.214,
        thickness_mm: 14.168,
    };
    let meshing = Meshing { edge_mm, layers: 1 };
    let insert = insert.insert(meshing).expect("it is an insert");
    let low_point_mm = insert.dish_low_point_mm();
    let modulus_mpa = confined_modulus(463.0, 0.46);
    WearTest {
        counterface: Arc::new(Counterface::Generic(GenericFemur::new(counterface))),
        flexion_axis_mm: (0.0, 0.0),
        start_mm: (low_point_mm.x, 0.0),
        start_height_mm: None,
        insert: Arc::new(insert),
        contact: Arc::new(Foundation::new(
            PressureLaw::Linear { modulus_mpa },
            0.07,
            0.3,
        )),
        activities: vec![Activity::only("walking", machine(low_point_mm))],
        wear: Arc::new(Archard {
            wear_factor_mm3_per_nm: 2.64e-7,
        }),
        comparison_laws: Vec::new(),
        law_family: false,
        creep: None,
        density_mg_per_mm3: 0.93,
        time: TimeSettings::default(),
        schedule: Schedule::fixed(1.0, 1),
    }
}

/// The force jumps where a share passes from one arc of the counterface to the next, by as much as it spreads.
#[test]
fn a_counterface_that_rests_where_the_force_jumps_is_told_to_take_a_finer_mesh() {
    let error = March::start(test(2.375))
        .err()
        .expect("there is no balance");
    assert!(matches!(error, PlacementError::Unsteady { .. }), "{error}");
    let said = error.to_string();
    assert!(said.contains("take a smaller edge_mm"), "{said}");
    assert!(!said.contains("start_mm"), "{said}");
}

#[test]
fn the_same_counterface_settles_on_a_finer_mesh() {
    March::start(test(1.2)).unwrap_or_else(|error| panic!("{error}"));
}
