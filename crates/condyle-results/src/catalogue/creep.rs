//! Penetration of an insert that creeps, and its separation from wear as in laboratories.

use condyle::evolve::{CreepRecord, UpdateRecord};

use super::finished::FinishedRun;
use super::{Scalar, scalar::scalars};

/// Number of cycles after which laboratories attribute all further penetration to wear.
const MILLION: f64 = 1e6;

scalars! { "Creep";
    /// Deepest penetration. Wear and creep together. All numbers of creep are approximate: the constants of the laws are quoted from memory.
    MAX_PENETRATION_MM = Scalar::sometimes("max_penetration_mm", "deepest penetration", 4, |run| Some(run.last.creep?.max_penetration_mm));

    /// Wear at the deepest penetration.
    WEAR_AT_MAX_PENETRATION_MM = Scalar::sometimes("wear_at_max_penetration_mm", "wear there", 4, |run| Some(run.last.creep?.wear_there_mm))
        .continued();

    /// Creep at the deepest penetration.
    CREEP_AT_MAX_PENETRATION_MM = Scalar::sometimes("creep_at_max_penetration_mm", "creep there (approximate)", 4, |run| Some(run.last.creep?.creep_there_mm))
        .continued();

    /// Deepest creep.
    MAX_CREEP_MM = Scalar::sometimes("max_creep_mm", "deepest creep", 4, |run| Some(run.last.creep?.max_depth_mm))
        .listed();

    /// Volume of creep. It is not lost.
    CREEP_VOLUME_MM3 = Scalar::sometimes("creep_volume_mm3", "volume of creep", 2, |run| Some(run.last.creep?.volume_mm3));

    /// Deepest place of a scan without load. Wear, and the creep that is left after a long rest.
    MAX_UNLOADED_DEPTH_MM = Scalar::sometimes("max_unloaded_depth_mm", "deepest place unloaded", 4, |run| Some(run.last.creep?.max_unloaded_depth_mm));

    /// Deepest penetration after a million cycles. Linear between updates.
    MILLION_PENETRATION_MM = Scalar::sometimes("million_penetration_mm", "deepest at a million cycles", 4, |run| after_a_million(run, |creep| creep.max_penetration_mm));

    /// Wear at the deepest penetration after a million cycles.
    MILLION_WEAR_MM = Scalar::sometimes("million_wear_mm", "wear there", 4, |run| after_a_million(run, |creep| creep.wear_there_mm))
        .continued();

    /// Creep at the deepest penetration after a million cycles.
    MILLION_CREEP_MM = Scalar::sometimes("million_creep_mm", "creep there", 4, |run| after_a_million(run, |creep| creep.creep_there_mm))
        .continued();

    /// Rise of the deepest place of scans without load. The slope of a line through the updates from a million cycles on, which laboratories take for wear.
    SCAN_RISE_MM_PER_MILLION_CYCLES = Scalar::sometimes("scan_rise_mm_per_million_cycles", "rise of unloaded scans", 4, |run| Some(line_of_scans(&run.state().updates)?[1]));

    /// Deepest place of unloaded scans, extrapolated to no cycles. By the same line; laboratories take it for creep and bedding in.
    SCAN_AT_NO_CYCLES_MM = Scalar::sometimes("scan_at_no_cycles_mm", "at no cycles", 4, |run| Some(line_of_scans(&run.state().updates)?[0]))
        .continued();
}

fn after_a_million(run: &FinishedRun<'_>, value: fn(&CreepRecord) -> f64) -> Option<f64> {
    creep_at(&run.state().updates, MILLION, value)
}

/// Returns a value of creep after a number of cycles, linear between updates; none for a shorter test.
fn creep_at(
    updates: &[UpdateRecord],
    cycles: f64,
    value: fn(&CreepRecord) -> f64,
) -> Option<f64> {
    let after = updates.iter().position(|update| update.cycles >= cycles)?;
    let before = after.checked_sub(1).map(|before| &updates[before]);
    // Before the first update there is no creep.
    let (began, from) = match before {
        Some(update) => (update.cycles, value(update.creep.as_ref()?)),
        None => (0.0, 0.0),
    };
    let part = (cycles - began) / (updates[after].cycles - began);
    Some(from + part * (value(updates[after].creep.as_ref()?) - from))
}

/// Returns the least-squares line through the unloaded scans from a million cycles on: its value at no cycles, mm, and its slope, mm in a
/// million cycles; none of fewer than two scans.
fn line_of_scans(updates: &[UpdateRecord]) -> Option<[f64; 2]> {
    let scan = |update: &UpdateRecord| {
        Some((update.cycles / MILLION, update.creep?.max_unloaded_depth_mm))
    };
    let scans = updates.iter().filter(|update| update.cycles >= MILLION);
    let scans: Vec<(f64, f64)> = scans.filter_map(scan).collect();
    let mean = |values: &dyn Fn(&(f64, f64)) -> f64| {
        scans.iter().map(values).sum::<f64>() / scans.len() as f64
    };
    let (cycles, depth) = (mean(&|scan| scan.0), mean(&|scan| scan.1));
    let spread = mean(&|scan| (scan.0 - cycles).powi(2));
    // Scans at one number of cycles have no slope.
    if scans.len() < 2 || spread == 0.0 {
        return None;
    }
    let slope = mean(&|scan| (scan.0 - cycles) * (scan.1 - depth)) / spread;
    Some([depth - slope * cycles, slope])
}

#[cfg(test)]
mod tests {
    use condyle::evolve::CyclePeaks;

    use super::*;

    fn update(cycles: f64, penetration_mm: f64, wear_mm: f64, unloaded_mm: f64) -> UpdateRecord {
        let creep = CreepRecord {
            volume_mm3: 0.0,
            max_depth_mm: 0.0,
            max_penetration_mm: penetration_mm,
            wear_there_mm: wear_mm,
            creep_there_mm: penetration_mm - wear_mm,
            max_unloaded_depth_mm: unloaded_mm,
        };
        UpdateRecord {
            cycles,
            volume_loss_mm3: 0.0,
            volume_loss_mesh_mm3: 0.0,
            mass_loss_mg: 0.0,
            max_depth_mm: wear_mm,
            peaks: CyclePeaks {
                peak_pressure_mpa: 0.0,
                contact_area_mm2: 0.0,
                under_surface: None,
            },
            worst_quality: 1.0,
            creep: Some(creep),
        }
    }

    #[test]
    fn verify_a_million_lies_between_updates() {
        let updates = [
            update(8e5, 0.10, 0.02, 0.06),
            update(1.2e6, 0.14, 0.03, 0.08),
        ];
        let penetration = |creep: &CreepRecord| creep.max_penetration_mm;
        let found = |value| creep_at(&updates, 1e6, value).expect("it is reached");
        assert!((found(penetration) - 0.12).abs() < 1e-12);
        assert!((found(|creep| creep.wear_there_mm) - 0.025).abs() < 1e-12);
        assert!((found(|creep| creep.creep_there_mm) - 0.095).abs() < 1e-12);
        assert_eq!(creep_at(&updates[..1], 1e6, penetration), None);
        let first = creep_at(&updates[1..], 1e6, penetration).expect("it is reached");
        assert!((first - 0.14 / 1.2).abs() < 1e-12);
    }

    #[test]
    fn verify_a_straight_rise_is_met_by_the_line() {
        let scans = [1e6, 2e6, 4e6].map(|cycles| update(cycles, 0.0, 0.0, 0.05 + 2e-8 * cycles));
        let [at_no_cycles_mm, rise_mm] = line_of_scans(&scans).expect("three are enough");
        assert!((rise_mm - 0.02).abs() < 1e-12 && (at_no_cycles_mm - 0.05).abs() < 1e-12);
        assert_eq!(line_of_scans(&scans[..1]), None);
    }
}
