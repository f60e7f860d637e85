//! A number of `summary.json`, and how it is shown.

use condyle::parameter::split_unit;

/// A joint replacement whose tests condyle runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Joint {
    /// A total knee.
    Knee,
}

impl Joint {
    /// The joint's name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Knee => "knee",
        }
    }
}

/// Where a number is shown besides `summary.json`, the report's list and the Python and TypeScript types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Prominence {
    /// Nowhere else.
    Listed,
    /// On the terminal and, if every run has it, in the tables of studies.
    Shown,
    /// There, and in large type at the top of report and page.
    Headline,
}

/// How the error of a number is found.
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
    /// Its key in `summary.json`, which ends in its unit; a dot leads into a table.
    pub key: &'static str,
    /// Its name in words, lower case, without the unit.
    pub label: &'static str,
    /// Decimals in tables and on the terminal.
    pub decimals: usize,
    /// Where it is shown.
    pub prominence: Prominence,
    /// How its error is found.
    pub error: ErrorMethod,
    /// The only joints that have it; empty for all.
    pub joints: &'static [Joint],
    /// Whether it is a whole number.
    pub is_count: bool,
    /// Whether every run has it.
    pub is_always_there: bool,
    /// A part of one, shown in %.
    pub is_share: bool,
    /// Key of the number of cycles before the cycle that it comes from.
    pub cycle_key: Option<&'static str>,
    about: &'static str,
}

impl Scalar {
    /// A real number that every run of every joint has.
    pub const fn new(key: &'static str, label: &'static str, decimals: usize) -> Self {
        Self {
            key,
            label,
            decimals,
            prominence: Prominence::Shown,
            error: ErrorMethod::NotEstimated,
            joints: &[],
            is_count: false,
            is_always_there: true,
            is_share: false,
            cycle_key: None,
            about: "",
        }
    }

    /// With a description in its first sentence, then its definition.
    pub const fn about(self, about: &'static str) -> Self {
        Self { about, ..self }
    }

    /// Shown in large type.
    pub const fn headline(self) -> Self {
        Self {
            prominence: Prominence::Headline,
            ..self
        }
    }

    /// Shown in lists of all numbers only.
    pub const fn listed(self) -> Self {
        Self {
            prominence: Prominence::Listed,
            ..self
        }
    }

    /// With an estimated discretisation error.
    pub const fn estimated(self) -> Self {
        Self {
            error: ErrorMethod::Estimated,
            ..self
        }
    }

    /// Without a discretisation error.
    pub const fn exact(self) -> Self {
        Self {
            error: ErrorMethod::Exact,
            ..self
        }
    }

    /// A whole number, which is exact.
    pub const fn count(self) -> Self {
        Self {
            is_count: true,
            ..self.exact()
        }
    }

    /// Absent from some runs.
    pub const fn sometimes(self) -> Self {
        Self {
            is_always_there: false,
            ..self
        }
    }

    /// A part of one, shown in %.
    pub const fn share(self) -> Self {
        Self {
            is_share: true,
            ..self
        }
    }

    /// Of the knee alone.
    pub const fn of_knee(self) -> Self {
        Self {
            joints: &[Joint::Knee],
            ..self
        }
    }

    /// Found in the cycle that comes after so many others.
    pub const fn in_cycle(self, key: &'static str) -> Self {
        Self {
            cycle_key: Some(key),
            ..self
        }
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

    /// The value as it is shown, without its unit.
    pub fn text(&self, value: f64) -> String {
        format!("{:.*}", self.decimals, self.shown(value))
    }

    /// The name and the unit of the values of [`Self::text`]: `mass loss, mg`.
    pub fn title(&self) -> String {
        match self.shown_unit() {
            "" => self.label.to_owned(),
            unit => format!("{}, {unit}", self.label),
        }
    }

    /// What it is, in a sentence.
    pub fn description(&self) -> &'static str {
        self.sentences().0
    }

    /// Its definition: how exactly it is found, and from what; empty where the description is all.
    pub fn definition(&self) -> &'static str {
        self.sentences().1
    }

    fn sentences(&self) -> (&'static str, &'static str) {
        let about = self.about.trim();
        let end = about.find(". ").map_or(about.len(), |end| end + 1);
        (&about[..end], about[end..].trim_start())
    }

    /// Whether tests of this joint have it.
    pub fn applies_to(&self, joint: Joint) -> bool {
        self.joints.is_empty() || self.joints.contains(&joint)
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
        $( pub mod $file; )+

        /// Every number of `summary.json`, in sections.
        pub const SECTIONS: &[Section] = &[$( $file::SECTION, )+];
    };
}

pub(super) use {scalars, sections};
