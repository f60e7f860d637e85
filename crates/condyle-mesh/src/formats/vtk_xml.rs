//! The XML of VTK files and the data arrays in it.

use std::path::Path;

use roxmltree::{Document, Node};

use super::{
    error::MeshFileError,
    text::{At, decode},
    vtk_arrays::BinaryLayout,
};

/// Longest tag, bytes: the XML parser compares every attribute of a tag with every other.
const MAX_TAG_BYTES: usize = 8192;
/// Number of values that the arrays of a file may have for each of its bytes. Arrays may overlap and
/// unpack to far more than the file has; those of a mesh are seldom packed to a tenth of a byte a value.
const MAX_VALUES_PER_BYTE: usize = 16;
/// Number of values that a file of any length may have: short files may hold values that pack well.
const MIN_VALUES_LIMIT: usize = 4_000_000;

/// One array of any type, as double precision.
pub(crate) struct DataArray {
    pub(crate) name: String,
    pub(crate) components: usize,
    pub(crate) is_integer: bool,
    pub(crate) line: usize,
    pub(crate) values: Vec<f64>,
}

impl DataArray {
    pub(crate) fn indices(&self) -> impl Iterator<Item = i64> + '_ {
        self.values.iter().map(|&value| value as i64)
    }

    pub(crate) fn vectors(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.values.as_chunks().0.iter().copied()
    }
}

#[derive(Default)]
pub(crate) struct Cells {
    pub(crate) line: usize,
    points: Vec<i64>,
    /// Start of every cell in `points`, and the end of the last.
    starts: Vec<usize>,
}

impl Cells {
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = &[i64]> {
        self.starts
            .windows(2)
            .map(|ends| &self.points[ends[0]..ends[1]])
    }

    pub(crate) fn get(&self, cell: usize) -> &[i64] {
        &self.points[self.starts[cell]..self.starts[cell + 1]]
    }
}

/// The one piece of a VTK file: the arrays of some of its groups, such as `Cells`.
pub(crate) struct Piece<'p> {
    pub(crate) path: &'p Path,
    groups: Vec<(&'static str, Vec<DataArray>)>,
}

impl<'p> Piece<'p> {
    /// Reads groups of a file of the given `type`, such as `UnstructuredGrid`; a missing group has no arrays.
    pub(crate) fn read(
        path: &'p Path,
        bytes: &[u8],
        kind: &str,
        groups: &[&'static str],
    ) -> Result<Self, MeshFileError> {
        let (xml, appended, appended_is_raw) = split(bytes);
        let newlines = xml.match_indices('\n').map(|(at, _)| at + 1);
        let line_starts: Vec<usize> = std::iter::once(0).chain(newlines).collect();
        if let Some(start) = long_tag(&xml) {
            let line = line_starts.partition_point(|&line| line <= start);
            let problem =
                format!("has a tag of more than {MAX_TAG_BYTES} bytes; is this a VTK file?");
            return Err(At::line(path, line).error(problem));
        }
        let document = parse_xml(path, &xml)?;
        let root = document.root_element();
        let found = root.attribute("type").unwrap_or_default();
        if !root.has_tag_name("VTKFile") || found != kind {
            let problem = format!("is not a VTKFile of type {kind} but {found:?}");
            return Err(At::file(path).error(problem));
        }
        let mut reader = ArrayReader {
            path,
            line_starts,
            appended,
            appended_is_raw,
            layout: BinaryLayout::new(root).map_err(|problem| At::file(path).error(problem))?,
            values_left: MIN_VALUES_LIMIT + MAX_VALUES_PER_BYTE * bytes.len(),
        };
        let mut pieces = root.descendants().filter(|node| node.has_tag_name("Piece"));
        let piece = pieces.next();
        let piece = piece.ok_or_else(|| At::file(path).error("has no Piece"))?;
        if let Some(second) = pieces.next() {
            let problem = "has a second Piece; merge the pieces into one and save again";
            return Err(reader.at(second).error(problem));
        }
        let mut read = Self {
            path,
            groups: Vec::new(),
        };
        for &group in groups {
            let nodes = piece.children().filter(|node| node.has_tag_name(group));
            let nodes = nodes.flat_map(|node| node.children());
            let nodes = nodes.filter(|node| node.has_tag_name("DataArray"));
            let arrays: Result<_, _> = nodes.map(|node| reader.array(node)).collect();
            read.groups.push((group, arrays?));
        }
        Ok(read)
    }

    pub(crate) fn arrays(&self, group: &str) -> &[DataArray] {
        let found = self.groups.iter().find(|(name, _)| *name == group);
        found.map_or(&[], |(_, arrays)| arrays)
    }

    pub(crate) fn points(&self) -> Result<Vec<[f64; 3]>, MeshFileError> {
        let points = self.arrays("Points").first();
        let points = points.filter(|array| array.components == 3);
        let points =
            points.ok_or_else(|| At::file(self.path).error("has no Points of three components"))?;
        Ok(points.vectors().collect())
    }

    /// Returns the cells of a group; none if it has no connectivity or no offsets.
    pub(crate) fn cells(&self, group: &str) -> Result<Cells, MeshFileError> {
        let named = |name: &str| self.arrays(group).iter().find(|array| array.name == name);
        let (Some(connectivity), Some(offsets)) = (named("connectivity"), named("offsets")) else {
            return Ok(Cells::default());
        };
        let points: Vec<i64> = connectivity.indices().collect();
        let mut starts = vec![0];
        for offset in offsets.indices() {
            let start = starts[starts.len() - 1];
            let end = usize::try_from(offset).ok();
            let end = end.filter(|&end| end >= start && end <= points.len());
            starts.push(end.ok_or_else(|| {
                let problem = format!("offset {offset} does not fit the connectivity");
                At::line(self.path, offsets.line).error(problem)
            })?);
        }
        Ok(Cells {
            line: connectivity.line,
            points,
            starts,
        })
    }
}

pub(crate) fn parse_xml<'x>(path: &Path, xml: &'x str) -> Result<Document<'x>, MeshFileError> {
    Document::parse(xml).map_err(|error| {
        let line = error.pos().row as usize;
        At::line(path, line).error(format!("is not XML: {error}"))
    })
}

/// Splits a file into its XML and the bytes appended to it; the last value is whether these are raw bytes rather than
/// text.
fn split(bytes: &[u8]) -> (String, Option<&[u8]>, bool) {
    let find = |from: usize, pattern: &[u8]| {
        let mut windows = bytes[from..].windows(pattern.len());
        let found = windows.position(|window| window == pattern);
        found.map(|at| from + at)
    };
    let Some(start) = find(0, b"<AppendedData") else {
        return (decode(bytes).into_owned(), None, false);
    };
    let xml = format!("{}</VTKFile>", decode(&bytes[..start]));
    let tag_end = find(start, b">").unwrap_or(bytes.len());
    let data_start = find(tag_end, b"_").map_or(bytes.len(), |at| at + 1);
    let is_raw = find(start, b"raw").is_some_and(|raw| raw < tag_end);
    (xml, Some(&bytes[data_start..]), is_raw)
}

/// Returns the start of a tag that is longer than any tag of a mesh file.
fn long_tag(xml: &str) -> Option<usize> {
    const NO_TAGS: [(&str, &str); 3] = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
    let mut at = 0;
    while let Some(found) = xml[at..].find('<') {
        let start = at + found;
        let markup = &xml[start..];
        if let Some((_, close)) = NO_TAGS.iter().find(|(open, _)| markup.starts_with(open)) {
            let end = markup.find(close);
            at = end.map_or(xml.len(), |end| start + end + close.len());
            continue;
        }
        // A `>` between quotes does not end the tag.
        let mut quote = None;
        let end = markup.bytes().position(|byte| match quote {
            Some(open) => {
                quote = Some(open).filter(|_| byte != open);
                false
            }
            None => {
                quote = Some(byte).filter(|byte| matches!(byte, b'"' | b'\''));
                byte == b'>'
            }
        });
        at = end.map_or(xml.len(), |end| start + end + 1);
        if at - start > MAX_TAG_BYTES {
            return Some(start);
        }
    }
    None
}

struct ArrayReader<'a> {
    path: &'a Path,
    /// Start of each line of the XML; the XML parser's own search for a line starts at the first one.
    line_starts: Vec<usize>,
    appended: Option<&'a [u8]>,
    appended_is_raw: bool,
    layout: BinaryLayout,
    /// Number of values that all arrays still to be read may have.
    values_left: usize,
}

impl<'a> ArrayReader<'a> {
    fn at(&self, node: Node) -> At<'a> {
        let start = node.range().start;
        let line = self.line_starts.partition_point(|&line| line <= start);
        At::line(self.path, line)
    }

    fn array(&mut self, node: Node) -> Result<DataArray, MeshFileError> {
        let at = self.at(node);
        let kind = node.attribute("type").unwrap_or_default();
        let values = match node.attribute("format") {
            Some("ascii") => self.text_values(node)?,
            Some("binary") => {
                let encoded = node.text().unwrap_or_default().as_bytes();
                self.binary_values(at, kind, encoded, false)?
            }
            Some("appended") => {
                let offset = node
                    .attribute("offset")
                    .and_then(|o| o.parse::<usize>().ok());
                let data = offset.and_then(|offset| self.appended?.get(offset..));
                let outside = "an array's offset lies outside the appended data";
                let data = data.ok_or_else(|| at.error(outside))?;
                self.binary_values(at, kind, data, self.appended_is_raw)?
            }
            _ => return Err(at.error("unknown array format; use ascii, binary or appended")),
        };
        let components = node.attribute("NumberOfComponents");
        Ok(DataArray {
            name: node.attribute("Name").unwrap_or_default().to_string(),
            components: components.and_then(|c| c.parse().ok()).unwrap_or(1),
            is_integer: kind.contains("Int"),
            line: at.line.unwrap_or_default(),
            values,
        })
    }

    fn text_values(&self, node: Node) -> Result<Vec<f64>, MeshFileError> {
        let Some(content) = node.first_child().filter(Node::is_text) else {
            return Ok(Vec::new());
        };
        let first = self.at(content).line.unwrap_or_default();
        let mut values = Vec::new();
        for (line, row) in (first..).zip(content.text().unwrap_or_default().lines()) {
            for word in row.split_ascii_whitespace() {
                values.push(At::line(self.path, line).number(word)?);
            }
        }
        Ok(values)
    }

    fn binary_values(
        &mut self,
        at: At,
        kind: &str,
        data: &[u8],
        is_raw: bool,
    ) -> Result<Vec<f64>, MeshFileError> {
        let (layout, left) = (&self.layout, self.values_left);
        let values = if is_raw {
            layout.values(kind, data, left)
        } else {
            let decoded = layout.decoded(data);
            decoded.and_then(|data| layout.values(kind, &data, left))
        };
        let values = values.map_err(|problem| at.error(problem))?;
        self.values_left -= values.len();
        Ok(values)
    }
}
