//! Numbers to read.

/// Powers of ten that are written out rather than as e4.
const PLAIN: std::ops::Range<i32> = -3..6;

/// A number with `digits` significant digits.
pub fn rounded(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value:.0}");
    }
    let scientific = format!("{value:.*e}", digits - 1);
    let power = scientific
        .split('e')
        .nth(1)
        .and_then(|power| power.parse::<i32>().ok());
    match power {
        Some(power) if PLAIN.contains(&power) => {
            let decimals = (digits as i32 - 1 - power).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_significant_ones() {
        let written = [2000.0, 99.996, 0.012_345, -1.0, 0.0, 3.2e-9, 12_345_678.0];
        let read = written.map(|value| rounded(value, 4));
        let expected = [
            "2000", "100.0", "0.01235", "-1.000", "0", "3.200e-9", "1.235e7",
        ];
        assert_eq!(read, expected);
    }
}
