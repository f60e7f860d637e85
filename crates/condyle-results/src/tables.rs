//! `wear.csv` and `kinematics.csv`.

use std::fmt::Write;

use condyle::{
    evolve::{CreepRecord, CycleRecord, UpdateRecord},
    machine::Mechanism,
};

/// `wear.csv`: a row an update.
pub fn wear_csv(updates: &[UpdateRecord]) -> String {
    let mut text = String::from(
        "cycles,mass_loss_mg,volume_loss_mm3,max_depth_mm,peak_pressure_mpa,peak_contact_area_mm2",
    );
    if updates.iter().any(|row| row.creep.is_some()) {
        text.push_str(OF_CREEP);
    }
    text.push('\n');
    for row in updates {
        let UpdateRecord {
            cycles,
            mass_loss_mg,
            volume_loss_mm3,
            max_depth_mm,
            peak_pressure_mpa,
            peak_contact_area_mm2,
            ..
        } = row;
        write!(
            text,
            "{cycles},{mass_loss_mg},{volume_loss_mm3},{max_depth_mm},{peak_pressure_mpa},{peak_contact_area_mm2}"
        )
        .expect("writing to a string cannot fail");
        if let Some(creep) = &row.creep {
            add_creep(&mut text, creep);
        }
        text.push('\n');
    }
    text
}

/// The columns that creep adds, in the order of [`add_creep`].
const OF_CREEP: &str = ",creep_volume_mm3,max_creep_mm,max_penetration_mm,wear_at_max_penetration_mm,creep_at_max_penetration_mm,max_unloaded_depth_mm";

fn add_creep(text: &mut String, creep: &CreepRecord) {
    let CreepRecord {
        volume_mm3,
        max_depth_mm,
        max_penetration_mm,
        wear_there_mm,
        creep_there_mm,
        max_unloaded_mm,
    } = creep;
    write!(
        text,
        ",{volume_mm3},{max_depth_mm},{max_penetration_mm},{wear_there_mm},{creep_there_mm},{max_unloaded_mm}"
    )
    .expect("writing to a string cannot fail");
}

/// `kinematics.csv`: a row an increment of the given cycles, with the columns of their mechanism.
///
/// A last cycle that is the first one is written once.
pub fn kinematics_csv(
    mechanism: &Mechanism,
    cycles: Option<&(CycleRecord, CycleRecord)>,
) -> String {
    let mut text = String::from("cycles,percent");
    for &quantity in mechanism.columns {
        text.push(',');
        text.push_str(mechanism.column(quantity));
    }
    text.push('\n');
    if let Some((first, last)) = cycles {
        add_cycle(&mut text, mechanism, first);
        if last.cycles != first.cycles {
            add_cycle(&mut text, mechanism, last);
        }
    }
    text
}

fn add_cycle(text: &mut String, mechanism: &Mechanism, record: &CycleRecord) {
    for row in &record.rows {
        let values = mechanism.columns.iter();
        let values = values.map(|&quantity| mechanism.value(quantity, row));
        write!(text, "{},{}", record.cycles, row.percent).expect("writing to a string cannot fail");
        for value in values {
            write!(text, ",{value}").expect("writing to a string cannot fail");
        }
        text.push('\n');
    }
}
