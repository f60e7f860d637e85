//! The paper's figures beside ours, as a table.

use serde::Serialize;

use super::findings::{Findings, OverUpdates, Scar};
use super::stamp::Stamp;

/// A line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PaperFigure {
    /// What is compared.
    pub what: &'static str,
    /// What the paper gives.
    pub paper: &'static str,
    /// What ours gives.
    pub ours: String,
    /// Whether ours lies where the paper's does; nothing where they cannot be compared.
    pub agrees: Option<bool>,
    /// Where ours differs and why, as far as we know.
    pub why: &'static str,
}

/// Seconds that the paper took.
const PAPER_S: f64 = 7200.0;

/// Every row, in the order of the paper's figures.
pub(super) fn rows(found: &Findings) -> Vec<PaperFigure> {
    vec![
        volume(found),
        pressure_and_area(found),
        depth(found),
        oscillation(found),
        kinematics(found),
        change_of_kinematics(found),
        linearity(found),
        control(found),
        scars(found),
        cost(found),
    ]
}

fn volume(found: &Findings) -> PaperFigure {
    let difference = found.volume_1_against_10_percent;
    PaperFigure {
        what: "volume against update interval",
        paper: "1 x 5M and 10 x 500k differ by less than 3 %",
        ours: format!(
            "force control {difference:+.1} %, displacement control {:+.1} %; force control over {}",
            found.volume_1_against_10_displacement_percent,
            over(&found.volume_loss_mm3, 1, "mm3"),
        ),
        agrees: Some(difference.abs() < 3.0),
        why: "In force control our motion changes as the insert wears, and the wear rate with it (see the \
              rows on IE and on linearity); one update never sees that. With the motion held, shape alone \
              changes the volume by little, as in the paper. Our implant is not the paper's.",
    }
}

fn pressure_and_area(found: &Findings) -> PaperFigure {
    let (pressure, area) = (
        found.pressure_5_against_40_percent,
        found.area_5_against_40_percent,
    );
    PaperFigure {
        what: "pressure, area",
        paper: "5 x 1M is within 0.5 % and 3 % of 40 x 125k",
        ours: format!("after 4 million cycles {pressure:+.1} % and {area:+.1} %"),
        agrees: Some(pressure.abs() <= 0.5 && area.abs() <= 3.0),
        why: "Held against each other in the last cycle that 5 x 1M solves; the highest pressure of the whole \
              test is that of the first cycle, the same in all. Peak pressure hangs on the shape at one \
              place, and the steps of a scar dug a million cycles at a time are such places.",
    }
}

fn depth(found: &Findings) -> PaperFigure {
    let difference = found.depth_40_against_10_percent;
    PaperFigure {
        what: "maximum depth, 500k to 125k",
        paper: "needs 500k; 125k changes it by less than 2.75 %",
        ours: format!(
            "{difference:+.2} %; over {}",
            over(&found.max_depth_mm, 3, "mm")
        ),
        agrees: Some(difference.abs() < 2.75),
        why: "At the end of the test. Early on, with few updates behind it, 10 x 500k is further off: see the \
              next row.",
    }
}

fn oscillation(found: &Findings) -> PaperFigure {
    let shown: Vec<String> = found
        .depth_excess
        .iter()
        .map(|excess| {
            let (low, high) = (excess.least_percent, excess.most_percent);
            match excess.updates {
                1 => format!("{high:+.0} % with 1"),
                updates => format!("{low:+.1} to {high:+.1} % with {updates}"),
            }
        })
        .collect();
    let coarse = found.depth_excess.iter().find(|excess| excess.updates == 5);
    PaperFigure {
        what: "oscillation of maximum depth",
        paper: "oscillates at intervals coarser than 500k",
        ours: format!(
            "above 40 x 125k at the same cycles, from 1 million on: {} updates",
            shown.join("; ")
        ),
        agrees: coarse.map(|excess| excess.least_percent < -1.0 && excess.most_percent > 1.0),
        why: "5 x 1M digs too deep in one interval and too little in the next. 10 x 500k starts too deep and \
              settles without oscillating.",
    }
}

fn kinematics(found: &Findings) -> PaperFigure {
    PaperFigure {
        what: "kinematics, force control against measured",
        paper: "mean absolute error 0.48 mm AP, 0.54 degrees IE; 0.9 mm too anterior near 70 %",
        ours: format!(
            "nothing to compare with; first cycle: AP range {:.2} mm, IE range {:.2} degrees",
            found.ap_range_mm, found.ie_range_deg
        ),
        agrees: None,
        why: "We have no measured motion of the paper's machine, and ours is another implant under loads that \
              are partly remembered.",
    }
}

fn change_of_kinematics(found: &Findings) -> PaperFigure {
    PaperFigure {
        what: "change of kinematics by 5 million",
        paper: "IE rotation falls by 1 to 2 degrees in stance",
        ours: format!(
            "falls by up to {:.2} degrees (at {:.0} %) and rises by up to {:.2} (at {:.0} %); range in stance \
             {:.2} before, {:.2} degrees after",
            found.ie_stance_largest_fall_deg,
            found.ie_stance_largest_fall_at_percent,
            found.ie_stance_largest_rise_deg,
            found.ie_stance_largest_rise_at_percent,
            found.ie_stance_range_first_deg,
            found.ie_stance_range_last_deg,
        ),
        agrees: Some(
            (1.0..=2.0).contains(&found.ie_stance_largest_fall_deg)
                && found.ie_stance_range_last_deg < found.ie_stance_range_first_deg,
        ),
        why: "The size is the paper's, but not the sense all through stance: our torque is remembered, its \
              direction is disputed between laboratories, and the generic dishes restrain rotation otherwise \
              than the paper's insert.",
    }
}

fn linearity(found: &Findings) -> PaperFigure {
    PaperFigure {
        what: "volume in cycles",
        paper: "linear",
        ours: format!(
            "R2 = {:.4}, {:.2} mm3 a million cycles; from the first tenth of the test to the last the rate grows \
             by {:.1} % in force control, {:.1} % in displacement control",
            found.volume_r_squared,
            found.volume_rate_mm3_per_million_cycles,
            found.rate_growth_force_percent,
            found.rate_growth_displacement_percent
        ),
        agrees: Some(found.volume_r_squared > 0.99),
        why: "A straight line explains it, but the rate is not constant: with the motion held it hardly \
              grows, so the growth comes from the motion.",
    }
}

fn control(found: &Findings) -> PaperFigure {
    let difference = found.mass_force_against_displacement_percent;
    PaperFigure {
        what: "wear, force against displacement control",
        paper: "displacement control between the two specimens; force control within 13 % of it",
        ours: format!(
            "{:.2} mg and {:.2} mg: force control {difference:+.1} %",
            found.mass_force_mg, found.mass_displacement_mg
        ),
        agrees: Some(difference.abs() <= 13.0),
        why: "Displacement control is driven by the first cycle of force control, so both begin at the same \
              rate and part as the motion changes. There are no specimens of our implant.",
    }
}

fn scars(found: &Findings) -> PaperFigure {
    let (medial, lateral) = (&found.medial, &found.lateral);
    PaperFigure {
        what: "scars",
        paper: "deep near the centre medially, large and shallow laterally",
        ours: format!("medial {}; lateral {}", scar(medial), scar(lateral)),
        agrees: Some(
            medial.max_depth_mm > lateral.max_depth_mm && lateral.area_mm2 > medial.area_mm2,
        ),
        why: "x is anterior, z lateral of the middle between the dishes, whose lowest points are at x = 0, \
              z = -23 and 23 mm; area is deeper than a twentieth of the deepest. Ours is deep medially near the \
              middle of the dish, shallower and longer but not larger laterally: the medial side carries about \
              three fifths of the load, and the two dishes of the generic insert are alike.",
    }
}

fn cost(found: &Findings) -> PaperFigure {
    PaperFigure {
        what: "cost of 10 x 500k",
        paper: "10 min a cycle, 2 h in all, one 3.0 GHz core",
        ours: format!(
            "{:.2} s for {:.1} cycles on one core: some {} times less",
            found.wall_s,
            found.cycles_solved,
            rounded(PAPER_S / found.wall_s)
        ),
        agrees: None,
        why: "A newer machine, and no finite elements: bodies are rigid on a foundation, steps are implicit, and \
              contact is not searched anew. Not a benchmark: other work may run beside it.",
    }
}

/// To two digits: a time is not known better.
fn rounded(value: f64) -> f64 {
    let unit = 10f64.powf(value.log10().floor() - 1.0);
    (value / unit).round() * unit
}

fn over(values: &[OverUpdates], decimals: usize, unit: &str) -> String {
    let updates: Vec<String> = values
        .iter()
        .map(|value| value.updates.to_string())
        .collect();
    let results: Vec<String> = values
        .iter()
        .map(|value| format!("{:.decimals$}", value.value))
        .collect();
    format!(
        "{} updates: {} {unit}",
        updates.join(", "),
        results.join(", ")
    )
}

fn scar(scar: &Scar) -> String {
    format!(
        "{:.3} mm deep at x {:.1}, z {:.1} mm, {:.0} mm2, {:.1} mm3",
        scar.max_depth_mm, scar.x_mm, scar.z_mm, scar.area_mm2, scar.volume_mm3
    )
}

/// The table in Markdown.
pub(super) fn markdown(rows: &[PaperFigure], stamp: &Stamp) -> String {
    let mut text = format!(
        "Made on {} from commit {}, condyle {}.\n\n\
         | | the paper | ours | agrees | where ours differs, and why |\n\
         | --- | --- | --- | --- | --- |\n",
        stamp.date,
        stamp.commit,
        env!("CARGO_PKG_VERSION")
    );
    for row in rows {
        let agrees = match row.agrees {
            Some(true) => "yes",
            Some(false) => "no",
            None => "-",
        };
        let PaperFigure {
            what,
            paper,
            ours,
            why,
            ..
        } = row;
        text += &format!("| {what} | {paper} | {ours} | {agrees} | {why} |\n");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_a_line_of_the_table() {
        let row = PaperFigure {
            what: "a",
            paper: "b",
            ours: "c".to_owned(),
            agrees: Some(false),
            why: "d",
        };
        let stamp = Stamp {
            commit: "abc".to_owned(),
            date: "2026-01-01".to_owned(),
        };
        let text = markdown(&[row], &stamp);
        assert!(text.starts_with("Made on 2026-01-01 from commit abc, condyle "));
        assert!(text.ends_with("| a | b | c | no | d |\n"));
    }
}
