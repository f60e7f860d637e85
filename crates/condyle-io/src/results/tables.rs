//! `wear.csv` and `kinematics.csv`.

use std::fmt::Write;

use condyle::{
    evolve::{CycleRecord, UpdateRecord},
    machine::{CycleRow, Freedom},
};

/// `wear.csv`: a row an update.
pub fn wear_csv(updates: &[UpdateRecord]) -> String {
    let mut text = String::from(
        "cycles,mass_loss_mg,volume_loss_mm3,max_depth_mm,peak_pressure_mpa,peak_contact_area_mm2\n",
    );
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
        writeln!(
            text,
            "{cycles},{mass_loss_mg},{volume_loss_mm3},{max_depth_mm},{peak_pressure_mpa},{peak_contact_area_mm2}"
        )
        .expect("writing to a string cannot fail");
    }
    text
}

/// `kinematics.csv`: a row an increment of the given cycles.
///
/// A last cycle that is the first one is written once.
pub fn kinematics_csv(cycles: Option<&(CycleRecord, CycleRecord)>) -> String {
    let mut text = String::from(
        "cycles,percent,flexion_deg,axial_force_n,ap_mm,ie_deg,ml_mm,vv_deg,is_mm,\
         contact_area_mm2,peak_pressure_mpa,medial_force_n,lateral_force_n\n",
    );
    if let Some((first, last)) = cycles {
        add_cycle(&mut text, first);
        if last.cycles != first.cycles {
            add_cycle(&mut text, last);
        }
    }
    text
}

fn add_cycle(text: &mut String, record: &CycleRecord) {
    for row in &record.rows {
        let mm = |freedom: Freedom| row.positions[freedom as usize];
        let deg = |freedom: Freedom| row.positions[freedom as usize].to_degrees();
        let CycleRow {
            percent,
            axial_force_n,
            contact_area_mm2,
            peak_pressure_mpa,
            medial_force_n,
            lateral_force_n,
            ..
        } = row;
        writeln!(
            text,
            "{},{percent},{},{axial_force_n},{},{},{},{},{},{contact_area_mm2},{peak_pressure_mpa},{medial_force_n},{lateral_force_n}",
            record.cycles,
            deg(Freedom::Flexion),
            mm(Freedom::AnteroPosterior),
            deg(Freedom::InternalExternal),
            mm(Freedom::MedioLateral),
            deg(Freedom::VarusValgus),
            mm(Freedom::InferoSuperior),
        )
        .expect("writing to a string cannot fail");
    }
}
