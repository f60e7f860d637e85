//! The paper's figures next to ours, as a table.

use std::fmt;

use serde::Serialize;

use crate::findings::{Findings, Intervals, OverUpdates, Scar};

/// A line of the table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PaperFigure {
    /// The quantity.
    pub what: &'static str,
    /// The figure in the paper.
    pub paper: &'static str,
    /// Our figure.
    pub ours: String,
    /// The agreement of ours with the paper's.
    pub verdict: Verdict,
    /// The difference and its reason, as far as known.
    pub why: &'static str,
}

/// Seconds that the paper took.
const PAPER_S: f64 = 7200.0;

/// Growth of the wear rate over the test that the paper's straight lines could hide: its two
/// specimens and two models lie further apart, %.
const STRAIGHT_PERCENT: f64 = 5.0;
/// The paper's posterior shift in the experiment, and how far off its model of the motion is, mm.
const POSTERIOR_SHIFT_MM: [f64; 2] = [2.3, 0.48];
/// A scar that ends nearer than this to the edge, one and a half edges of an element, reaches it.
const AT_THE_EDGE_MM: f64 = 1.5;

/// Every row, in the order of the paper's figures.
pub(crate) fn rows(found: &Findings) -> Vec<PaperFigure> {
    vec![
        volume(found),
        pressure_and_area(found),
        depth(found),
        oscillation(found),
        kinematics(found),
        change_of_rotation(found),
        posterior_shift(found),
        linearity(found),
        control(found),
        specimens(found),
        depth_over_time(found),
        scars(found),
        lateral_scar(found),
        cost(found),
    ]
}

fn volume(found: &Findings) -> PaperFigure {
    let held = &found.displacement_intervals;
    let difference = held.volume_1_against_10_percent;
    PaperFigure {
        what: "volume against update interval",
        paper: "1 x 5M and 10 x 500k differ by less than 3 %, in displacement control",
        ours: format!(
            "{difference:+.1} %; over {}; in force control {:+.1} %",
            over(&held.volume_loss_mm3, 1, "mm3"),
            found.force_intervals.volume_1_against_10_percent,
        ),
        verdict: Verdict::of(difference.abs() < 3.0),
        why: "With prescribed motion the shape alone changes the volume little, as in the paper. In force control \
              the motion changes as the insert wears, and the wear rate with it, which a single update does not \
              see. The paper did not try its intervals there.",
    }
}

fn pressure_and_area(found: &Findings) -> PaperFigure {
    let held = &found.displacement_intervals;
    let (pressure, area) = (
        held.pressure_5_against_40_percent,
        held.area_5_against_40_percent,
    );
    PaperFigure {
        what: "pressure, area",
        paper: "5 x 1M is within 0.5 % and 3 % of 40 x 125k, in displacement control",
        ours: format!(
            "after 4 million cycles {pressure:+.1} % and {area:+.1} %; in force control {:+.1} % and {:+.1} %",
            found.force_intervals.pressure_5_against_40_percent,
            found.force_intervals.area_5_against_40_percent,
        ),
        verdict: Verdict::of(pressure.abs() <= 0.5 && area.abs() <= 3.0),
        why: "Compared in the last cycle that 5 x 1M solves; the highest pressure of the test is that of the first \
              cycle and equal in all. The peak pressure depends on the shape at one place, such as the steps of a \
              scar worn a million cycles at a time.",
    }
}

fn depth(found: &Findings) -> PaperFigure {
    let held = &found.displacement_intervals;
    let difference = held.depth_10_against_40_percent;
    PaperFigure {
        what: "maximum depth, 500k to 125k",
        paper: "needs 500k; 125k changes it by less than 2.75 %, in displacement control",
        ours: format!(
            "{difference:+.2} %; over {}; in force control {:+.2} %",
            over(&held.max_depth_mm, 3, "mm"),
            found.force_intervals.depth_10_against_40_percent,
        ),
        verdict: Verdict::of(difference.abs() < 2.75),
        why: "At the end of the test. Early, after few updates, 10 x 500k deviates more: see the next row.",
    }
}

fn oscillation(found: &Findings) -> PaperFigure {
    let held = &found.displacement_intervals;
    PaperFigure {
        what: "oscillation of maximum depth",
        paper: "oscillates at intervals coarser than 500k, in displacement control",
        ours: format!(
            "above 40 x 125k at the same cycles, from 1 million on: {}; in force control {}",
            excesses(held),
            excesses(&found.force_intervals)
        ),
        verdict: Verdict::of(oscillates(held)),
        why: "The rule: 5 x 1M is more than 1 % below the fine run at one time and more than 1 % above it at \
              another. A first-order march wears too deep in every interval; the paper attributes depths that are \
              at times too small to motion and pressure, which change with the shape.",
    }
}

/// True if five updates lie below and above the finest run by more than what the mesh blurs.
fn oscillates(intervals: &Intervals) -> bool {
    let mut coarse = intervals.depth_excess.iter();
    let five = coarse.find(|excess| excess.updates == 5);
    five.is_some_and(|excess| excess.least_percent < -1.0 && excess.most_percent > 1.0)
}

fn excesses(intervals: &Intervals) -> String {
    let shown = intervals.depth_excess.iter().map(|excess| {
        let (low, high) = (excess.least_percent, excess.most_percent);
        match excess.updates {
            1 => format!("{high:+.0} % with 1"),
            updates => format!("{low:+.1} to {high:+.1} % with {updates}"),
        }
    });
    let shown: Vec<String> = shown.collect();
    format!("{} updates", shown.join(", "))
}

fn kinematics(found: &Findings) -> PaperFigure {
    PaperFigure {
        what: "kinematics, force control against measured",
        paper: "mean absolute error 0.48 mm AP, 0.54 degrees IE; 0.9 mm too anterior near 70 %",
        ours: format!(
            "first cycle: AP range {:.2} mm, IE range {:.2} degrees",
            found.ap_range_mm, found.ie_range_deg
        ),
        verdict: Verdict::CannotBeJudged,
        why: "No measured motion of the paper's machine is available, and the implant and the loads (partly quoted \
              from memory) are others.",
    }
}

fn change_of_rotation(found: &Findings) -> PaperFigure {
    PaperFigure {
        what: "change of kinematics by 5 million",
        paper: "IE rotation falls by 1 to 2 degrees in stance, measured and in the model",
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
        verdict: Verdict::of(
            (1.0..=2.0).contains(&found.ie_stance_largest_fall_deg)
                && found.ie_stance_range_last_deg < found.ie_stance_range_first_deg,
        ),
        why: "The rule: it falls by as much as the paper's somewhere in stance, and its range becomes smaller. Our \
              torque is quoted from memory, its direction is disputed between laboratories, and the generic dishes \
              restrain rotation differently from the paper's insert.",
    }
}

fn posterior_shift(found: &Findings) -> PaperFigure {
    let shift = found.ap_posterior_shift_mm;
    let [measured, error] = POSTERIOR_SHIFT_MM;
    PaperFigure {
        what: "posterior shift by 5 million",
        paper: "the insert's AP shifts by some 2.3 mm posteriorly in the experiment; the paper's model does not show it",
        ours: format!("mean AP of the cycle shifts by {shift:+.2} mm, + posterior"),
        verdict: Verdict::of((shift - measured).abs() <= error),
        why: "Compared with the experiment, within the paper's mean error of AP. The paper attributes the shift to \
              effects that neither model has: creep, plasticity, and changing friction.",
    }
}

fn linearity(found: &Findings) -> PaperFigure {
    let (free, held) = (
        found.rate_growth_force_percent,
        found.rate_growth_displacement_percent,
    );
    PaperFigure {
        what: "volume in cycles",
        paper: "linear, measured and in both models",
        ours: format!(
            "from the first tenth of the test to the last the rate grows by {free:.1} % in force control, \
             {held:.1} % in displacement control; R2 = {:.4}, {:.2} mm3 a million cycles in force control",
            found.volume_r_squared, found.volume_rate_mm3_per_million_cycles,
        ),
        verdict: Verdict::of(free.abs() <= STRAIGHT_PERCENT && held.abs() <= STRAIGHT_PERCENT),
        why: "The rule: the rate changes by no more than 5 % in either control. R2 is near 1 for any steadily \
              rising curve and is no criterion. With prescribed motion the rate hardly grows, so the growth in \
              force control is due to the motion.",
    }
}

fn control(found: &Findings) -> PaperFigure {
    let difference = found.mass_force_against_displacement_percent;
    PaperFigure {
        what: "wear, force against displacement control",
        paper: "force control 13 % below displacement control, which is driven by measured motion",
        ours: format!(
            "{:.2} mg and {:.2} mg: force control {difference:+.1} %",
            found.mass_force_mg, found.mass_displacement_mg
        ),
        verdict: Verdict::CannotBeJudged,
        why: "Our displacement control follows the first cycle of our own force control: both begin at the same \
              rate and differ only as the motion changes. The paper's 13 % is the error of its motion, which this \
              comparison does not contain.",
    }
}

fn specimens(found: &Findings) -> PaperFigure {
    PaperFigure {
        what: "wear against the specimens",
        paper: "displacement control between the two specimens; force control some 6 % under the lower",
        ours: format!(
            "{:.2} mg in displacement control, {:.2} mg in force control",
            found.mass_displacement_mg, found.mass_force_mg
        ),
        verdict: Verdict::CannotBeJudged,
        why: "There are no specimens of our implant, and the paper prints no mass in numbers.",
    }
}

fn depth_over_time(found: &Findings) -> PaperFigure {
    PaperFigure {
        what: "maximum depth over time, force against displacement control",
        paper: "alike in trend and at the end; force control somewhat less deep in between",
        ours: format!(
            "force control {:+.1} to {:+.1} % before the end, {:+.1} % at the end",
            found.depth_force_least_against_displacement_percent,
            found.depth_force_most_against_displacement_percent,
            found.depth_force_against_displacement_percent,
        ),
        verdict: Verdict::CannotBeJudged,
        why: "As for the mass: our displacement control repeats the first cycle of force control.",
    }
}

fn scars(found: &Findings) -> PaperFigure {
    let (medial, lateral) = (&found.medial, &found.lateral);
    PaperFigure {
        what: "scars",
        paper: "deep near the centre medially, large and shallow laterally",
        ours: format!("medial {}; lateral {}", scar(medial), scar(lateral)),
        verdict: Verdict::of(
            medial.max_depth_mm > lateral.max_depth_mm && lateral.area_mm2 > medial.area_mm2,
        ),
        why: "x is anterior, z lateral of the middle between the dishes, whose lowest points are at x = 0, z = -23 \
              and 23 mm; the area is that deeper than a twentieth of the deepest wear. Ours is deep medially near \
              the middle of the dish, and shallower and longer but not larger laterally: the medial side carries \
              about three fifths of the load, and the two dishes of the generic insert are equal.",
    }
}

fn lateral_scar(found: &Findings) -> PaperFigure {
    let left = found.lateral.to_posterior_edge_mm;
    PaperFigure {
        what: "lateral scar to the posterior edge",
        paper: "reaches the posterior edge, measured and in force control",
        ours: format!("ends {left:.1} mm before it in force control"),
        verdict: Verdict::of(left <= AT_THE_EDGE_MM),
        why: "The scar is the surface deeper than a twentieth of the deepest wear. Our generic dishes rise behind \
              as in front; the shape of the paper's insert is not published.",
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
        verdict: Verdict::CannotBeJudged,
        why: "A newer processor and no finite elements: rigid bodies on a foundation, implicit steps, and a \
              contact search that reuses earlier results. Not a benchmark: other work may run at the same time.",
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
pub(crate) fn markdown(rows: &[PaperFigure], stamp: &Stamp) -> String {
    let mut text = format!(
        "Made on {} from commit {}, condyle {}.\n\n\
         | | the paper | ours | agrees | where ours differs, and why |\n\
         | --- | --- | --- | --- | --- |\n",
        stamp.date,
        stamp.commit,
        env!("CARGO_PKG_VERSION")
    );
    for row in rows {
        let PaperFigure {
            what,
            paper,
            ours,
            verdict,
            why,
        } = row;
        text += &format!("| {what} | {paper} | {ours} | {verdict} | {why} |\n");
    }
    text
}

/// The agreement of ours with the paper's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Within the rule.
    Agrees,
    /// Outside of the rule.
    Differs,
    /// The two are not comparable, or one is missing.
    CannotBeJudged,
}

impl Verdict {
    /// The verdict of a rule.
    pub(crate) fn of(agrees: bool) -> Self {
        if agrees { Self::Agrees } else { Self::Differs }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Agrees => "yes",
            Self::Differs => "no",
            Self::CannotBeJudged => "cannot be judged",
        })
    }
}

/// The commit and the date of the results.
#[derive(Clone, Debug, Serialize)]
pub struct Stamp {
    /// Commit of the source.
    pub commit: String,
    /// Date of the run.
    pub date: String,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::findings::Excess;

    #[test]
    fn a_row_is_a_line_of_the_table() {
        let row = PaperFigure {
            what: "a",
            paper: "b",
            ours: "c".to_owned(),
            verdict: Verdict::Differs,
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

    /// Findings that agree with the paper wherever that can be judged.
    fn agreeing() -> Findings {
        let five = Excess {
            updates: 5,
            least_percent: -2.0,
            most_percent: 3.0,
        };
        Findings {
            displacement_intervals: Intervals {
                depth_excess: vec![five],
                ..Intervals::default()
            },
            ap_posterior_shift_mm: 2.2,
            ie_stance_largest_fall_deg: 1.5,
            ie_stance_range_first_deg: 7.0,
            ie_stance_range_last_deg: 6.0,
            medial: Scar {
                max_depth_mm: 0.4,
                ..Scar::default()
            },
            lateral: Scar {
                area_mm2: 1.0,
                ..Scar::default()
            },
            ..Findings::default()
        }
    }

    /// The verdict of the row `what` once `change` is made to findings that agree.
    fn verdict(what: &str, change: impl Fn(&mut Findings)) -> Verdict {
        let mut found = agreeing();
        change(&mut found);
        let row = rows(&found).into_iter().find(|row| row.what == what);
        row.expect("there is such a row").verdict
    }

    /// A row, and what its rule must refuse.
    type Refused = (&'static str, fn(&mut Findings));

    #[test]
    fn every_rule_can_say_no_and_yes() {
        let refused: [Refused; 14] = [
            ("volume against update interval", |found| {
                found.displacement_intervals.volume_1_against_10_percent = -3.1;
            }),
            ("pressure, area", |found| {
                found.displacement_intervals.pressure_5_against_40_percent = 0.6;
            }),
            ("pressure, area", |found| {
                found.displacement_intervals.area_5_against_40_percent = -3.1;
            }),
            ("maximum depth, 500k to 125k", |found| {
                found.displacement_intervals.depth_10_against_40_percent = 2.8;
            }),
            ("oscillation of maximum depth", |found| {
                found.displacement_intervals.depth_excess[0].least_percent = -0.9;
            }),
            ("oscillation of maximum depth", |found| {
                found.displacement_intervals.depth_excess.clear();
            }),
            ("change of kinematics by 5 million", |found| {
                found.ie_stance_largest_fall_deg = 0.9;
            }),
            ("change of kinematics by 5 million", |found| {
                found.ie_stance_range_last_deg = 7.1;
            }),
            ("posterior shift by 5 million", |found| {
                found.ap_posterior_shift_mm = 0.0;
            }),
            ("volume in cycles", |found| {
                found.rate_growth_force_percent = 5.1;
            }),
            ("volume in cycles", |found| {
                found.rate_growth_displacement_percent = -5.1;
            }),
            ("scars", |found| found.medial.max_depth_mm = 0.0),
            ("scars", |found| found.medial.area_mm2 = 2.0),
            ("lateral scar to the posterior edge", |found| {
                found.lateral.to_posterior_edge_mm = 1.6;
            }),
        ];
        for (what, change) in refused {
            assert_eq!(verdict(what, |_| ()), Verdict::Agrees, "{what}");
            assert_eq!(verdict(what, change), Verdict::Differs, "{what}");
        }
    }

    #[test]
    fn intervals_are_judged_in_displacement_control_as_the_paper_did() {
        let what = "volume against update interval";
        let free = |found: &mut Findings| found.force_intervals.volume_1_against_10_percent = -9.8;
        assert_eq!(verdict(what, free), Verdict::Agrees);
    }

    #[test]
    fn what_is_driven_by_our_own_motion_is_not_judged() {
        for what in [
            "wear, force against displacement control",
            "wear against the specimens",
            "maximum depth over time, force against displacement control",
        ] {
            let near = |found: &mut Findings| found.mass_force_against_displacement_percent = -13.0;
            assert_eq!(verdict(what, near), Verdict::CannotBeJudged, "{what}");
        }
    }
}
