//! What a mesh file does not say of itself.

use crate::config::choice;

choice! {
    /// Unit of length of a mesh file.
    LengthUnit {
        /// Millimetre.
        Millimetre = "mm",
        /// Centimetre.
        Centimetre = "cm",
        /// Metre.
        Metre = "m",
        /// Inch.
        Inch = "in",
    }
}

impl LengthUnit {
    /// How many mm it has.
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
        }
    }
}
