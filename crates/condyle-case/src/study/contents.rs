//! All that a study says.

use std::path::{Path, PathBuf};

use super::alternative::Alternative;
use super::answers::Answers;
use super::correlation::Correlation;
use super::declared::{Design, Variation};
use super::input::Input;
use super::tried::assignment;
use crate::case::{Assignment, Case, CaseReader, ChangeError};
use crate::config::Level;

/// A study as its file describes it, checked, with every default filled in.
#[derive(Clone, Debug)]
pub struct Study {
    /// Shown on the page; may be empty.
    pub title: String,
    /// Where the case is.
    pub case_path: PathBuf,
    /// The case as it is.
    pub case: Case,
    /// Which tests are done.
    pub design: Design,
    /// What varies, in the order of the file.
    pub inputs: Vec<Input>,
    /// Inputs that go together.
    pub correlations: Vec<Correlation>,
    /// Designs that are compared; none where there is but the case.
    pub alternatives: Vec<Alternative>,
    /// What is asked.
    pub answers: Answers,
    /// Of a study of given rows the values of each test, an input after the other.
    pub rows: Vec<Vec<Level>>,
    /// The file itself.
    pub text: String,
    pub(super) folder: PathBuf,
    pub(super) cases: CaseReader,
}

impl Study {
    /// What one test sets of the case: the design's keys, then the inputs'. An input without a value stays as it is.
    pub fn assignments(&self, alternative: usize, values: &[Option<Level>]) -> Vec<Assignment> {
        let of_design = self.alternatives.get(alternative);
        let design = of_design.into_iter().flat_map(|design| design.set.clone());
        let inputs = self.inputs.iter().zip(values);
        let set = |(input, value): (&Input, &Option<Level>)| {
            Some(assignment(&self.folder, &input.key, value.as_ref()?))
        };
        design.chain(inputs.filter_map(set)).collect()
    }

    /// The case with some of its values changed.
    ///
    /// # Errors
    /// As [`CaseReader::read_changed`].
    pub fn changed_case(&self, changes: &[Assignment]) -> Result<Case, ChangeError> {
        self.cases.read_changed(&self.case_path, changes)
    }

    /// The value of an input in the case as it is; none where the case leaves it out.
    pub fn value_of_case(&self, input: &Input) -> Option<Level> {
        let number = self
            .case
            .number_at_or_written(&input.key)
            .map(Level::Number);
        number.or_else(|| self.case.word_at(&input.key).map(Level::Word))
    }

    /// Files that its levels name, where they are.
    pub fn files(&self) -> Vec<PathBuf> {
        let levels = |input: &Input| match &input.variation {
            Variation::Levels(keys) => keys.levels.0.clone(),
            _ => Vec::new(),
        };
        let named = self.inputs.iter().filter(|input| input.is_file());
        let all = named.flat_map(levels);
        let column = |place: usize| self.rows.iter().map(move |row| row[place].clone());
        let of_rows = self.inputs.iter().enumerate();
        let of_rows = of_rows.filter(|(_, input)| input.is_file());
        let rows = of_rows.flat_map(|(place, _)| column(place));
        let mut files: Vec<PathBuf> = all
            .chain(rows)
            .filter_map(|level| self.file(&level))
            .collect();
        files.sort();
        files.dedup();
        files
    }

    fn file(&self, level: &Level) -> Option<PathBuf> {
        match level {
            Level::Word(written) => Some(Path::join(&self.folder, written)),
            Level::Number(_) => None,
        }
    }
}
