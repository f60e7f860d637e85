//! Numbers as text.

/// Size below which a number is the rounding of a sum that should be zero.
const NOISE: f64 = 1e-9;

/// Largest part of a number that rounding may change.
const MOST_LOST: f64 = 0.1;

/// Formats a number with `least` decimals, or with two significant digits where these change it by more than a tenth: a small
/// value or error is not zero. Noise below 1e-9 is.
pub fn with_digits(value: f64, least: usize) -> String {
    let value = if value.abs() < NOISE { 0.0 } else { value };
    let text = format!("{value:.least$}");
    let lost = text.parse().map_or(0.0, |shown: f64| (shown - value).abs());
    if lost > MOST_LOST * value.abs() {
        let decimals = (1.0 - value.abs().log10().floor()) as usize;
        return format!("{value:.decimals$}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_numbers_are_not_zero_and_noise_is() {
        for (value, least, text) in [
            (0.004_56, 2, "0.0046"),
            (-0.0123, 1, "-0.012"),
            (10.909, 2, "10.91"),
            (-1e-14, 2, "0.00"),
            (4.0, 0, "4"),
            (4.3, 0, "4"),
            (0.0503, 2, "0.05"),
            (1.4, 0, "1.4"),
            (f64::NAN, 1, "NaN"),
        ] {
            assert_eq!(with_digits(value, least), text);
        }
    }
}
