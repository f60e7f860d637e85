//! The inputs of a study.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

use super::declared::{EmpiricalKeys, InputKeys, LevelKeys, TriangularKeys, Variation};
use crate::case::{Assignment, Case};
use crate::config::*;

/// Deviation from the mean, in standard deviations, up to which a case must accept a normal input: of a million
/// values 63 lie beyond.
const NORMAL_REACH: f64 = 4.0;

/// Power of the distance from the smallest value, in scales, up to which a case must accept a Weibull input: it is
/// exceeded as often as four standard deviations of a normal input, ln(2 / 63e-6).
const WEIBULL_REACH: f64 = 10.4;

/// Up to this many levels, all are tried on the case.
const FEW_LEVELS: usize = 64;

/// Largest number of inputs of a study, and of designs that it compares: the case is read once for each.
const MAX_LISTED: usize = 256;

/// One input of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Dotted path of its key.
    pub key: String,
    /// Its name in tables and pictures.
    pub name: String,
    /// The distribution of its values.
    pub variation: Variation,
    /// True if it scatters in a search for a robust optimum.
    pub is_disturbance: bool,
    /// True if its values are whole numbers.
    pub is_whole: bool,
    /// The keys that a value counts standard deviations of, perhaps none of a case; `None` where it is the value of
    /// `key` itself.
    pub scaled: Option<Vec<ScaledKey>>,
    pub(super) span: Range<usize>,
}

/// A key whose value an input moves by standard deviations.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledKey {
    /// Dotted path of the key.
    pub key: &'static str,
    /// Its value at no deviation.
    pub mean: f64,
    /// One standard deviation, in the unit of the key.
    pub standard_deviation: f64,
}

impl Input {
    /// Creates an input of real numbers without a study file.
    pub fn new(key: &str, variation: Variation) -> Self {
        Self {
            key: key.to_owned(),
            name: key.to_owned(),
            variation,
            is_disturbance: false,
            is_whole: false,
            scaled: None,
            span: 0..0,
        }
    }

    /// Reads one `[[vary]]` of a study of `case`.
    pub(super) fn read(section: &Section<'_>, case: &Case, log: &mut Log<'_>) -> Option<Self> {
        let keys = InputKeys::read(section, log);
        // Levels need no word for their distribution.
        let is_levels =
            section.value("levels").is_some() && section.value("distribution").is_none();
        let variation = if is_levels {
            section.check_keys(&["key", "name", "disturbance", "levels"], log);
            Variation::read_as("levels", section, log)
        } else {
            let items = [InputKeys::items(), Variation::items()].concat();
            check(section, &items, log);
            Variation::read(section, log)
        };
        let span = section.value_span("key");
        let keys = keys?;
        let key = case.path_of_key(&keys.key).unwrap_or(keys.key);
        let variation = variation?.completed(&key, case, section, log)?;
        Some(Self {
            name: if keys.name.is_empty() {
                key.clone()
            } else {
                keys.name
            },
            is_disturbance: keys.disturbance,
            is_whole: case.is_whole_number(&key),
            span,
            ..Self::new(&key, variation)
        })
    }

    /// Returns the changes of the case for a value; files are relative to `folder`, that of the study.
    pub fn assignments(&self, folder: &Path, level: &Level) -> Vec<Assignment> {
        let number = |number: f64| {
            // Whole numbers are written without a fraction, since a key that counts refuses one; beyond 1e15 not all are exact.
            if number.fract() == 0.0 && number.abs() < 1e15 {
                format!("{number:.0}")
            } else {
                format!("{number:?}")
            }
        };
        if let (Level::Number(deviations), Some(scaled)) = (level, &self.scaled) {
            let scaled = scaled.iter().map(|scaled| {
                let value = scaled.mean + scaled.standard_deviation * deviations;
                Assignment::new(scaled.key, format!("{:?}", rounded(value)))
            });
            return scaled.collect();
        }
        let value = match level {
            Level::Number(value) => number(*value),
            Level::Word(word) if self.is_file() => folder.join(word).display().to_string(),
            Level::Word(word) => word.clone(),
        };
        vec![Assignment::new(&self.key, value)]
    }

    pub(super) fn is_file(&self) -> bool {
        self.key.rsplit('.').next() == Some("file")
    }

    /// Returns the values that the case must accept to accept all: the ends of a distribution, or levels.
    pub(super) fn ends(&self) -> Vec<Level> {
        let (low, high) = match &self.variation {
            Variation::Normal(keys) => {
                let reach = NORMAL_REACH * keys.standard_deviation;
                let mean = keys.mean.unwrap_or_default();
                (mean - reach, mean + reach)
            }
            Variation::Lognormal(keys) => {
                let reach = keys.geometric_standard_deviation.powf(NORMAL_REACH);
                let median = keys.median.unwrap_or_default();
                (median / reach, median * reach)
            }
            Variation::Weibull(keys) => {
                let most = WEIBULL_REACH.powf(1.0 / keys.shape);
                (keys.low, keys.low + keys.scale * most)
            }
            Variation::Levels(keys) if keys.levels.0.len() <= FEW_LEVELS => {
                return keys.levels.0.clone();
            }
            Variation::Levels(keys) => return decisive(keys.levels.0.iter().cloned()),
            bounded => bounded.range().unwrap_or_default(),
        };
        [low, high].map(|end| self.level(end)).to_vec()
    }

    /// Converts a number to a value of this input.
    pub fn level(&self, number: f64) -> Level {
        Level::Number(if self.is_whole {
            number.round()
        } else {
            rounded(number)
        })
    }
}

/// Rounds a number to twelve digits, which removes the rounding errors of sums of decimal numbers.
fn rounded(number: f64) -> f64 {
    format!("{number:.11e}").parse().unwrap_or(number)
}

/// Returns the smallest and the largest number, and every word: if the case accepts these, it accepts all.
fn decisive(levels: impl Iterator<Item = Level>) -> Vec<Level> {
    // A range that the first number replaces.
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

impl Variation {
    /// Returns the least and the most of a bounded distribution.
    fn range(&self) -> Option<(f64, f64)> {
        match self {
            Self::Uniform(keys) => Some((keys.low, keys.high)),
            Self::TruncatedNormal(keys) => Some((keys.low, keys.high)),
            Self::Triangular(keys) => Some((keys.low, keys.high)),
            Self::Beta(keys) => Some((keys.low, keys.high)),
            Self::Empirical(keys) => {
                let values = keys.sorted();
                values.first().copied().zip(values.last().copied())
            }
            Self::Normal(_) | Self::Lognormal(_) | Self::Weibull(_) | Self::Levels(_) => None,
        }
    }

    /// Reports a median that is not positive.
    fn check_median(&self, section: &Section<'_>, log: &mut Log<'_>) -> Option<()> {
        if let Self::Lognormal(keys) = self
            && keys.median.is_some_and(|median| median <= 0.0)
        {
            let fault = Fault::new(
                "the median of a lognormal distribution is not above 0",
                "give a positive `median`, or use `distribution = \"normal\"`",
            );
            return log.reject(section.value_span("distribution"), fault);
        }
        Some(())
    }

    /// Takes the value of the case where the file gives no mean, mode or median, and measured values from their file;
    /// reports a case without a number, reversed ends, a mode outside of them, and a median that is not positive.
    fn completed(
        mut self,
        key: &str,
        case: &Case,
        section: &Section<'_>,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        if let Self::Empirical(keys) = &mut self {
            keys.read_file(key, section, log)?;
        }
        let middle = match &mut self {
            Self::Normal(keys) => Some(&mut keys.mean),
            Self::TruncatedNormal(keys) => Some(&mut keys.mean),
            Self::Triangular(keys) => Some(&mut keys.mode),
            Self::Lognormal(keys) => Some(&mut keys.median),
            Self::Uniform(_)
            | Self::Weibull(_)
            | Self::Beta(_)
            | Self::Empirical(_)
            | Self::Levels(_) => None,
        };
        if let Some(middle) = middle {
            *middle = middle.or_else(|| case.number_at_or_written(key));
            if middle.is_none() {
                let fault = Fault::new(
                    format!("the case has no number at `{key}` to start from"),
                    "give `mean`, `mode` or `median`, or write the key in the case",
                );
                return log.reject(section.value_span("key"), fault);
            }
        }
        self.check_median(section, log)?;
        let Some((low, high)) = self.range() else {
            return Some(self);
        };
        let fault = match &self {
            Self::Triangular(TriangularKeys {
                mode: Some(mode), ..
            }) if !(low..=high).contains(mode) => Fault::new(
                format!("the likeliest value {mode} is not between {low} and {high}"),
                "give `mode` between `low` and `high`",
            ),
            _ if low < high => return Some(self),
            _ => Fault::new(
                format!("the range from {low} to {high} is empty"),
                "write the smaller one as `low`",
            ),
        };
        log.reject(section.value_span("high"), fault)
    }
}

/// Returns the numbers among levels in ascending order.
pub(super) fn sorted_numbers(levels: &Levels) -> Vec<f64> {
    let mut sorted: Vec<f64> = levels.0.iter().filter_map(Level::number).collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

impl EmpiricalKeys {
    /// Returns the values in ascending order.
    pub fn sorted(&self) -> Vec<f64> {
        sorted_numbers(&self.values)
    }

    /// Replaces the file by its values; reports words, and fewer than two different values.
    fn read_file(&mut self, key: &str, section: &Section<'_>, log: &mut Log<'_>) -> Option<()> {
        let mut span = section.value_span("values");
        if let Some(file) = self.file.take() {
            span = section.value_span("file");
            let source = file.source(section, "file", log)?;
            let (names, mut rows) = log.noted(&source, split(source.inner()))?;
            // A file of values alone has no name above them.
            if let [only] = &names[..]
                && let first @ Level::Number(_) = level(only.clone())
            {
                rows.insert(0, vec![first]);
            }
            let own = names.iter().position(|name| name == key);
            let Some(column) = own.or((names.len() == 1).then_some(0)) else {
                let message = format!("the file has several columns, and none is named `{key}`");
                let advice =
                    format!("name the column of the values `{key}`, and write decimal points");
                return log.reject(span, Fault::new(message, advice));
            };
            let values = rows.into_iter().map(|mut row| row.swap_remove(column));
            self.values = Levels(values.collect());
        }
        let sorted = self.sorted();
        let is_constant = sorted.first() == sorted.last();
        if is_constant || sorted.len() < self.values.0.len() {
            let fault = Fault::new(
                "measured values must be numbers, at least two of them different",
                "give `file` or `values = [0.03, 0.04, 0.06]`",
            );
            return log.reject(span, fault);
        }
        Some(())
    }
}

pub(super) fn check_count(
    what: &'static str,
    count: usize,
    span: Range<usize>,
    log: &mut Log<'_>,
) -> Option<()> {
    if count <= MAX_LISTED {
        return Some(());
    }
    let message = format!("the study has {count} {what}; at most {MAX_LISTED} are allowed");
    log.reject(span, Fault::new(message, "divide it into several studies"))
}

/// The values of each test.
type Rows = Vec<Vec<Level>>;

/// Reads the inputs and the values of each test from the CSV file that `section` names.
pub(super) fn read_rows(
    section: &Section<'_>,
    file: &DataFile,
    case: &Case,
    log: &mut Log<'_>,
) -> Option<(Vec<Input>, Rows)> {
    let source = file.source(section, "file", log)?;
    let (keys, rows) = log.noted(&source, split(source.inner()))?;
    let span = section.value_span("file");
    check_count("inputs", keys.len(), span.clone(), log)?;
    let input = |(place, key): (usize, &String)| {
        let levels = decisive(rows.iter().map(|row: &Vec<Level>| row[place].clone()));
        let levels = Levels(levels);
        let path = case.path_of_key(key);
        let path = path.as_ref().unwrap_or(key);
        Input {
            name: key.clone(),
            is_whole: case.is_whole_number(path),
            span: span.clone(),
            ..Input::new(path, Variation::Levels(LevelKeys { levels }))
        }
    };
    let inputs = keys.iter().enumerate().map(input).collect();
    Some((inputs, rows))
}

/// Returns the separator of columns beside which commas are decimal ones; also for one column without decimal points.
fn separator(text: &str) -> Option<char> {
    let unmarked = text.trim_start_matches('\u{feff}');
    let mut lines = unmarked
        .lines()
        .filter(|line| !line.trim_start().starts_with('#'));
    let head = lines.next().unwrap_or_default();
    // Tabs beside commas only align the columns.
    let is_written = |one: &char| head.contains(*one) && (*one == ';' || !head.contains(','));
    let written = [';', '\t'].into_iter().find(is_written);
    let mut is_column = || !head.contains(',') && !lines.any(|line| line.contains('.'));
    written.or_else(|| is_column().then_some(';'))
}

fn level(cell: String) -> Level {
    match cell.parse::<f64>() {
        Ok(number) if number.is_finite() => Level::Number(number),
        Ok(_) | Err(_) => Level::Word(cell),
    }
}

/// Reads keys and rows of values from a CSV text, or reports every row that does not fit.
fn split(text: &str) -> Result<(Vec<String>, Rows), Vec<Placed>> {
    let text = &plain_csv(text, separator(text));
    let no_rows = || {
        let advice = "write keys of the case in its first line, such as `contact.friction,insert.thickness_mm`, and values below";
        Fault::new("the file has no rows", advice)
    };
    let is_comment = |line: &Range<usize>| text[line.clone()].trim_start().starts_with('#');
    let mut lines = lines(text).filter(|line| !is_comment(line));
    let Some(head) = lines.next() else {
        return Err(vec![(0..0, no_rows())]);
    };
    let cells = |line: &Range<usize>| -> Vec<String> {
        let cells = cells(text, line).into_iter();
        cells.map(|cell| text[cell].to_owned()).collect()
    };
    let keys = cells(&head);
    let (mut rows, mut wrong) = (Vec::new(), Vec::new());
    for line in lines {
        let row = cells(&line);
        if row.len() == keys.len() && row.iter().all(|cell| !cell.is_empty()) {
            rows.push(row.into_iter().map(level).collect());
        } else {
            let message = format!(
                "this row has {} cells where the first line has {}, or an empty one",
                row.len(),
                keys.len()
            );
            wrong.push((
                line,
                Fault::new(message, "give every row one value a column"),
            ));
        }
    }
    if rows.is_empty() && wrong.is_empty() {
        wrong.push((head, no_rows()));
    }
    if wrong.is_empty() {
        Ok((keys, rows))
    } else {
        Err(wrong)
    }
}
