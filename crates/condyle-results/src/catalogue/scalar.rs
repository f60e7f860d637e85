//! A number of `summary.json`: its name, its definition, and the function that computes it.

use condyle::parameter::split_unit;

use condyle::machine::TestedJoint;

use super::finished::FinishedRun;
use crate::digits::with_digits;

/// The places that show a number in addition to `summary.json`, the report's list and the Python and TypeScript types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Prominence {
    /// None.
    Listed,
    /// The terminal.
    Printed,
    /// The terminal and, for a result that every run has, the tables of studies.
    Shown,
    /// These, and large type at the top of report and page.
    Headline,
}

/// The function that computes a number.
#[derive(Clone, Copy, Debug)]
enum Compute {
    /// For every run.
    Always(fn(&FinishedRun<'_>) -> f64),
    /// For some runs only.
    Sometimes(fn(&FinishedRun<'_>) -> Option<f64>),
}

/// The way in which the error of a number is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorMethod {
    /// A count, an input or a time: it has no discretisation error.
    Exact,
    /// It depends on the discretisation, but its error is not estimated.
    NotEstimated,
    /// Estimated by solving cycles again with finer increments, another mesh and another slip tolerance, and from the
    /// steps between updates: `error` in `summary.json` has the parts.
    Estimated,
}

impl ErrorMethod {
    /// The method in a sentence.
    pub fn description(self) -> &'static str {
        match self {
            Self::Exact => "Exact: a count, an input or a time.",
            Self::NotEstimated => "Not estimated.",
            Self::Estimated => {
                "Estimated from finer increments, a coarser mesh, another slip tolerance and the steps between updates; \
                 the parts are in `error` of summary.json."
            }
        }
    }
}

/// A number of `summary.json`.
///
/// It is declared once, by `scalars!` in one of the files of the catalogue.
#[derive(Clone, Copy, Debug)]
pub struct Scalar {
    /// Its key in `summary.json`, which ends in its unit.
    pub key: &'static str,
    /// Its name in words, lower case, without the unit.
    pub label: &'static str,
    /// Decimals in tables and on the terminal.
    pub decimals: usize,
    /// The places that show it.
    pub prominence: Prominence,
    /// The method that estimates its error.
    pub error: ErrorMethod,
    /// The only joints that have it; empty for all.
    pub joints: &'static [TestedJoint],
    /// True for a whole number.
    pub is_count: bool,
    /// True for a fraction, which is shown in %.
    pub is_share: bool,
    /// True if the terminal shows it on the line of the number before it.
    pub is_continued: bool,
    /// Key of the number of cycles before the cycle that it comes from.
    pub cycle_key: Option<&'static str>,
    about: &'static str,
    compute: Compute,
}

/// Two numbers are equal if their keys are.
impl PartialEq for Scalar {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Scalar {
    /// A real number that every run of every joint has, computed by `compute`.
    pub const fn new(
        key: &'static str,
        label: &'static str,
        decimals: usize,
        compute: fn(&FinishedRun<'_>) -> f64,
    ) -> Self {
        Self {
            key,
            label,
            decimals,
            prominence: Prominence::Shown,
            error: ErrorMethod::NotEstimated,
            joints: &[],
            is_count: false,
            is_share: false,
            is_continued: false,
            cycle_key: None,
            about: "",
            compute: Compute::Always(compute),
        }
    }

    /// A real number that some runs have: those for which `compute` finds one.
    pub const fn sometimes(
        key: &'static str,
        label: &'static str,
        decimals: usize,
        compute: fn(&FinishedRun<'_>) -> Option<f64>,
    ) -> Self {
        let mut scalar = Self::new(key, label, decimals, |_| f64::NAN);
        scalar.compute = Compute::Sometimes(compute);
        scalar
    }

    /// With a description in its first sentence, then its definition.
    pub const fn about(mut self, about: &'static str) -> Self {
        self.about = about;
        self
    }

    /// Shown in large type.
    pub const fn headline(mut self) -> Self {
        self.prominence = Prominence::Headline;
        self
    }

    /// Shown on the terminal, not in the tables of studies.
    pub const fn printed(mut self) -> Self {
        self.prominence = Prominence::Printed;
        self
    }

    /// Shown in lists of all numbers only.
    pub const fn listed(mut self) -> Self {
        self.prominence = Prominence::Listed;
        self
    }

    /// With an estimated discretisation error.
    pub const fn estimated(mut self) -> Self {
        self.error = ErrorMethod::Estimated;
        self
    }

    /// Without a discretisation error.
    pub const fn exact(mut self) -> Self {
        self.error = ErrorMethod::Exact;
        self
    }

    /// A whole number, which is exact.
    pub const fn count(mut self) -> Self {
        self.is_count = true;
        self.exact()
    }

    /// A part of one, shown in %.
    pub const fn share(mut self) -> Self {
        self.is_share = true;
        self
    }

    /// Shown by the terminal on the line of the number before it.
    pub const fn continued(mut self) -> Self {
        self.is_continued = true;
        self
    }

    /// Of the knee only.
    pub const fn of_knee(mut self) -> Self {
        self.joints = &[TestedJoint::Knee];
        self
    }

    /// Only hips have it.
    pub const fn of_hip(mut self) -> Self {
        self.joints = &[TestedJoint::Hip];
        self
    }

    /// Of one cycle; `key` is that of the number of cycles before it.
    pub const fn in_cycle(mut self, key: &'static str) -> Self {
        self.cycle_key = Some(key);
        self
    }

    /// Returns the value for a run; none for a run that does not have it, such as one of another joint.
    pub fn compute(&self, run: &FinishedRun<'_>) -> Option<f64> {
        match self.compute {
            _ if !self.applies_to(run.joint()) => None,
            Compute::Always(compute) => Some(compute(run)),
            Compute::Sometimes(compute) => compute(run),
        }
    }

    /// Returns whether every run has it.
    pub const fn is_always_there(&self) -> bool {
        matches!(self.compute, Compute::Always(_))
    }

    /// The key without its unit: `mass_loss`.
    pub fn stem(&self) -> &'static str {
        split_unit(self.key).0
    }

    /// The unit that the value is stored in, plain: `mm3`; empty for a pure number.
    pub fn unit(&self) -> &'static str {
        split_unit(self.key).1.unwrap_or_default()
    }

    /// The unit that the value is shown in, plain; see [`Self::shown`].
    pub fn shown_unit(&self) -> &'static str {
        if self.is_share { "%" } else { self.unit() }
    }

    /// The value in the unit in which it is shown.
    pub fn shown(&self, value: f64) -> f64 {
        if self.is_share { 100.0 * value } else { value }
    }

    /// The value as it is shown, without its unit; see [`with_digits`].
    pub fn text(&self, value: f64) -> String {
        with_digits(self.shown(value), self.decimals)
    }

    /// The name and the unit of the values of [`Self::text`]: `mass loss, mg`.
    pub fn title(&self) -> String {
        match self.shown_unit() {
            "" => self.label.to_owned(),
            unit => format!("{}, {unit}", self.label),
        }
    }

    /// Its doc comment: a description in one sentence, then the definition.
    pub fn documentation(&self) -> &'static str {
        self.about.trim()
    }

    /// A description in one sentence.
    pub fn description(&self) -> &'static str {
        self.sentences().0
    }

    /// The definition; empty if the description is enough.
    pub fn definition(&self) -> &'static str {
        self.sentences().1
    }

    fn sentences(&self) -> (&'static str, &'static str) {
        let about = self.about.trim();
        let end = about.find(". ").map_or(about.len(), |end| end + 1);
        (&about[..end], about[end..].trim_start())
    }

    /// Returns true if tests of the joint have it; `None` is a joint that is not in the list.
    pub fn applies_to(&self, joint: Option<TestedJoint>) -> bool {
        self.joints.is_empty() || joint.is_some_and(|joint| self.joints.contains(&joint))
    }
}

/// Numbers under one heading, in the order of `summary.json`.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// The heading in lists.
    pub heading: &'static str,
    /// The numbers.
    pub scalars: &'static [&'static Scalar],
}

/// Declares the numbers of a section; the doc comment of each is its description and its definition.
macro_rules! scalars {
    ($heading:literal; $($(#[doc = $about:literal])+ $name:ident = $scalar:expr;)+) => {
        $(
            $(#[doc = $about])+
            pub static $name: $crate::catalogue::Scalar = $scalar.about(concat!($($about),+));
        )+

        /// The section of this file.
        pub(super) const SECTION: $crate::catalogue::Section =
            $crate::catalogue::Section { heading: $heading, scalars: &[$(&$name),+] };
    };
}

/// Declares the files of sections, in the order of lists.
macro_rules! sections {
    ($($file:ident,)+) => {
        $(
            mod $file;
            pub use $file::*;
        )+

        /// Every number of `summary.json`, in sections.
        pub const SECTIONS: &[Section] = &[$( $file::SECTION, )+];
    };
}

pub(super) use {scalars, sections};
