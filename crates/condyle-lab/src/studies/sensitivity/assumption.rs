//! What a case assumes, and what could be assumed instead.

use condyle_io::case::{Assignment, Case};
use condyle_io::config::unit_of;

/// Something that a case assumes, and what is tried in its place.
struct Assumption {
    /// What a reader calls it.
    name: &'static str,
    /// Its keys, of which a case may have some.
    keys: &'static [&'static str],
    tried: Tried,
}

/// What is tried in place of a value.
enum Tried {
    /// The value times each of these.
    Times(&'static [f64]),
    /// The value and each of these.
    Plus(&'static [f64]),
    /// Each of these, as a case has them.
    Instead(&'static [&'static str]),
}

use Tried::{Instead, Plus, Times};

const DAMPING: &[&str] = &[
    "machine.freedoms.ap.damping_n_s_per_mm",
    "machine.freedoms.ml.damping_n_s_per_mm",
    "machine.freedoms.is.damping_n_s_per_mm",
    "machine.freedoms.ie.damping_nm_s_per_rad",
    "machine.freedoms.vv.damping_nm_s_per_rad",
    "machine.freedoms.flexion.damping_nm_s_per_rad",
];

const INERTIA: &[&str] = &[
    "machine.freedoms.ap.inertia_kg",
    "machine.freedoms.ml.inertia_kg",
    "machine.freedoms.is.inertia_kg",
    "machine.freedoms.ie.inertia_kg_m2",
    "machine.freedoms.vv.inertia_kg_m2",
    "machine.freedoms.flexion.inertia_kg_m2",
];

/// Damping and inertia of every freedom.
const DYNAMICS: &[&str] = &[
    DAMPING[0], DAMPING[1], DAMPING[2], DAMPING[3], DAMPING[4], DAMPING[5], INERTIA[0], INERTIA[1],
    INERTIA[2], INERTIA[3], INERTIA[4], INERTIA[5],
];

const SPRINGS: &[&str] = &[
    "machine.springs.posterior_n_per_mm",
    "machine.springs.anterior_n_per_mm",
];

/// Everything that a case assumes and that its results may hang on.
const ASSUMPTIONS: &[Assumption] = &[
    Assumption {
        name: "friction",
        keys: &["contact.friction"],
        tried: Times(&[0.5, 2.0]),
    },
    Assumption {
        name: "damping",
        keys: DAMPING,
        tried: Times(&[0.0, 0.5, 2.0]),
    },
    Assumption {
        name: "inertia",
        keys: INERTIA,
        tried: Times(&[0.5, 2.0]),
    },
    Assumption {
        name: "damping and inertia",
        keys: DYNAMICS,
        tried: Times(&[0.0]),
    },
    Assumption {
        name: "springs",
        keys: SPRINGS,
        tried: Times(&[0.0]),
    },
    Assumption {
        name: "stiffness of springs",
        keys: &["machine.springs.stiffness_of"],
        tried: Instead(&["pair", "each"]),
    },
    Assumption {
        name: "free play of springs",
        keys: &["machine.springs.free_play_mm"],
        tried: Plus(&[-1.0, 1.0]),
    },
    Assumption {
        name: "offset of springs",
        keys: &["machine.springs.lateral_offset_mm"],
        tried: Plus(&[-4.0, 4.0]),
    },
    Assumption {
        name: "sign of AP force",
        keys: &["machine.ap_force_sign"],
        tried: Times(&[-1.0]),
    },
    Assumption {
        name: "sign of IE torque",
        keys: &["machine.ie_torque_sign"],
        tried: Times(&[-1.0]),
    },
    Assumption {
        name: "curve of axial force",
        keys: &["machine.axial_force"],
        tried: Instead(&[
            "{ waveform = \"iso-like\" }",
            "{ waveform = \"paper-like\" }",
        ]),
    },
    Assumption {
        name: "varus-valgus axis, medial",
        keys: &["machine.vv_axis_medial_mm"],
        tried: Plus(&[-2.0, 2.0]),
    },
    Assumption {
        name: "Young's modulus",
        keys: &["material.youngs_modulus_mpa"],
        tried: Times(&[0.75, 1.5]),
    },
    Assumption {
        name: "Poisson's ratio",
        keys: &["material.poissons_ratio"],
        tried: Plus(&[-0.02, 0.02]),
    },
    Assumption {
        name: "thickness",
        keys: &["insert.thickness_mm"],
        tried: Plus(&[-1.0, 1.0]),
    },
    Assumption {
        name: "pressure law",
        keys: &["contact.law"],
        tried: Instead(&["linear", "logarithmic", "softening"]),
    },
];

/// One assumption of a case changed.
#[derive(Clone, Debug)]
pub struct Change {
    /// What is changed, in words.
    pub assumption: &'static str,
    /// How, in words: `x 0.5`, `+1 mm`, `each`.
    pub change: String,
    /// The keys with their other values.
    pub assignments: Vec<Assignment>,
}

/// Every change of `case`, in the order of the table; none that leaves all its keys as they are.
pub(super) fn changes_of(case: &Case) -> Vec<Change> {
    let all = ASSUMPTIONS.iter().flat_map(|one| one.changes(case));
    all.filter(|change| !change.assignments.is_empty())
        .collect()
}

impl Assumption {
    fn changes(&self, case: &Case) -> Vec<Change> {
        let by_number = |factor: f64, term: f64, change: String| Change {
            assumption: self.name,
            change,
            assignments: self.numbers(case, |value| factor * value + term),
        };
        match self.tried {
            Times(factors) => {
                let times = |factor: &f64| by_number(*factor, 0.0, in_words(*factor));
                factors.iter().map(times).collect()
            }
            Plus(terms) => {
                let plus = |term: &f64| by_number(1.0, *term, self.step(*term));
                terms.iter().map(plus).collect()
            }
            Instead(texts) => texts.iter().map(|text| self.instead(case, text)).collect(),
        }
    }

    /// A step with its unit, such as `+1 mm`.
    fn step(&self, term: f64) -> String {
        let unit = self.keys.first().and_then(|key| unit_of(key));
        unit.map_or_else(|| format!("{term:+}"), |unit| format!("{term:+} {unit}"))
    }

    /// The keys that are numbers of the case, where `other` changes them.
    fn numbers(&self, case: &Case, other: impl Fn(f64) -> f64) -> Vec<Assignment> {
        let changed = self.keys.iter().filter_map(|key| {
            let value = case.number_at(key)?;
            // Sums of decimal numbers end in ones nobody wrote.
            let other = (other(value) * 1e9).round() / 1e9;
            (other != value).then(|| assignment(key, &format!("{other}")))
        });
        changed.collect()
    }

    fn instead(&self, case: &Case, text: &str) -> Change {
        let is_there = |key: &&&str| case.has(key) && case.word_at(key).as_deref() != Some(text);
        let keys = self.keys.iter().filter(is_there);
        Change {
            assumption: self.name,
            change: named(text).to_owned(),
            assignments: keys.map(|key| assignment(key, text)).collect(),
        }
    }
}

fn in_words(factor: f64) -> String {
    match factor {
        0.0 => "none".to_owned(),
        -1.0 => "turned round".to_owned(),
        factor => format!("x {factor}"),
    }
}

/// The word inside a table of one key.
fn named(text: &str) -> &str {
    text.split('"').nth(1).unwrap_or(text)
}

fn assignment(key: &str, text: &str) -> Assignment {
    Assignment::parse(&format!("{key}={text}")).expect("a key and a value")
}
