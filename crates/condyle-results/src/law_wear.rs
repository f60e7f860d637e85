//! What every law of wear says of the same histories.

use condyle::evolve::March;
use serde::{Deserialize, Serialize};

/// What a law of wear says of a run: of the law that moved the surface what it wore, of every other what it
/// would have worn by the same histories.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawWear {
    /// The word for the law.
    pub law: String,
    /// Whether it moved the surface. It has the constants of the case; the others have their defaults.
    pub moved_the_surface: bool,
    /// Whether its formula or a constant is remembered rather than read.
    pub approximate: bool,
    /// Mass, mg.
    pub mass_loss_mg: f64,
    /// Mass in a million cycles, on the mean, mg.
    pub mass_loss_mg_per_million_cycles: f64,
    /// Volume, from depth times area, mm3.
    pub volume_loss_mm3: f64,
    /// Deepest wear, mm.
    pub max_depth_mm: f64,
    /// What of the volume is worn outside of the pressures and cross-shear that the law was fitted to, %; none
    /// where those are not known.
    pub outside_of_fit_percent: Option<f64>,
}

impl LawWear {
    /// The wear of a march by its law, called `word`, then by its comparison laws. `is_approximate` returns whether
    /// the law of a word was quoted from memory.
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

/// A part of a volume, %. Both are sums of steps, each extrapolated: a hair more than all is all.
fn percent_of(volume_mm3: f64, part_mm3: f64) -> f64 {
    (100.0 * part_mm3 / volume_mm3.max(f64::MIN_POSITIVE)).clamp(0.0, 100.0)
}
