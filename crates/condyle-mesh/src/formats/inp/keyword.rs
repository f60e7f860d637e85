//! The keyword lines of an Abaqus input file with the data lines below them.

use std::path::Path;

use super::super::error::{FileLine, MeshFileError};

/// `*NAME, KEY=value, FLAG` and its data lines.
pub(crate) struct Keyword<'t> {
    pub(crate) line: usize,
    /// In capitals, without the asterisk.
    pub(crate) name: String,
    parameters: Vec<(String, String)>,
    /// Line number and text.
    pub(crate) data: Vec<(usize, &'t str)>,
}

impl Keyword<'_> {
    /// Value of a parameter, empty for a flag.
    pub(crate) fn value(&self, parameter: &str) -> Option<&str> {
        let found = self.parameters.iter().find(|(key, _)| key == parameter);
        found.map(|(_, value)| value.as_str())
    }
}

/// All keywords of a file; comments (`**`) and empty lines are left out.
pub(crate) fn keywords<'t>(
    path: &Path,
    content: &'t str,
) -> Result<Vec<Keyword<'t>>, MeshFileError> {
    let rows = (1..).zip(content.lines().map(str::trim));
    let mut rows = rows.filter(|(_, row)| !row.is_empty() && !row.starts_with("**"));
    let mut keywords: Vec<Keyword> = Vec::new();
    while let Some((line, row)) = rows.next() {
        if let Some(first) = row.strip_prefix('*') {
            let mut whole = first.to_string();
            // A keyword line that ends in a comma goes on in the next.
            while whole.ends_with(',') {
                let Some((_, more)) = rows.next() else { break };
                whole.push_str(more);
            }
            keywords.push(keyword(line, &whole));
        } else if let Some(keyword) = keywords.last_mut() {
            keyword.data.push((line, row));
        } else {
            let what = "a data line stands before the first keyword; is this an Abaqus file?";
            return Err(FileLine::line(path, line).error(what));
        }
    }
    Ok(keywords)
}

fn keyword<'t>(line: usize, whole: &str) -> Keyword<'t> {
    let mut words = whole.split(',').map(str::trim);
    let name = words
        .next()
        .unwrap_or_default()
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ");
    let parameters = words.filter(|word| !word.is_empty()).map(|word| {
        let (key, value) = word.split_once('=').unwrap_or((word, ""));
        let value = value.trim().trim_matches('"');
        (key.trim().to_ascii_uppercase(), value.to_string())
    });
    Keyword {
        line,
        name: name.to_ascii_uppercase(),
        parameters: parameters.collect(),
        data: Vec::new(),
    }
}
