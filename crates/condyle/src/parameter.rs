//! Constants of a law, described so that a case file, a page or another program can offer them.

/// A constant of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name, which ends in its unit unless it is a pure number: `wear_factor_mm3_per_nm`.
    pub name: &'static str,
    /// A description in one sentence.
    pub about: &'static str,
    /// The value unless another is given.
    pub default: f64,
    /// The least value allowed ...
    pub least: f64,
    /// ... and the most; both limits included.
    pub most: f64,
    /// The source of the default: a key of `references.bib`, or `choice`.
    pub source: &'static str,
    /// The certainty of the default.
    pub known: Known,
}

/// The certainty of a constant or a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Read in its source.
    Read,
    /// Quoted from memory, not checked at the source: pages say *approximate*.
    Approximate,
    /// A choice of condyle's authors.
    Chosen,
}

impl Parameter {
    /// Returns whether `value` lies within the limits; NaN never does.
    pub fn allows(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}
