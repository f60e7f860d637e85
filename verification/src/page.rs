//! The cases as a page of the book.

use crate::{CASES, Case, Row, number::rounded};

/// Digits of exact and computed values.
const VALUE_DIGITS: usize = 5;
/// Digits of errors, tolerances and orders.
const ERROR_DIGITS: usize = 2;
/// An error below this part of its tolerance is as good as none, and depends on the machine: it is
/// not printed, and the computed value is printed as the exact one.
const NEGLIGIBLE: f64 = 1e-2;

/// What stands for the table of a case whose data are not there; such a page is not for the book.
pub const WITHOUT_DATA: &str = "**fails**: its data are not there.";

pub(crate) const TOP: &str = "\
# Verification

Cases with a known solution, each computed by condyle and compared with the exact value. Errors are relative to the exact
value, in %, unless they have a unit. Where theory predicts the order at which an error falls with the mesh or the
increment, the observed order is checked too. Each case has a folder in `verification/`.

This page is written by `cargo run --release -p condyle-verification -- --page`, which fails if a row exceeds its
tolerance; `cargo test --release -p condyle-verification` checks all rows, and an argument such as `archard` selects
cases.
";

/// The page of the book, every case computed anew.
pub fn page() -> String {
    let mut page = TOP.to_owned();
    for case in CASES {
        page += &section(case, &(case.rows)());
    }
    page
}

/// What the page says of a case.
pub(crate) fn section(case: &Case, rows: &[Row]) -> String {
    let (title, introduction, name) = (case.title(), case.introduction(), case.name);
    let table = if rows.is_empty() {
        format!("{WITHOUT_DATA}\n")
    } else {
        table(rows)
    };
    format!("\n## {title}\n\n{introduction}\n\n`verification/{name}`\n\n{table}")
}

/// Rows as a Markdown table; a row that does not hold says so.
pub fn table(rows: &[Row]) -> String {
    let orders = rows.iter().any(|row| row.order.is_some());
    let mut table = "| quantity | exact | computed | error | at most |".to_owned();
    table += if orders { " order |\n" } else { "\n" };
    table += "| --- | --- | --- | --- | --- |";
    table += if orders { " --- |\n" } else { "\n" };
    for row in rows {
        table += &line(row, orders);
    }
    table
}

fn line(row: &Row, orders: bool) -> String {
    let value = |value| with_unit(&rounded(value, VALUE_DIGITS), row.unit);
    let mark = if row.holds() { "" } else { " **fails**" };
    let computed = if is_negligible(row) {
        row.exact
    } else {
        row.computed
    };
    let line = format!(
        "| {}{mark} | {} | {} | {} | {} |",
        row.quantity,
        value(row.exact),
        value(computed),
        error(row),
        tolerance(row, row.tolerance)
    );
    if orders {
        format!("{line} {} |\n", order(row))
    } else {
        format!("{line}\n")
    }
}

fn is_negligible(row: &Row) -> bool {
    row.error() < NEGLIGIBLE * row.tolerance
}

fn error(row: &Row) -> String {
    if is_negligible(row) {
        format!("< {}", tolerance(row, NEGLIGIBLE * row.tolerance))
    } else {
        tolerance(row, row.error())
    }
}

/// An error or a tolerance with its unit, % where it is a part of the exact value.
fn tolerance(row: &Row, value: f64) -> String {
    if row.is_relative() {
        with_unit(&rounded(100.0 * value, ERROR_DIGITS), "%")
    } else {
        with_unit(&rounded(value, ERROR_DIGITS), row.unit)
    }
}

fn order(row: &Row) -> String {
    row.order.map_or_else(String::new, |order| {
        let [observed, expected] =
            [order.observed, order.expected].map(|order| rounded(order, ERROR_DIGITS));
        format!("{observed} (theory {expected})")
    })
}

fn with_unit(number: &str, unit: &str) -> String {
    format!("{number} {unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_reads_as_its_rows_say() {
        let rows = [
            Row::relative("force", "N", 2000.0, 2001.0, 0.005).with_order(2.0, 1.9876, 0.2),
            Row::absolute("slip", "mm", 0.0, 1e-14, 1e-9),
        ];
        let expected = "\
| quantity | exact | computed | error | at most | order |
| --- | --- | --- | --- | --- | --- |
| force | 2000.0 N | 2001.0 N | 0.050 % | 0.50 % | 2.0 (theory 2.0) |
| slip | 0 mm | 0 mm | < 1.0e-11 mm | 1.0e-9 mm |  |
";
        assert_eq!(table(&rows), expected);
        let wrong = table(&[Row::relative("force", "N", 1.0, 2.0, 0.1)]);
        assert!(wrong.contains("force **fails**"), "{wrong}");
    }
}
