//! The wear law.

use crate::keyed::{choice, settings, within};

choice! {
    /// Which wear law.
    WearLawWord {
        /// Depth per cycle = Kw sum of p |ds|.
        Archard = "archard",
    }
}

settings! {
    /// The wear law.
    Wear {
        /// Which law.
        law: WearLawWord = WearLawWord::Archard;
        /// Volume worn for each newton of load and metre of sliding.
        wear_factor_mm3_per_nm: f64 = 2.64e-7, in within(0.0, 1e-3);
    }
}
