//! Motion, loads and wear of each of several activities.

use condyle_results::ActivitySummary;

use crate::output::Lines;

/// Adds the table; nothing for a case with one activity.
pub fn add(activities: &[ActivitySummary], lines: &mut Lines) {
    if activities.is_empty() {
        return;
    }
    lines.line(
        "   by activity          cycles %   wear mg    peak MPa     mm2       N   AP mm  IE deg",
    );
    for activity in activities {
        lines.line(row(activity));
    }
    lines.line("   wear is shared out by pressure times sliding at each place; AP, IE and N are of first cycles");
}

fn row(activity: &ActivitySummary) -> String {
    format!(
        "   {:<20} {:>8.2} {:>9.2} {:>11.1} {:>7.0} {:>7.0} {:>7.2} {:>7.2}",
        activity.name,
        100.0 * activity.share_of_cycles,
        activity.mass_loss_mg,
        activity.peak_pressure_mpa,
        activity.peak_contact_area_mm2,
        activity.peak_axial_force_n,
        activity.ap_range_mm,
        activity.ie_range_deg
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_stand_under_their_heads() {
        let stairs = ActivitySummary {
            name: "stairs".to_owned(),
            share_of_cycles: 0.15,
            kinematics_file: "kinematics_stairs.csv".to_owned(),
            mass_loss_mg: 12.34,
            volume_loss_mm3: 13.27,
            volume_loss_alone_mm3: 13.27,
            peak_pressure_mpa: 21.5,
            peak_contact_area_mm2: 310.4,
            peak_axial_force_n: 3391.2,
            ap_range_mm: 7.25,
            ie_range_deg: 8.5,
            medial_load_share: 0.6,
        };
        let mut lines = Lines::default();
        add(&[stairs], &mut lines);
        let rows: Vec<&str> = lines.text().lines().collect();
        let end = |row: usize, words: &str| rows[row].find(words).map(|at| at + words.len());
        let columns = [
            ("15.00", "cycles %"),
            ("12.34", "wear mg"),
            ("21.5", "peak MPa"),
        ];
        let more = [
            ("310", "mm2"),
            ("3391", " N"),
            ("7.25", "AP mm"),
            ("8.50", "IE deg"),
        ];
        for (value, head) in columns.into_iter().chain(more) {
            assert_eq!(end(1, value), end(0, head), "{head}");
        }
    }
}
