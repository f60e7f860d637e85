//! Wear by every law, printed before the numbers of a run.

use condyle_results::LawWear;

use crate::output::Lines;

/// Adds the table if there is more than one law, then the factor of a cross-linked insert.
pub fn add(laws: &[LawWear], wear_over_conventional: Option<f64>, lines: &mut Lines) {
    if laws.len() >= 2 {
        add_table(laws, lines);
    }
    if let Some(times) = wear_over_conventional {
        lines.line(format_args!(
            "   cross-linked polyethylene: every law, fitted to conventional one, times {times}, whatever pressure and cross-shear"
        ));
    }
}

fn add_table(laws: &[LawWear], lines: &mut Lines) {
    lines.line("   wear by law, same cycles    mg/Mcycles        mg        mm   outside of fit");
    for law in laws {
        lines.line(row(law));
    }
    if laws.iter().any(|law| law.approximate) {
        lines.line(
            "   ~ approximate: the formula or a constant is remembered, not read in its source",
        );
    }
}

fn row(law: &LawWear) -> String {
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
        "   {mark} {name:<25}{:>11.2}{:>10.2}{:>10.4}   {outside}",
        law.mass_loss_mg_per_million_cycles, law.mass_loss_mg, law.max_depth_mm
    )
}

#[cfg(test)]
mod tests {
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
    fn columns_stand_under_their_heads() {
        let mut lines = Lines::default();
        add(
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
        add(&[law("archard", true)], None, &mut lines);
        assert_eq!(lines.text(), "");
    }
}
