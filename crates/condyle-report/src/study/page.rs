//! `study.html`: tables and pictures of a study, one file that opens anywhere.

use std::path::{Path, PathBuf};

use crate::error::ReportError;
use crate::file::write_text;
use crate::sheets::Sheets;

/// The contents of a study's page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StudyPage {
    /// The heading.
    pub title: String,
    /// A summary in a sentence or two.
    pub lede: String,
    /// Headings and rows; the first row is the head.
    pub tables: Vec<(String, Vec<Vec<String>>)>,
    /// Names of the files, captions, and texts.
    pub pictures: Vec<(&'static str, String, String)>,
}

/// Writes `study.html` and every picture into `folder`, and returns the path of the page.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_study_page(folder: &Path, page: &StudyPage) -> Result<PathBuf, ReportError> {
    for (name, _, svg) in &page.pictures {
        write_text(folder.join(name), svg)?;
    }
    let sheets = Sheets {
        kicker: "condyle study",
        title: &page.title,
        lede: &page.lede,
        notes: &[],
        body: "",
        tables: &page.tables,
        pictures: &page.pictures,
    };
    write_text(folder.join("study.html"), &sheets.html())
}
