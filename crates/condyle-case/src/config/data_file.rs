//! Files that a file names, and columns of numbers in a CSV file, with the place of each.

use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use condyle_mesh::files::Files;
#[cfg(feature = "file-system")]
use condyle_mesh::files::path_from;
use toml::Spanned;
use toml::de::DeValue;

use super::fault::{Fault, missing_file};
use super::key::{Key, Kind, quoted};
use super::problem::{Log, Placed, Source, read_source};
use super::section::Section;
use super::setting::{Setting, wrong_type};

/// A file that another file names, and that existed when the other was read.
///
/// Two files are equal if their paths are, whatever their storage.
#[derive(Clone, Debug)]
pub struct DataFile {
    files: Arc<dyn Files>,
    /// Absolute on a disk, its folder without `..` or links.
    path: PathBuf,
    /// The path as written in the file that names it.
    written: PathBuf,
}

impl PartialEq for DataFile {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl DataFile {
    /// Finds the file of `files` at the path `written`, relative to `folder`.
    ///
    /// # Errors
    /// The file does not exist; the error is the path that was searched.
    pub fn find(files: &Arc<dyn Files>, written: &str, folder: &Path) -> Result<Self, PathBuf> {
        let (path, files) = (files.find(written, folder)?, Arc::clone(files));
        let written = path.clone();
        Ok(Self {
            files,
            path,
            written,
        })
    }

    /// Returns the file with its path relative to `folder`, an absolute path without links.
    #[cfg(feature = "file-system")]
    pub(crate) fn named_from(&self, folder: &Path) -> Self {
        let mut file = self.clone();
        if let Some(written) = path_from(folder, &self.path) {
            file.written = written;
        }
        file
    }

    /// Returns the files that it is read from.
    pub fn files(&self) -> &dyn Files {
        self.files.as_ref()
    }

    /// Returns the files that it is read from, shared with it.
    pub(crate) fn shared_files(&self) -> &Arc<dyn Files> {
        &self.files
    }

    /// Returns its path, absolute on a disk.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns its name without its folder.
    pub fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    /// Reads its text, or reports a problem at the key `key` of `section`.
    pub(crate) fn source(
        &self,
        section: &Section<'_>,
        key: &str,
        log: &mut Log<'_>,
    ) -> Option<Source> {
        let source = read_source(self.files(), &self.path);
        source
            .map_err(|reason| log.problem(section.value_span(key), reason))
            .ok()
    }
}

impl Setting for DataFile {
    fn kind() -> Kind {
        Kind::Path
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        let Some(written) = value.get_ref().as_str() else {
            wrong_type(value, key, log);
            return None;
        };
        let base = log.base;
        match Self::find(base.files, written, base.folder) {
            Ok(file) => Some(file),
            Err(path) => {
                log.problem(value.span(), missing_file(key.name, &path));
                None
            }
        }
    }

    fn text(&self) -> Option<String> {
        Some(quoted(&self.written.display().to_string()))
    }
}

/// A CSV file: names of its columns, and rows of unparsed cells.
pub(crate) struct Columns<'a> {
    text: Cow<'a, str>,
    header: Vec<Range<usize>>,
    rows: Vec<Vec<Range<usize>>>,
}

/// Returns whether a line has a number, perhaps with a decimal comma, before a semicolon.
fn has_semicolons(line: &str) -> bool {
    let first = line.split_once(';').map(|(first, _)| first.trim());
    first.is_some_and(|first| first.replacen(',', ".", 1).parse::<f64>().is_ok())
}

/// A number and its place.
pub(crate) struct Cell {
    pub row: usize,
    pub value: f64,
    pub span: Range<usize>,
}

impl<'a> Columns<'a> {
    /// Splits `text` into a header and rows; `example` shows a header where there is none.
    ///
    /// The header is the last line above the numbers with as many names as they have columns, and
    /// may be a comment; a name ends at a blank, so that a remark may follow the last.
    pub(crate) fn split(text: &'a str, file: &str, example: &str) -> Result<Self, Vec<Placed>> {
        // As many bytes, so that places stay: spreadsheets of some languages write semicolons and decimal commas.
        let shown = if text.lines().any(has_semicolons) {
            Cow::Owned(text.replace(',', ".").replace(';', ","))
        } else {
            Cow::Borrowed(text)
        };
        let text = shown.as_ref();
        let is_data = |line: &Range<usize>| {
            let first = text[line.clone()].split(',').next().unwrap_or_default();
            first.trim().parse::<f64>().is_ok()
        };
        let lines: Vec<Range<usize>> = lines(text).collect();
        let start = lines.iter().position(is_data).unwrap_or(lines.len());
        let columns = lines.get(start).map_or(2, |line| cells(text, line).len());
        if columns < 2 {
            let fault = Fault::new(
                format!("{file} has one column where two or more are needed"),
                format!("put commas between the columns, as in `{example}`"),
            );
            return Err(vec![(lines[start].clone(), fault)]);
        }
        let named = |line: &&Range<usize>| cells(text, line).len() == columns;
        let Some(header) = lines[..start].iter().rev().find(named) else {
            let first = lines.first().cloned().unwrap_or(0..0);
            let advice = format!(
                "write one above the numbers, with the unit in the name, such as `{example}`"
            );
            let fault = Fault::new(
                format!("{file} has no header that names its columns"),
                advice,
            );
            return Err(vec![(first, fault)]);
        };
        // Cells of a header lose the `#` of a comment, and end at a blank.
        let name = |span: Range<usize>| {
            let name = text[span.clone()].trim_start_matches(['#', ' ', '\t']);
            let start = span.end - name.len();
            let length = name.find(char::is_whitespace).unwrap_or(name.len());
            start..start + length
        };
        let is_row = |line: &&Range<usize>| !text[(*line).clone()].trim_start().starts_with('#');
        let rows = lines[start..].iter().filter(is_row);
        let header = cells(text, header).into_iter().map(name).collect();
        let rows = rows.map(|line| cells(text, line)).collect();
        Ok(Self {
            text: shown,
            header,
            rows,
        })
    }

    pub(crate) fn names(&self) -> Vec<&str> {
        let name = |span: &Range<usize>| &self.text[span.clone()];
        self.header.iter().map(name).collect()
    }

    pub(crate) fn name_span(&self, column: usize) -> Range<usize> {
        self.header[column].clone()
    }

    /// Returns the numbers of a column, or a problem for every other cell.
    pub(crate) fn numbers(&self, column: usize) -> Result<Vec<Cell>, Vec<Placed>> {
        self.collected(column, false)
    }

    /// Returns the numbers of a column without empty cells, or a problem for every other cell.
    pub(crate) fn numbers_given(&self, column: usize) -> Result<Vec<Cell>, Vec<Placed>> {
        self.collected(column, true)
    }

    fn collected(&self, column: usize, skips_empty: bool) -> Result<Vec<Cell>, Vec<Placed>> {
        let (mut good, mut bad) = (Vec::new(), Vec::new());
        for (row, cells) in self.rows.iter().enumerate() {
            if skips_empty && cells.get(column).is_some_and(Range::is_empty) {
                continue;
            }
            // A row that is too short lacks its cell at its end.
            let end = cells.last().map_or(0, |last| last.end);
            let span = cells.get(column).cloned().unwrap_or(end..end);
            let text = &self.text[span.clone()];
            match text.parse::<f64>() {
                Ok(value) if value.is_finite() => good.push(Cell { row, value, span }),
                Ok(_) | Err(_) => {
                    let column = self.names()[column];
                    let message = format!("`{text}` in column `{column}` is not a finite number");
                    let fault = Fault::new(message, "write a number there, or remove the row");
                    bad.push((span, fault));
                }
            }
        }
        if bad.is_empty() { Ok(good) } else { Err(bad) }
    }
}

/// Returns the lines that are not blank.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut start = 0;
    let span = move |line: &str| {
        let span = start..start + line.trim_end().len();
        start += line.len();
        span
    };
    text.split_inclusive('\n')
        .map(span)
        .filter(|line| !line.is_empty())
}

/// Returns the cells of a line, without blanks around them.
pub(crate) fn cells(text: &str, line: &Range<usize>) -> Vec<Range<usize>> {
    let mut start = line.start;
    let cell = |cell: &str| {
        let before = cell.len() - cell.trim_start().len();
        let span = start + before..start + before + cell.trim().len();
        start += cell.len() + 1;
        span
    };
    text[line.clone()].split(',').map(cell).collect()
}

/// Returns the fault of a column that the `file` does not have among `columns`.
pub(crate) fn no_column(column: &str, file: &str, columns: &[&str]) -> Fault {
    Fault::new(
        format!("there is no column `{column}` in {file}"),
        format!("it has {}", columns.join(", ")),
    )
}

pub(crate) fn other_unit(column: &str, unit: &str, suffix: &str) -> Fault {
    Fault::new(
        format!("column `{column}` has another unit than {unit}, which is needed here"),
        format!("let its name end with `{suffix}`, and give the values in {unit}"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn header_may_be_a_comment_with_a_remark() {
        let text = "# measured, in May\n# pct_cycle,ant_mm(xtrans),flex_deg  source: a, thesis\n\
                    0,1.0,2.0\n50, 3.0 ,4.0\n";
        let text = text.replace("a, thesis", "thesis");
        let columns = Columns::split(&text, "x.csv", "percent,y_mm").unwrap();
        assert_eq!(columns.names(), ["pct_cycle", "ant_mm(xtrans)", "flex_deg"]);
        let Ok(cells) = columns.numbers(1) else {
            panic!("all are numbers");
        };
        assert_eq!(cells.iter().map(|cell| cell.value).sum::<f64>(), 4.0);
        assert_eq!(&text[cells[1].span.clone()], "3.0");
    }
}
