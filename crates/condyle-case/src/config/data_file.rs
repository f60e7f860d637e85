//! Files that a file names, and columns of numbers in a CSV file, with the place of each.

use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use condyle::parameter::unit_of;
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
        Ok(Self {
            written: path.clone(),
            files,
            path,
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
            return wrong_type(value, key, log);
        };
        let base = log.base;
        match Self::find(base.files, written, base.folder) {
            Ok(file) => Some(file),
            Err(path) => log.reject(value.span(), missing_file(key.name, &path)),
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

/// Returns whether a line has a number, perhaps with a decimal comma, before a separator other than the comma.
fn is_separated_by(separator: char, line: &str) -> bool {
    let first = line.split_once(separator);
    let first = first.map(|(first, _)| first.trim_matches(is_around_cell));
    first.is_some_and(|first| {
        !first.ends_with(',') && first.replacen(',', ".", 1).parse::<f64>().is_ok()
    })
}

/// Returns whether a character may stand around the content of a cell: spreadsheets put quote marks there.
fn is_around_cell(letter: char) -> bool {
    letter.is_whitespace() || letter == '"'
}

/// Returns a CSV text without a byte order mark, and one with a separator other than the comma, as spreadsheets of some
/// languages write it with decimal commas, with commas and decimal points. It has as many bytes, so that places stay.
pub(crate) fn plain_csv(text: &str, separator: Option<char>) -> Cow<'_, str> {
    let marked = text.strip_prefix('\u{feff}');
    let plain = marked.map_or(Cow::Borrowed(text), |rest| Cow::Owned(format!("   {rest}")));
    match separator {
        Some(separator) => Cow::Owned(plain.replace(',', ".").replace(separator, ",")),
        None => plain,
    }
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
    /// The header is the last line above the numbers with as many names as they have columns, and may be a comment.
    pub(crate) fn split(text: &'a str, file: &str, example: &str) -> Result<Self, Vec<Placed>> {
        let written = text;
        let is_separator = |one: &char| text.lines().any(|line| is_separated_by(*one, line));
        let separator = [';', '\t'].into_iter().find(is_separator);
        let shown = plain_csv(text, separator);
        let text = shown.as_ref();
        let is_data = |line: &Range<usize>| {
            let first = cells(text, line).first().cloned().unwrap_or_default();
            text[first].parse::<f64>().is_ok()
        };
        let lines: Vec<Range<usize>> = lines(text).collect();
        let start = lines.iter().position(is_data).unwrap_or(lines.len());
        let first = lines.get(start);
        let columns = first.map_or(2, |line| filled(text, line).len());
        if columns < 2 {
            let fault = Fault::new(
                format!("{file} has one column where two or more are needed"),
                format!("put commas between the columns, as in `{example}`"),
            );
            return Err(vec![(lines[start].clone(), fault)]);
        }
        let above = || lines[..start].iter().rev();
        let all = |line: &Range<usize>| cells(text, line).len();
        let named = above().find(|line| Some(all(line)) == first.map(all));
        // Separators at the end of lines make columns without names, in some of the lines.
        let named = named.or_else(|| above().find(|line| filled(text, line).len() == columns));
        let Some(header) = named else {
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
        let is_row = |line: &&Range<usize>| {
            let is_comment = text[(*line).clone()].trim_start().starts_with('#');
            !is_comment && !filled(text, line).is_empty()
        };
        let header: Vec<_> = filled(text, header)
            .into_iter()
            .map(|span| without_comment(text, span))
            .collect();
        let rows = lines[start..].iter().filter(is_row);
        let rows: Vec<_> = rows.map(|line| cells(text, line)).collect();
        too_many_cells(&rows, header.len())?;
        if separator.is_some() {
            no_thousands(written, &rows)?;
        }
        Ok(Self {
            header,
            text: shown,
            rows,
        })
    }

    /// Returns the names of the columns: up to the first blank, since a remark may follow, but whole where several begin alike.
    pub(crate) fn names(&self) -> Vec<&str> {
        let whole = || self.header.iter().map(|span| &self.text[span.clone()]);
        let first = |name: &'_ str| name.find(char::is_whitespace).unwrap_or(name.len());
        let alike = |one: &str| {
            whole()
                .filter(|name| name[..first(name)] == one[..first(one)])
                .count()
        };
        let name = |name| {
            if alike(name) > 1 {
                name
            } else {
                &name[..first(name)]
            }
        };
        whole().map(name).collect()
    }

    /// Returns the unit of a column: it ends a word of its name, or what precedes a bracket as in `ant_mm(xtrans)`, or stands in
    /// brackets.
    pub(crate) fn unit(&self, column: usize) -> Option<&'static str> {
        let name = self.text[self.header[column].clone()].to_lowercase();
        let (stem, bracket) = name.split_once(['(', '[']).unwrap_or((&name, ""));
        let mut words = stem.split_whitespace();
        words
            .find_map(unit_of)
            .or_else(|| unit_in_brackets(bracket))
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
            if skips_empty && cells.get(column).is_none_or(Range::is_empty) {
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

/// Returns the place of a name without the `#` of a comment.
fn without_comment(text: &str, span: Range<usize>) -> Range<usize> {
    let name = text[span.clone()].trim_start_matches(|one| one == '#' || is_around_cell(one));
    span.end - name.len()..span.end
}

fn unit_in_brackets(text: &str) -> Option<&'static str> {
    let unit = text.strip_suffix([')', ']'])?.to_lowercase();
    // A newton metre is also written N m, N.m, N*m or with a raised dot.
    unit_of(&format!("_{}", unit.replace([' ', '.', '*', '-', '·'], "")))
}

/// Reports a row with more cells than the header has names: of a decimal comma, a comma for thousands, or another table.
fn too_many_cells(rows: &[Vec<Range<usize>>], columns: usize) -> Result<(), Vec<Placed>> {
    let beyond = |row: &Vec<Range<usize>>| {
        let cell = row.iter().skip(columns).find(|cell| !cell.is_empty())?;
        Some((cell.clone(), row.len()))
    };
    let Some((span, count)) = rows.iter().find_map(beyond) else {
        return Ok(());
    };
    let message = format!("the row has {count} cells where the header has {columns}");
    let advice = "separate the columns by semicolons if the numbers have decimal commas, and write no thousands separators";
    Err(vec![(span, Fault::new(message, advice))])
}

/// Reports numbers of a file without comma-separated columns that may have thousands separators.
fn no_thousands(text: &str, rows: &[Vec<Range<usize>>]) -> Result<(), Vec<Placed>> {
    let is_number = |span: &&Range<usize>| {
        text[(*span).clone()]
            .replace(',', ".")
            .parse::<f64>()
            .is_ok()
    };
    let of = |mark: char| {
        let mut numbers = rows.iter().flatten().filter(is_number);
        numbers.find(|cell| text[(*cell).clone()].contains(mark))
    };
    let problem = |span: &Range<usize>| {
        let number = &text[span.clone()];
        let message = format!("`{number}` may have a decimal separator or one of thousands");
        let fault = Fault::new(
            message,
            "write the numbers of the file without thousands separators",
        );
        Err(vec![(span.clone(), fault)])
    };
    if let (Some(_), Some(with_comma)) = (of('.'), of(',')) {
        return problem(with_comma);
    }
    // A column like 964, 1,018 has groups of three digits after the mark, and none in its numbers below a thousand.
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    for column in 0..columns {
        let own = rows.iter().filter_map(|row| row.get(column));
        let (marked, plain): (Vec<_>, Vec<_>) =
            own.partition(|cell| text[(*cell).clone()].contains(['.', ',']));
        let is_grouped = |cell: &&Range<usize>| {
            let (whole, group) = text[(*cell).clone()]
                .split_once(['.', ','])
                .unwrap_or_default();
            let whole = whole.trim_start_matches('-');
            group.len() == 3 && (1..=3).contains(&whole.len()) && !whole.starts_with('0')
        };
        let is_hundreds = |cell: &Range<usize>| {
            text[cell.clone()]
                .parse()
                .is_ok_and(|value: f64| value.abs() > 100.0 && value.abs() < 1000.0)
        };
        if let Some(first) = marked.first()
            && marked.iter().all(is_grouped)
            && plain.into_iter().any(is_hundreds)
        {
            return problem(first);
        }
    }
    Ok(())
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

/// Returns the cells of a line up to the last that is not empty.
fn filled(text: &str, line: &Range<usize>) -> Vec<Range<usize>> {
    let mut cells = cells(text, line);
    let last = cells.iter().rposition(|cell| !cell.is_empty());
    cells.truncate(last.map_or(0, |last| last + 1));
    cells
}

/// Returns the cells of a line, without blanks and quote marks around them.
pub(crate) fn cells(text: &str, line: &Range<usize>) -> Vec<Range<usize>> {
    let mut start = line.start;
    let cell = |cell: &str| {
        let before = cell.len() - cell.trim_start_matches(is_around_cell).len();
        let span = start + before..start + before + cell.trim_matches(is_around_cell).len();
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

pub(crate) fn repeated_column(column: &str) -> Fault {
    let message = format!("the column `{column}` is in its file twice");
    Fault::new(message, "give each column its own name")
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

    fn numbers(text: &str) -> Result<Vec<f64>, String> {
        let columns = Columns::split(text, "x.csv", "percent,y_mm");
        let cells = columns.and_then(|columns| columns.numbers(1));
        let values = cells.map(|cells| cells.iter().map(|cell| cell.value).collect());
        values.map_err(|faults| format!("{} {}", &text[faults[0].0.clone()], faults[0].1.message))
    }

    #[test]
    fn verify_columns_that_spreadsheets_write() {
        for text in [
            "percent;y_mm\n0;1,5\n50;2\n",
            "percent\ty_mm\r\n0\t1,5\r\n50\t2\r\n",
            "\"percent\",\"y_mm\"\n\"0\",\"1.5\"\n\"50\",\"2\"\n",
            "percent,y_mm,,\n0,1.5,,\n50,2,,\n",
            "percent,y_mm,\n0,1.5\n50,2\n,\n",
            "percent;y_mm\n0;1,5;\n50;2;\n",
        ] {
            assert_eq!(numbers(text), Ok(vec![1.5, 2.0]), "{text}");
        }
    }

    #[test]
    fn cells_beyond_the_header_and_separators_of_thousands_are_refused() {
        for (text, shown) in [
            ("percent,y_mm\n0,5\n1,6,29\n", "29 the row has 3 cells"),
            ("percent;y_n\n0;964\n1;1,018\n", "1,018 `1,018` may have"),
            ("percent;y_n\n0;964\n1;1.018\n", "1.018 `1.018` may have"),
            (
                "percent;y_n\n0.0;964\n1.0;1,018\n",
                "1,018 `1,018` may have",
            ),
        ] {
            let fault = numbers(text).unwrap_err();
            assert!(fault.starts_with(shown), "{text}: {fault}");
        }
        // A cycle by sixths, and dates in a column that is not used.
        let sixths = "percent;y_mm\n0;1\n16,667;2\n83,333;3\n100;1\n";
        assert_eq!(numbers(sixths), Ok(vec![1.0, 2.0, 3.0, 1.0]));
        let dated = "percent;y_mm;date\n0;1,5;1.2.2026\n50;2;2.2.2026\n";
        assert_eq!(numbers(dated), Ok(vec![1.5, 2.0]));
        // Three decimals below a hundred are no thousands.
        assert_eq!(
            numbers("percent;y_mm\n0;64\n1;1,018\n"),
            Ok(vec![64.0, 1.018])
        );
    }

    #[test]
    fn names_that_begin_alike_keep_their_words_and_units_may_stand_in_brackets() {
        let text = "percent,force_N left,force_N right,axial load [N],x (mm)\n0,1,2,3,4\n";
        let columns = Columns::split(text, "x.csv", "").unwrap();
        let names = ["percent", "force_N left", "force_N right", "axial", "x"];
        assert_eq!(columns.names(), names);
        let units = [1, 2, 3, 4].map(|column| columns.unit(column));
        assert_eq!(units, [Some("N"), Some("N"), Some("N"), Some("mm")]);
    }

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
