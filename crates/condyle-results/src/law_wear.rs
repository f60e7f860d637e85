//! Wear by every law for the same histories.

use condyle::evolve::March;
use serde::{Deserialize, Serialize};

/// Wear by one law: the wear of the run for the law that moved the surface, and the wear predicted for the same
/// histories for every other law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawWear {
    /// The word for the law.
    pub law: String,
    /// True of the law that moved the surface, with the constants of the case; the others have their defaults.
    pub moved_the_surface: bool,
    /// True if its formula or a constant was quoted from memory.
    pub approximate: bool,
    /// Mass, mg.
    pub mass_loss_mg: f64,
    /// Mean mass in a million cycles, mg.
    pub mass_loss_mg_per_million_cycles: f64,
    /// Volume, from depth times area, mm3.
    pub volume_loss_mm3: f64,
    /// Deepest wear, mm.
    pub max_depth_mm: f64,
    /// Part of the volume worn at pressures and cross-shear outside the range that the law was fitted to, %; none if
    /// the range is not known.
    pub outside_of_fit_percent: Option<f64>,
}

impl LawWear {
    /// Returns the wear of a march by its law, called `word`, then by its comparison laws. `is_approximate` returns
    /// whether the law of a word was quoted from memory.
    pub fn of(march: &March, word: &str, is_approximate: impl Fn(&str) -> bool) -> Vec<Self> {
        let state = march.state();
        let Some(last) = state.updates.last() else {
            return Vec::new();
        };
        let density = march.test().density_mg_per_mm3;
        let law = |word: &str, volume_mm3: f64, depth_mm, outside_mm3: Option<f64>| Self {
            law: word.to_owned(),
            moved_the_surface: false,
            approximate: is_approximate(word),
            mass_loss_mg: density * volume_mm3,
            mass_loss_mg_per_million_cycles: density * volume_mm3 / last.cycles * 1e6,
            volume_loss_mm3: volume_mm3,
            max_depth_mm: depth_mm,
            outside_of_fit_percent: outside_mm3.map(|outside| percent_of(volume_mm3, outside)),
        };
        let chosen = Self {
            moved_the_surface: true,
            ..law(
                word,
                last.volume_loss_mm3,
                last.max_depth_mm,
                state.outside_mm3,
            )
        };
        let beside = state.comparison_laws.iter();
        let beside = beside.map(|beside| {
            let (volume_mm3, depth_mm) = (beside.volume_mm3, beside.max_depth_mm());
            law(&beside.word, volume_mm3, depth_mm, beside.outside_mm3)
        });
        std::iter::once(chosen).chain(beside).collect()
    }
}

/// Returns a part of a volume, %. Both volumes are sums of extrapolated steps; a result slightly above 100 % by
/// rounding counts as 100 %.
fn percent_of(volume_mm3: f64, part_mm3: f64) -> f64 {
    (100.0 * part_mm3 / volume_mm3.max(f64::MIN_POSITIVE)).clamp(0.0, 100.0)
}
