//! Springs that stand for the ligaments.

/// A spring along the AP axis with free play, fixed to the insert at a lateral offset.
///
/// It slackens zero_vector inside the free play and is linear beyond it, with one stiffness against
/// posterior and another against anterior motion of the insert.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ApSpring {
    /// Where it holds the insert, mm along z from the IE axis; + is lateral.
    pub lateral_offset_mm: f64,
    /// Stiffness against posterior motion of the insert, N/mm.
    pub posterior_n_per_mm: f64,
    /// Stiffness against anterior motion of the insert, N/mm.
    pub anterior_n_per_mm: f64,
    /// Motion each way before it engages, mm.
    pub free_play_mm: f64,
}

impl ApSpring {
    /// Force on the insert (N, + anterior) and its derivative (N/mm) when the point where the
    /// spring holds it has moved `ap_mm` from neutral.
    pub fn force(&self, ap_mm: f64) -> (f64, f64) {
        if ap_mm > self.free_play_mm {
            let k = self.anterior_n_per_mm;
            (-k * (ap_mm - self.free_play_mm), -k)
        } else if ap_mm < -self.free_play_mm {
            let k = self.posterior_n_per_mm;
            (-k * (ap_mm + self.free_play_mm), -k)
        } else {
            (0.0, 0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_free_play_then_linear() {
        let spring = ApSpring {
            lateral_offset_mm: 28.0,
            posterior_n_per_mm: 33.8,
            anterior_n_per_mm: 7.24,
            free_play_mm: 2.5,
        };
        assert_eq!(spring.force(2.5), (0.0, 0.0));
        assert_eq!(spring.force(-2.5), (0.0, 0.0));
        assert!((spring.force(3.5).0 + 7.24).abs() < 1e-12);
        assert!((spring.force(-4.5).0 - 67.6).abs() < 1e-12);
    }
}
