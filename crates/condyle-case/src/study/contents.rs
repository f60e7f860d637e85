//! The contents of a study.

use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::answers::Answers;
use super::declared::{AdaptiveKeys, Design, MorrisKeys, OptimiseKeys, SampleKeys, Variation};
use super::input::Input;
use super::outputs::Outputs;
use crate::case::{Assignment, Case, CaseReader, ChangeError};
use crate::config::*;
use condyle_results::catalogue::Scalar;

/// A study as its file describes it, checked, with every default filled in.
#[derive(Clone, Debug)]
pub struct Study {
    /// Heading of the page; may be empty.
    pub title: String,
    /// The case file.
    pub case_path: PathBuf,
    /// The case without changes.
    pub case: Case,
    /// The choice of the tests.
    pub design: Design,
    /// The varied inputs, in the order of the file.
    pub inputs: Vec<Input>,
    /// Correlated inputs.
    pub correlations: Vec<Correlation>,
    /// Designs that are compared; none for the case alone.
    pub alternatives: Vec<Alternative>,
    /// The outputs of every test.
    pub outputs: Outputs,
    /// The questions.
    pub answers: Answers,
    /// For tests given row by row, the values of each test in the order of the inputs.
    pub rows: Vec<Vec<Level>>,
    /// The text of the file.
    pub text: String,
    pub(super) folder: PathBuf,
    pub(super) cases: CaseReader,
}

/// The value of `minimise` for a search with two objectives.
pub(super) const PARETO: &str = "pareto";

/// One of several designs, each tested under the same disturbances.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// Its name.
    pub name: String,
    /// Its changes of the case.
    pub set: Vec<Assignment>,
    pub(super) span: Range<usize>,
}

impl Alternative {
    /// Creates a design without a file.
    pub fn new(name: String, set: Vec<Assignment>) -> Self {
        let span = 0..0;
        Self { name, set, span }
    }
}

/// Two correlated inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correlation {
    /// Their places among the inputs.
    pub inputs: [usize; 2],
    /// Correlation of their normal scores.
    pub coefficient: f64,
}

impl Study {
    /// Creates a study of the case at `case_path` without a study file and without varied inputs.
    ///
    /// # Errors
    /// The problems of the case.
    pub fn of_case(case_path: &Path, design: Design) -> Result<Self, Problems> {
        let cases = CaseReader::default();
        let own = Outputs::default();
        let outputs: Vec<_> = own.all().collect();
        Ok(Self {
            title: String::new(),
            case_path: case_path.to_path_buf(),
            case: cases.read(case_path)?,
            design,
            inputs: Vec::new(),
            correlations: Vec::new(),
            alternatives: Vec::new(),
            outputs: own,
            answers: Answers {
                rank_by: outputs[0],
                outputs,
                pareto: None,
                names_pareto: false,
                bounds: Vec::new(),
            },
            rows: Vec::new(),
            text: String::new(),
            folder: PathBuf::new(),
            cases,
        })
    }

    /// Returns the outputs that a search minimises: one, or the two of the Pareto front; none for other studies.
    pub fn objectives(&self) -> Vec<&'static Scalar> {
        let Design::Optimise(keys) = &self.design else {
            return Vec::new();
        };
        let both = self.answers.pareto.filter(|_| keys.minimise == PARETO);
        both.map_or_else(
            || self.outputs.get(&keys.minimise).into_iter().collect(),
            |both| both.to_vec(),
        )
    }

    /// Returns what an adaptive study is to know; none for other designs.
    pub fn aim(&self) -> Option<Aim> {
        match &self.design {
            Design::Adaptive(keys) => keys.aim(&self.outputs),
            _ => None,
        }
    }

    /// Returns the number of inputs that a search chooses; the others, which follow them, are disturbances.
    pub fn chosen(&self) -> usize {
        let chosen = self.inputs.iter().filter(|input| !input.is_disturbance);
        chosen.count()
    }

    /// Returns whether some inputs are disturbances, under which a search judges its designs.
    pub fn is_robust(&self) -> bool {
        self.chosen() < self.inputs.len()
    }

    /// Returns the changes of the case in one test: those of the design, then the inputs'. An input without a value
    /// sets nothing.
    pub fn assignments(&self, alternative: usize, values: &[Option<Level>]) -> Vec<Assignment> {
        let of_design = self.alternatives.get(alternative);
        let design = of_design.into_iter().flat_map(|design| design.set.clone());
        let inputs = self.inputs.iter().zip(values);
        let set = |(input, value): (&Input, &Option<Level>)| {
            let value = value.as_ref();
            value.map_or_else(Vec::new, |value| input.assignments(&self.folder, value))
        };
        design.chain(inputs.flat_map(set)).collect()
    }

    /// Returns the case with some of its values changed.
    ///
    /// # Errors
    /// As [`CaseReader::read_changed`].
    pub fn changed_case(&self, changes: &[Assignment]) -> Result<Case, ChangeError> {
        self.cases.read_changed(&self.case_path, changes)
    }

    /// Returns the value of an input in the case without changes; none if the case leaves it out.
    pub fn value_of_case(&self, input: &Input) -> Option<Level> {
        let number = self.case.number_at_or_written(&input.key);
        let number = number.map(Level::Number);
        number.or_else(|| self.case.word_at(&input.key).map(Level::Word))
    }

    /// Hash of the case, its meshes, the variations and the design, in hexadecimal.
    ///
    /// The questions and the places of files do not count, and the number of tests does not where more tests begin with
    /// the same ones; for a search the minimised output and the limits do, since its
    /// tests depend on them.
    ///
    /// # Errors
    /// A file that can no longer be read.
    pub fn inputs_blake3(&self) -> io::Result<String> {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.case.inputs_blake3()?.as_bytes());
        hasher.update(self.in_words().as_bytes());
        for file in self.files() {
            let bytes = self.cases.files.read(&file)?;
            hasher.update(blake3::hash(&bytes).as_bytes());
        }
        Ok(hasher.finalize().to_hex().to_string())
    }

    /// Files that its levels name, sorted by their paths.
    fn files(&self) -> Vec<PathBuf> {
        let mut files = Vec::new();
        for (place, input) in self.inputs.iter().enumerate() {
            if !input.is_file() {
                continue;
            }
            let levels: &[Level] = match &input.variation {
                Variation::Levels(keys) => &keys.levels.0,
                _ => &[],
            };
            for level in levels.iter().chain(self.rows.iter().map(|row| &row[place])) {
                if let Level::Word(written) = level {
                    files.push(self.folder.join(written));
                }
            }
        }
        files.sort();
        files.dedup();
        files
    }

    /// Returns what is tested, each with its keys as a study file has them: the case, the choice of the tests, the designs and the
    /// inputs, and the formulas of outputs.
    pub fn described(&self) -> Vec<(String, String)> {
        let case = self.case_path.file_name().unwrap_or_default();
        let rows = [
            ("case".to_owned(), case.to_string_lossy().into_owned()),
            ("tests".to_owned(), keys(|out| self.design.write(out))),
        ];
        let designs = self.alternatives.iter().map(|design| {
            let set: Vec<String> = design.set.iter().map(Assignment::to_string).collect();
            let set = if set.is_empty() {
                "as the case".to_owned()
            } else {
                set.join(", ")
            };
            (format!("design {}", design.name), set)
        });
        let inputs = self.inputs.iter().map(|input| {
            let disturbance = if input.is_disturbance {
                ", disturbance"
            } else {
                ""
            };
            (
                input.key.clone(),
                keys(|out| input.variation.write(out)) + disturbance,
            )
        });
        let formulas = self.outputs.formulas();
        let formulas = formulas.map(|(key, formula)| (format!("output {key}"), formula.to_owned()));
        rows.into_iter()
            .chain(designs)
            .chain(inputs)
            .chain(formulas)
            .collect()
    }

    fn in_words(&self) -> String {
        let mut out = Writer::default();
        for input in &self.inputs {
            out.line(&input.key, "");
            input.variation.write(&mut out);
            for scaled in input.scaled.iter().flatten() {
                out.line(&format!("{scaled:?}"), "");
            }
        }
        match self.design.growing() {
            Design::Rows(_) => out.line(&format!("{:?}", self.rows), ""),
            Design::Optimise(keys) => {
                keys.write(&mut out);
                out.line(
                    &format!(
                        "{:?}",
                        self.objectives()
                            .iter()
                            .map(|one| one.key)
                            .collect::<Vec<_>>()
                    ),
                    "",
                );
                // Stored tests of another method must not be taken for those of this one.
                out.line("method", "emulators");
                let bounds = self.answers.bounds.iter();
                let bound = bounds.map(|bound| (bound.output.key, bound.least, bound.most));
                out.line(&format!("{:?}", bound.collect::<Vec<_>>()), "");
                if self.is_robust() {
                    let kept = self.answers.bounds.iter().map(|bound| bound.probability);
                    let kept: Vec<f64> = kept.collect();
                    out.line(&format!("chosen {}, {kept:?}", self.chosen()), "");
                }
            }
            design => {
                design.write(&mut out);
                if matches!(design, Design::LatinHypercube(_)) {
                    // Stored tests of another hypercube must not be taken for those of this one.
                    out.line("method", "nested");
                }
            }
        }
        out.line(&format!("{:?}", self.correlations), "");
        for (key, formula) in self.outputs.formulas() {
            out.line(key, formula);
        }
        for design in &self.alternatives {
            let set: Vec<String> = design.set.iter().map(Assignment::to_string).collect();
            out.line(&design.name, &set.join(", "));
        }
        out.into_text()
    }
}

/// Returns the keys that are written, without their comments.
fn keys(write: impl FnOnce(&mut Writer)) -> String {
    let mut out = Writer::default();
    write(&mut out);
    let text = out.into_text();
    let lines = text
        .lines()
        .map(|line| line.split(" # ").next().unwrap_or(line).trim());
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.collect::<Vec<_>>().join(", ")
}

/// The aim of an adaptive study: to know an output, or the probability that it is beyond a limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aim {
    /// The output.
    pub output: &'static Scalar,
    /// The limit, with the sign of the side beyond it: 1 above, -1 below.
    pub limit: Option<(f64, f64)>,
    /// The part of the output that its errors may reach; of a probability, the factor less 1 that the ends of its interval may
    /// differ from it by.
    pub part: f64,
}

impl AdaptiveKeys {
    /// Returns what is to be known, as written before the accuracy.
    pub(super) fn known(&self) -> &str {
        let known = self.until.split_once(" known to ");
        known.map_or("", |(known, _)| known.trim())
    }

    /// Reads `OUTPUT known to NUMBER %` or `OUTPUT above LIMIT known to a factor of NUMBER`; `below` for the other side.
    pub(super) fn aim(&self, outputs: &Outputs) -> Option<Aim> {
        let number = |text: &str| text.parse::<f64>().ok().filter(|one| one.is_finite());
        let until = self.until.replace('%', " %");
        let words: Vec<&str> = until.split_whitespace().collect();
        // Smaller parts are beyond the solver, and larger ones need no emulator.
        let (name, limit, part) = match words[..] {
            [name, "known", "to", percent, "%"] => {
                let percent = number(percent).filter(|one| (0.01..=50.0).contains(one));
                (name, None, percent? / 100.0)
            }
            [
                name,
                side @ ("above" | "below"),
                limit,
                "known",
                "to",
                "a",
                "factor",
                "of",
                factor,
            ] => {
                let factor = number(factor).filter(|one| (1.1..=10.0).contains(one));
                let sign = if side == "above" { 1.0 } else { -1.0 };
                (name, Some((sign, number(limit)?)), factor? - 1.0)
            }
            _ => return None,
        };
        Some(Aim {
            output: outputs.get(name)?,
            limit,
            part,
        })
    }
}

impl Design {
    /// Returns the design without what lets it grow: its number of tests, if its tests are the first ones of every larger number,
    /// and the part to which an output is to be known.
    fn growing(&self) -> Self {
        let sample = |keys: &SampleKeys| SampleKeys {
            size: 0,
            ..keys.clone()
        };
        match self {
            // A hypercube begins with those of half its size, and of half of that.
            Self::LatinHypercube(keys) => Self::LatinHypercube(SampleKeys {
                size: keys.size >> keys.size.trailing_zeros(),
                ..keys.clone()
            }),
            Self::Sobol(keys) => Self::Sobol(sample(keys)),
            Self::Saltelli(keys) => Self::Saltelli(sample(keys)),
            Self::Morris(keys) => Self::Morris(MorrisKeys {
                walks: 0,
                ..keys.clone()
            }),
            Self::Optimise(keys) => Self::Optimise(OptimiseKeys {
                size: 0,
                ..keys.clone()
            }),
            Self::Adaptive(keys) => Self::Adaptive(AdaptiveKeys {
                size: 0,
                until: keys.known().to_owned(),
                ..keys.clone()
            }),
            other => other.clone(),
        }
    }
}
