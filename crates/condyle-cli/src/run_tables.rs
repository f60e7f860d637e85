//! Lines printed before the numbers of a run: the prediction, wear by every law, and each of several activities.

use condyle_results::{
    ActivitySummary, Interval, LawWear, Prediction, Summary,
    catalogue::{CYCLES, MASS_LOSS_MG, MAX_DEPTH_MM},
    with_digits,
};

use crate::output::Lines;

/// Adds what laboratories would find, and the sources of the width of the interval.
pub fn add_prediction(prediction: &Prediction, summary: &Summary, lines: &mut Lines) {
    let words = |value: f64, Interval { low, high, .. }: Interval, unit: &str| {
        let [value, low, high] = [value, low, high].map(two_digits);
        format!("{value} {unit}   (90 % of laboratories: {low} to {high} {unit})")
    };
    let (mass, depth) = (prediction.mass_loss_mg, prediction.max_depth_mm);
    let [own_mass, own_depth] = [&MASS_LOSS_MG, &MAX_DEPTH_MM].map(|number| summary[number]);
    let measured = prediction.measured.as_deref();
    let measured = measured.map_or_else(String::new, |measured| format!(", {measured}"));
    if prediction.is_of_run {
        let rate = two_digits(own_mass / summary[&CYCLES] * 1e6);
        let mass = words(own_mass, mass, "mg");
        lines.line(format_args!("mass loss    {mass}; {rate} mg/Mc{measured}"));
        lines.line(format_args!(
            "max depth    {}",
            words(own_depth, depth, "mm")
        ));
    } else {
        let (own_mass, own_depth) = (two_digits(own_mass), two_digits(own_depth));
        let mass_words = words(mass.median, mass, "mg");
        lines.line(format_args!("mass loss    {own_mass} mg by the law of this case; by the calibrated law {mass_words}{measured}"));
        let depth_words = words(depth.median, depth, "mm");
        lines.line(format_args!("max depth    {own_depth} mm by the law of this case; by the calibrated law {depth_words}"));
    }
    lines.line(format_args!(
        "interval from {}",
        prediction.sources_in_words('x')
    ));
    if summary.wear_laws.len() >= 2 {
        lines.line(
            "   the middle of the interval is the median over laboratories and all constants that fit measurements; the table has one set of constants for each law",
        );
    }
}

/// Returns a number with two significant digits: an interval of a factor has no more.
fn two_digits(value: f64) -> String {
    let magnitude = value.abs().max(f64::MIN_POSITIVE).log10().floor();
    let decimals = (1.0 - magnitude).clamp(0.0, 6.0) as usize;
    let step = 10_f64.powf(magnitude - 1.0);
    format!("{:.decimals$}", (value / step).round() * step)
}

/// Adds the table if there is more than one law, then the factor of a cross-linked insert.
pub fn add_laws(laws: &[LawWear], wear_over_conventional: Option<f64>, lines: &mut Lines) {
    if laws.len() >= 2 {
        lines
            .line("   wear by law, same cycles    mg/Mcycles        mg        mm   outside of fit");
        laws.iter().for_each(|law| lines.line(row_of_law(law)));
        if laws.iter().any(|law| law.approximate) {
            lines.line(
                "   ~ approximate: the formula or a constant is quoted from memory, not checked at the source",
            );
        }
    }
    if let Some(times) = wear_over_conventional {
        lines.line(format_args!(
            "   cross-linked polyethylene: the wear of every law times {times}, at any pressure and cross-shear"
        ));
    }
}

fn row_of_law(law: &LawWear) -> String {
    let mark = if law.approximate { '~' } else { ' ' };
    let name = if law.moved_the_surface {
        format!("{} (this run)", law.law)
    } else {
        law.law.clone()
    };
    let outside = law.outside_of_fit_percent;
    let outside = outside.map_or_else(
        || "range not known".to_owned(),
        |percent| format!("{percent:.0} % of volume"),
    );
    format!(
        "   {mark} {name:<25}{:>11} {:>9} {:>9}   {outside}",
        with_digits(law.mass_loss_mg_per_million_cycles, 2),
        with_digits(law.mass_loss_mg, 2),
        with_digits(law.max_depth_mm, 4)
    )
}

/// Adds the table; nothing for a case with one activity.
pub fn add_activities(activities: &[ActivitySummary], lines: &mut Lines) {
    if activities.is_empty() {
        return;
    }
    let is_knee = activities.iter().all(|activity| activity.knee.is_some());
    let (of_knee, motions) = match is_knee {
        true => ("   AP mm  IE deg", "AP, IE and N are"),
        false => ("", "N is"),
    };
    lines.line(format_args!(
        "   by activity          cycles %   wear mg    peak MPa     mm2       N{of_knee}"
    ));
    for activity in activities {
        let knee = activity.knee.as_ref();
        let of_knee =
            knee.map(|knee| format!(" {:>7.2} {:>7.2}", knee.ap_range_mm, knee.ie_range_deg));
        lines.line(format_args!(
            "   {:<20} {:>8} {:>9} {:>11.1} {:>7.0} {:>7.0}{}",
            activity.name,
            with_digits(100.0 * activity.share_of_cycles, 2),
            with_digits(activity.mass_loss_mg, 2),
            activity.peak_pressure_mpa,
            activity.peak_contact_area_mm2,
            activity.peak_axial_force_n,
            of_knee.unwrap_or_default()
        ));
    }
    lines.line(format_args!(
        "   wear is attributed to activities by pressure times sliding at each place; {motions} of first cycles"
    ));
}

#[cfg(test)]
mod tests {
    use condyle_results::KneeActivity;

    use super::*;

    fn law(law: &str, moved_the_surface: bool) -> LawWear {
        LawWear {
            law: law.to_owned(),
            moved_the_surface,
            approximate: !moved_the_surface,
            mass_loss_mg: 79.5,
            mass_loss_mg_per_million_cycles: 15.9,
            volume_loss_mm3: 85.5,
            max_depth_mm: 0.25,
            outside_of_fit_percent: (!moved_the_surface).then_some(12.4),
        }
    }

    #[test]
    fn columns_of_laws_stand_under_their_heads() {
        let mut lines = Lines::default();
        add_laws(
            &[law("archard", true), law("kang", false)],
            None,
            &mut lines,
        );
        let text = lines.text();
        let rows: Vec<&str> = text.lines().collect();
        assert_eq!(rows.len(), 4);
        let end = |row: usize, words: &str| rows[row].find(words).map(|at| at + words.len());
        for row in [1, 2] {
            assert_eq!(end(row, "15.90"), end(0, "mg/Mcycles"));
            assert_eq!(end(row, "79.50"), end(0, "        mg"));
            assert_eq!(end(row, "0.2500"), end(0, "mm   outside").map(|at| at - 10));
        }
        assert!(rows[1].contains("archard (this run)") && rows[1].ends_with("range not known"));
        assert!(rows[2].starts_with("   ~ kang") && rows[2].ends_with("12 % of volume"));
    }

    #[test]
    fn a_law_alone_needs_no_table() {
        let mut lines = Lines::default();
        add_laws(&[law("archard", true)], None, &mut lines);
        assert_eq!(lines.text(), "");
    }

    #[test]
    fn columns_of_activities_stand_under_their_heads() {
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
            knee: Some(KneeActivity {
                ap_range_mm: 7.25,
                ie_range_deg: 8.5,
                medial_load_share: 0.6,
            }),
        };
        let mut lines = Lines::default();
        add_activities(&[stairs], &mut lines);
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
