//! Constants of a law, described so that a case file, a page or another program can offer them.

/// A constant of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name, which ends in its unit unless it is a pure number: `wear_factor_mm3_per_nm`.
    pub name: &'static str,
    /// What it is, in one sentence.
    pub about: &'static str,
    /// What it is where nobody says otherwise.
    pub default: f64,
    /// The least it may be ...
    pub least: f64,
    /// ... and the most; both are allowed.
    pub most: f64,
    /// Where the default comes from: a key of `references.bib`, or `choice`.
    pub source: &'static str,
    /// How well the default is known.
    pub known: Known,
}

/// How well a constant or a formula is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Read in its source.
    Read,
    /// Remembered rather than read: pages say *approximate*.
    Approximate,
    /// A choice of condyle's authors.
    Chosen,
}

impl Parameter {
    /// Whether it may be `value`; NaN never.
    pub fn allows(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}
