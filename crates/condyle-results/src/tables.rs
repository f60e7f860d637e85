//! `wear.csv`, `kinematics.csv` and `femur_pose.csv`.

use condyle::{
    evolve::{CreepRecord, CycleRecord, March, UpdateRecord},
    machine::CycleRow,
};

use super::{
    parts::rotation_rows,
    side::{Side, pose_on_side},
};

/// A column of `wear.csv`.
#[derive(Clone, Copy, Debug)]
pub struct WearColumn {
    /// Its name, which ends in its unit.
    pub name: &'static str,
    /// A description.
    pub about: &'static str,
    value: Value,
}

#[derive(Clone, Copy, Debug)]
enum Value {
    OfUpdate(fn(&UpdateRecord) -> f64),
    /// Only in the table of an insert that creeps.
    OfCreep(fn(&CreepRecord) -> f64),
}

/// Declares a list of named values; the doc comment of each is its description.
macro_rules! described {
    ($(#[doc = $list:literal])+ $list_name:ident: $kind:ident;
     $($(#[doc = $about:literal])+ $name:ident = $value:expr;)+) => {
        $(#[doc = $list])+
        pub const $list_name: &[$kind] = &[$($kind {
            name: stringify!($name),
            about: concat!($($about),+),
            value: $value,
        }),+];
    };
}

pub(super) use described;

described! {
    /// The columns of `wear.csv`.
    WEAR_COLUMNS: WearColumn;
    /// Cycles after the update.
    cycles = Value::OfUpdate(|row| row.cycles);
    /// Mass worn.
    mass_loss_mg = Value::OfUpdate(|row| row.mass_loss_mg);
    /// Volume worn, from depth.
    volume_loss_mm3 = Value::OfUpdate(|row| row.volume_loss_mm3);
    /// Deepest wear.
    max_depth_mm = Value::OfUpdate(|row| row.max_depth_mm);
    /// Highest pressure in the cycle that the update solved, on the surface before it.
    peak_pressure_mpa = Value::OfUpdate(|row| row.peaks.peak_pressure_mpa);
    /// Largest contact area in that cycle.
    peak_contact_area_mm2 = Value::OfUpdate(|row| row.peaks.contact_area_mm2);
    /// Volume of creep.
    creep_volume_mm3 = Value::OfCreep(|creep| creep.volume_mm3);
    /// Deepest creep.
    max_creep_mm = Value::OfCreep(|creep| creep.max_depth_mm);
    /// Deepest penetration, wear and creep together.
    max_penetration_mm = Value::OfCreep(|creep| creep.max_penetration_mm);
    /// Wear at the deepest penetration.
    wear_at_max_penetration_mm = Value::OfCreep(|creep| creep.wear_there_mm);
    /// Creep at the deepest penetration.
    creep_at_max_penetration_mm = Value::OfCreep(|creep| creep.creep_there_mm);
    /// Deepest place of a scan after the insert has rested without load.
    max_unloaded_depth_mm = Value::OfCreep(|creep| creep.max_unloaded_depth_mm);
}

/// `wear.csv`: a row an update.
pub fn wear_csv(updates: &[UpdateRecord]) -> String {
    // Columns of creep would be empty for most runs.
    let creeps = updates.iter().any(|row| row.creep.is_some());
    let columns = WEAR_COLUMNS.iter();
    let columns: Vec<&WearColumn> = columns
        .filter(|column| creeps || matches!(column.value, Value::OfUpdate(_)))
        .collect();
    let names = columns.iter().map(|column| column.name.to_owned());
    let mut text = line(names);
    for row in updates {
        let values = columns.iter().filter_map(|column| match column.value {
            Value::OfUpdate(value) => Some(value(row)),
            Value::OfCreep(value) => row.creep.as_ref().map(value),
        });
        text += &line(values.map(|value| value.to_string()));
    }
    text
}

fn line(cells: impl Iterator<Item = String>) -> String {
    cells.collect::<Vec<_>>().join(",") + "\n"
}

/// Returns `kinematics.csv` of an activity: a row an increment of its first and last cycle, with the columns of its mechanism
/// and the tension of each ligament, N.
///
/// A last cycle that is the first one is written once.
pub fn kinematics_csv(march: &March, activity: usize) -> String {
    let machine = &march.test().activities[activity].machine;
    let mechanism = machine.mechanism;
    let columns = mechanism.columns.iter();
    let columns = columns.map(|&quantity| mechanism.column(quantity).to_owned());
    let ligaments = machine.ligaments.iter();
    let tensions = ligaments.map(|ligament| ligament.name.replace('-', "_") + "_n");
    let names = ["cycles", "percent"].map(str::to_owned).into_iter();
    let mut text = line(names.chain(columns).chain(tensions));
    let cycles = march.state().activities[activity].first_and_last.as_ref();
    for (cycles, row) in rows_of(cycles) {
        let values = mechanism.columns.iter();
        let values = values.map(|&quantity| mechanism.value(quantity, row));
        let cells = [cycles, row.percent].into_iter().chain(values);
        let tensions_n = march.ligament_tensions_n(activity, &row.positions);
        text += &line(cells.chain(tensions_n).map(|value| value.to_string()));
    }
    text
}

/// Returns `femur_pose.csv`: one row per increment of the cycles of `kinematics.csv`, the origin of the femoral frame
/// in the insert frame, then R row by row.
pub fn femur_pose_csv(march: &March, side: Side) -> String {
    let mut text = String::from(
        "cycles,percent,origin_x_mm,origin_y_mm,origin_z_mm,r_xx,r_xy,r_xz,r_yx,r_yy,r_yz,r_zx,r_zy,r_zz\n",
    );
    let cycles = march.state().activities[0].first_and_last.as_ref();
    for (cycles, row) in rows_of(cycles) {
        // A left knee is computed as a right one: its pose is mirrored back.
        let pose = pose_on_side(&march.pose_at(&row.positions), side);
        let rotation = rotation_rows(&pose);
        let numbers = pose.translation.iter().chain(rotation.as_flattened());
        let cells = [&cycles, &row.percent].into_iter().chain(numbers);
        text += &line(cells.map(f64::to_string));
    }
    text
}

/// Returns the rows of the first and the last cycle with the number of cycles before each; one
/// entry if both are the same.
fn rows_of(cycles: Option<&(CycleRecord, CycleRecord)>) -> impl Iterator<Item = (f64, &CycleRow)> {
    let both = cycles.into_iter().flat_map(|(first, last)| {
        let last = Some(last).filter(|last| last.cycles != first.cycles);
        [first].into_iter().chain(last)
    });
    both.flat_map(|record| record.rows.iter().map(|row| (record.cycles, row)))
}
