//! Numbers as people read them.

/// Joins groups of three digits without a line break.
const THIN_SPACE: char = '\u{202f}';
/// A minus as wide as a plus.
const MINUS: char = '\u{2212}';

/// `value` with so many decimals, a true minus, and thin spaces in numbers of five digits or more.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let negative = value < 0.0 && text.bytes().any(|byte| (b'1'..=b'9').contains(&byte));
    let (whole, fraction) = text.split_at(text.find('.').unwrap_or(text.len()));
    let sign = if negative {
        String::from(MINUS)
    } else {
        String::new()
    };
    format!("{sign}{}{fraction}", grouped(whole))
}

/// `value` with so many significant digits, never in powers of ten.
pub(crate) fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return fixed(value, 0);
    }
    let magnitude = value.abs().log10().floor() as i32;
    fixed(value, (digits - 1 - magnitude).max(0) as usize)
}

/// A number of cycles in words: 5 million, 250 000, 1.
pub(crate) fn cycles(count: f64) -> String {
    if count >= 1e6 {
        return format!("{} million", shortest(count / 1e6));
    }
    fixed(count, 0)
}

/// At most three decimals, without trailing zeros.
pub(crate) fn shortest(value: f64) -> String {
    let text = fixed(value, 3);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn grouped(digits: &str) -> String {
    if digits.len() < 5 {
        return digits.to_owned();
    }
    let mut out = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            out.push(THIN_SPACE);
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped_and_minus_is_a_minus() {
        assert_eq!(fixed(-1_234_567.25, 1), "\u{2212}1\u{202f}234\u{202f}567.2");
        assert_eq!(fixed(2600.0, 0), "2600");
        assert_eq!(fixed(-0.001, 2), "0.00");
    }

    #[test]
    fn significant_digits_hold_for_small_and_large() {
        assert_eq!(significant(0.031_249, 3), "0.0312");
        assert_eq!(significant(24.0617, 4), "24.06");
        assert_eq!(significant(123_456.0, 3), "123\u{202f}456");
        assert_eq!(significant(0.0, 3), "0");
    }

    #[test]
    fn cycles_read_as_words() {
        assert_eq!(cycles(5e6), "5 million");
        assert_eq!(cycles(2.5e6), "2.5 million");
        assert_eq!(cycles(500_000.0), "500\u{202f}000");
    }
}
