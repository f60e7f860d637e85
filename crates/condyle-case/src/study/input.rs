//! One input of a study.

use std::collections::BTreeSet;
use std::ops::Range;

use super::declared::{InputKeys, Variation};
use super::reason::StudyReason;
use crate::case::Case;
use crate::config::{Level, Log, Section, Settings, check};

/// So many standard deviations from its mean, a normal input must still be allowed: of a million values 63 lie beyond.
const NORMAL_REACH: f64 = 4.0;

/// So many levels are all tried.
const FEW: usize = 64;

/// One input of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Dotted path of its key.
    pub key: String,
    /// What it is called.
    pub name: String,
    /// How it varies.
    pub variation: Variation,
    /// Whether it counts something: values are then rounded.
    pub is_whole: bool,
    pub(super) span: Range<usize>,
}

impl Input {
    /// Reads one `[[vary]]` of a study of `case`.
    pub(super) fn read(section: &Section<'_>, case: &Case, log: &mut Log<'_>) -> Option<Self> {
        let keys = InputKeys::read(section, log);
        let variation = variation(section, log);
        let span = section.value_span("key");
        let mut keys = keys?;
        keys.key = case.path_of_key(&keys.key).unwrap_or(keys.key);
        let variation = filled(variation?, &keys.key, case, &span, log)?;
        check_order(&variation, section, log)?;
        Some(Self {
            name: if keys.name.is_empty() {
                keys.key.clone()
            } else {
                keys.name
            },
            is_whole: case.is_whole_number(&keys.key),
            key: keys.key,
            variation,
            span,
        })
    }

    /// One whose values are given row by row.
    pub(super) fn of_rows(
        key: &str,
        column: impl Iterator<Item = Level>,
        span: Range<usize>,
        case: &Case,
    ) -> Self {
        use super::declared::LevelKeys;
        use crate::config::Levels;
        let levels = Levels(telling(column));
        Self {
            key: key.to_owned(),
            name: key.to_owned(),
            variation: Variation::Levels(LevelKeys { levels }),
            is_whole: case.is_whole_number(key),
            span,
        }
    }

    /// Whether its values are names of files.
    pub fn is_file(&self) -> bool {
        self.key.rsplit('.').next() == Some("file")
    }

    /// Whether it takes any number of a range, rather than one of a few values.
    pub fn is_continuous(&self) -> bool {
        !matches!(self.variation, Variation::Levels(_))
    }

    /// Values that the case must take if it is to take all: the ends of a distribution, or its levels, of many those that tell of all.
    pub(super) fn ends(&self) -> Vec<Level> {
        let numbers = |ends: [f64; 2]| ends.map(|end| self.level(end)).to_vec();
        match &self.variation {
            Variation::Uniform(keys) => numbers([keys.low, keys.high]),
            Variation::Normal(keys) => {
                let reach = NORMAL_REACH * keys.standard_deviation;
                let mean = keys.mean.unwrap_or_default();
                numbers([mean - reach, mean + reach])
            }
            Variation::TruncatedNormal(keys) => numbers([keys.low, keys.high]),
            Variation::Triangular(keys) => numbers([keys.low, keys.high]),
            Variation::Levels(keys) if keys.levels.0.len() <= FEW => keys.levels.0.clone(),
            Variation::Levels(keys) => telling(keys.levels.0.iter().cloned()),
        }
    }

    /// A number as this input takes it, to twelve digits: sums of decimal numbers end in ones that nobody wrote.
    pub fn level(&self, number: f64) -> Level {
        if self.is_whole {
            return Level::Number(number.round());
        }
        Level::Number(format!("{number:.11e}").parse().unwrap_or(number))
    }
}

/// The least and the most of numbers, and every word.
fn telling(levels: impl Iterator<Item = Level>) -> Vec<Level> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let (mut words, mut seen) = (Vec::new(), BTreeSet::new());
    for level in levels {
        match level {
            Level::Number(number) => (low, high) = (low.min(number), high.max(number)),
            Level::Word(word) => {
                if seen.insert(word.clone()) {
                    words.push(Level::Word(word));
                }
            }
        }
    }
    if low <= high {
        words.extend([Level::Number(low), Level::Number(high)]);
    }
    words
}

/// How an input varies; levels need no word for that.
fn variation(section: &Section<'_>, log: &mut Log<'_>) -> Option<Variation> {
    let is_levels = section.value("levels").is_some() && section.value("distribution").is_none();
    if is_levels {
        section.check_keys(&["key", "name", "levels"], log);
        return Variation::read_as("levels", section, log);
    }
    check(
        section,
        &[InputKeys::items(), Variation::items()].concat(),
        log,
    );
    Variation::read(section, log)
}

/// With the value of the case where the file gives no mean.
fn filled(
    mut variation: Variation,
    key: &str,
    case: &Case,
    span: &Range<usize>,
    log: &mut Log<'_>,
) -> Option<Variation> {
    let middle = match &mut variation {
        Variation::Normal(keys) => &mut keys.mean,
        Variation::TruncatedNormal(keys) => &mut keys.mean,
        Variation::Triangular(keys) => &mut keys.mode,
        Variation::Uniform(_) | Variation::Levels(_) => return Some(variation),
    };
    *middle = middle.or_else(|| case.number_at_or_written(key));
    if middle.is_none() {
        let key = key.to_owned();
        log.problem(span.clone(), StudyReason::NoMiddle { key });
        return None;
    }
    Some(variation)
}

/// Reports ends that are the wrong way round, and a likeliest value outside of them.
fn check_order(variation: &Variation, section: &Section<'_>, log: &mut Log<'_>) -> Option<()> {
    let (low, high, mode) = match variation {
        Variation::Uniform(keys) => (keys.low, keys.high, None),
        Variation::TruncatedNormal(keys) => (keys.low, keys.high, None),
        Variation::Triangular(keys) => (keys.low, keys.high, keys.mode),
        Variation::Normal(_) | Variation::Levels(_) => return Some(()),
    };
    let is_inside = mode.is_none_or(|mode| (low..=high).contains(&mode));
    if low < high && is_inside {
        return Some(());
    }
    let reason = match mode.filter(|_| !is_inside) {
        Some(mode) => StudyReason::ModeOutside { mode, low, high },
        None => StudyReason::EmptyRange { low, high },
    };
    log.problem(section.value_span("high"), reason);
    None
}
