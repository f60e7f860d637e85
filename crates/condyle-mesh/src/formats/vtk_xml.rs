//! The XML of VTK files, and the data arrays in it: text, base64 or appended bytes, compressed or not.

use std::{cell::Cell, io::Read, path::Path};

use base64::{Engine, engine::general_purpose::STANDARD};
use roxmltree::{Document, Node};

use super::{
    error::{FileLine, MeshFileError},
    text,
};

const APPENDED: &[u8] = b"<AppendedData";
/// Longest tag: the parser compares every attribute of a tag with every other.
const TAG_BYTES: usize = 8192;
/// Arrays may overlap and unpack to far more than the file has, so that its length bounds them
/// all: those of a mesh are seldom packed to a tenth of a byte a value.
const VALUES_A_BYTE: usize = 16;
/// Short files may hold what packs well.
const VALUES_OF_ANY_FILE: usize = 4_000_000;

/// A file cut into its XML and the bytes appended to it, which may be no XML at all.
pub(crate) struct VtkSource<'a> {
    xml: String,
    appended: Option<&'a [u8]>,
    appended_is_raw: bool,
    /// Bytes of the whole file.
    length: usize,
}

impl<'a> VtkSource<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let length = bytes.len();
        let Some(start) = find(bytes, APPENDED) else {
            let xml = text::decode(bytes).into_owned();
            return Self {
                xml,
                appended: None,
                appended_is_raw: false,
                length,
            };
        };
        let xml = format!("{}</VTKFile>", text::decode(&bytes[..start]));
        let tag_end = find(&bytes[start..], b">").map_or(bytes.len(), |end| start + end);
        let data_start = find(&bytes[tag_end..], b"_").map_or(bytes.len(), |at| tag_end + at + 1);
        let appended_is_raw = find(&bytes[start..tag_end], b"raw").is_some();
        Self {
            xml,
            appended: Some(&bytes[data_start..]),
            appended_is_raw,
            length,
        }
    }
}

fn find(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes
        .windows(pattern.len())
        .position(|window| window == pattern)
}

/// Where a tag starts that is longer than any of a mesh.
fn long_tag(xml: &str) -> Option<usize> {
    let mut at = 0;
    while let Some(found) = xml[at..].find('<') {
        let start = at + found;
        let (length, is_tag) = markup(&xml[start..]);
        if is_tag && length > TAG_BYTES {
            return Some(start);
        }
        at = start + length;
    }
    None
}

/// Length of the markup that `xml` starts with, and whether it is a tag with attributes.
fn markup(xml: &str) -> (usize, bool) {
    for (open, close) in [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")] {
        if xml.starts_with(open) {
            let end = xml.find(close).map_or(xml.len(), |at| at + close.len());
            return (end, false);
        }
    }
    let mut quote = None;
    let end = xml.bytes().position(|byte| match quote {
        Some(open) => {
            quote = Some(open).filter(|_| byte != open);
            false
        }
        None => {
            quote = Some(byte).filter(|byte| matches!(byte, b'"' | b'\''));
            byte == b'>'
        }
    });
    (end.map_or(xml.len(), |end| end + 1), true)
}

/// The parsed XML with what is needed to decode its arrays.
pub(crate) struct VtkDocument<'a> {
    path: &'a Path,
    document: Document<'a>,
    source: &'a VtkSource<'a>,
    /// Where each line of the XML starts.
    line_starts: Vec<usize>,
    layout: BinaryLayout,
    /// How many values all arrays still to be read may have.
    values_left: Cell<usize>,
}

/// One array, whatever its type, as double precision.
pub(crate) struct DataArray {
    pub(crate) name: String,
    pub(crate) components: usize,
    pub(crate) is_integer: bool,
    pub(crate) line: usize,
    pub(crate) values: Vec<f64>,
}

impl DataArray {
    /// Values as numbers of points or cells.
    pub(crate) fn indices(&self) -> impl Iterator<Item = i64> + '_ {
        self.values.iter().map(|&value| value as i64)
    }

    pub(crate) fn points(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        self.values
            .chunks_exact(3)
            .map(|point| [point[0], point[1], point[2]])
    }
}

impl<'a> VtkDocument<'a> {
    /// Opens a file of the given `type`, such as `UnstructuredGrid`.
    pub(crate) fn open(
        path: &'a Path,
        source: &'a VtkSource<'a>,
        kind: &str,
    ) -> Result<Self, MeshFileError> {
        let newlines = source.xml.match_indices('\n').map(|(at, _)| at + 1);
        let line_starts: Vec<usize> = std::iter::once(0).chain(newlines).collect();
        if let Some(start) = long_tag(&source.xml) {
            let line = line_starts.partition_point(|&line| line <= start);
            let what = format!("has a tag of more than {TAG_BYTES} bytes; is this a VTK file?");
            return Err(FileLine::line(path, line).error(what));
        }
        let document = Document::parse(&source.xml).map_err(|error| {
            let line = error.pos().row as usize;
            FileLine::line(path, line).error(format!("is not XML: {error}"))
        })?;
        let root = document.root_element();
        let found = root.attribute("type").unwrap_or_default();
        if !root.has_tag_name("VTKFile") || found != kind {
            let what = format!("is not a VTKFile of type {kind} but {found:?}");
            return Err(FileLine::file(path).error(what));
        }
        let layout = layout(root).map_err(|what| FileLine::file(path).error(what))?;
        Ok(Self {
            path,
            document,
            source,
            line_starts,
            layout,
            values_left: Cell::new(VALUES_OF_ANY_FILE + VALUES_A_BYTE * source.length),
        })
    }

    /// The one piece of the grid.
    pub(crate) fn piece(&self) -> Result<Node<'_, 'a>, MeshFileError> {
        let mut pieces = self
            .document
            .descendants()
            .filter(|node| node.has_tag_name("Piece"));
        let piece = pieces.next();
        let piece = piece.ok_or_else(|| FileLine::file(self.path).error("has no Piece"))?;
        match pieces.next() {
            None => Ok(piece),
            Some(second) => {
                let what = "has a second Piece; merge the pieces into one and save again";
                Err(FileLine::line(self.path, self.line_of(second)).error(what))
            }
        }
    }

    fn line_of(&self, node: Node) -> usize {
        let at = node.range().start;
        self.line_starts.partition_point(|&start| start <= at)
    }

    /// All arrays of one group of a piece, such as `Cells`; none where the group is missing.
    pub(crate) fn group(&self, piece: Node, group: &str) -> Result<Vec<DataArray>, MeshFileError> {
        let groups = piece.children().filter(|node| node.has_tag_name(group));
        groups
            .flat_map(|node| node.children())
            .filter(|node| node.has_tag_name("DataArray"))
            .map(|node| self.array(node))
            .collect()
    }

    /// The coordinates of the piece's points.
    pub(crate) fn point_array(&self, piece: Node) -> Result<DataArray, MeshFileError> {
        let points = self.group(piece, "Points")?.into_iter().next();
        points
            .filter(|array| array.components == 3)
            .ok_or_else(|| FileLine::file(self.path).error("has no Points of three components"))
    }

    fn array(&self, node: Node) -> Result<DataArray, MeshFileError> {
        let kind = node.attribute("type").unwrap_or_default();
        let values = match node.attribute("format") {
            Some("ascii") => self.text_values(node)?,
            Some("binary") => {
                let encoded = node.text().unwrap_or_default().as_bytes();
                self.base64_values(node, kind, encoded)?
            }
            Some("appended") => self.appended_values(node, kind)?,
            _ => return Err(self.at(node, "an array's format is none of ascii, binary, appended")),
        };
        let components = node
            .attribute("NumberOfComponents")
            .and_then(|count| count.parse().ok());
        Ok(DataArray {
            name: node.attribute("Name").unwrap_or_default().to_string(),
            components: components.unwrap_or(1),
            is_integer: kind.contains("Int"),
            line: self.line_of(node),
            values,
        })
    }

    fn at(&self, node: Node, what: impl Into<String>) -> MeshFileError {
        FileLine::line(self.path, self.line_of(node)).error(what)
    }

    fn text_values(&self, node: Node) -> Result<Vec<f64>, MeshFileError> {
        let Some(content) = node.first_child().filter(Node::is_text) else {
            return Ok(Vec::new());
        };
        let first = self.line_of(content);
        let mut values = Vec::new();
        for (line, row) in (first..).zip(content.text().unwrap_or_default().lines()) {
            for word in row.split_ascii_whitespace() {
                values.push(text::number(self.path, line, word)?);
            }
        }
        Ok(values)
    }

    fn appended_values(&self, node: Node, kind: &str) -> Result<Vec<f64>, MeshFileError> {
        let offset = node
            .attribute("offset")
            .and_then(|offset| offset.parse::<usize>().ok());
        let bytes = offset
            .and_then(|offset| self.source.appended?.get(offset..))
            .ok_or_else(|| self.at(node, "an array's offset lies outside the appended data"))?;
        if self.source.appended_is_raw {
            self.binary_values(node, kind, bytes)
        } else {
            self.base64_values(node, kind, bytes)
        }
    }

    fn base64_values(
        &self,
        node: Node,
        kind: &str,
        encoded: &[u8],
    ) -> Result<Vec<f64>, MeshFileError> {
        let bytes = self.layout.decoded(encoded);
        self.binary_values(node, kind, &bytes.map_err(|what| self.at(node, what))?)
    }

    fn binary_values(
        &self,
        node: Node,
        kind: &str,
        bytes: &[u8],
    ) -> Result<Vec<f64>, MeshFileError> {
        let left = self.values_left.get();
        let values = self.layout.values(kind, bytes, left);
        let values = values.map_err(|what| self.at(node, what))?;
        self.values_left.set(left - values.len());
        Ok(values)
    }
}

/// How the file that `root` describes lays out its binary arrays.
fn layout(root: Node) -> Result<BinaryLayout, String> {
    let zlib = match root.attribute("compressor") {
        None => false,
        Some("vtkZLibDataCompressor") => true,
        Some(other) => {
            return Err(format!(
                "is compressed by {other}; save it with zlib or uncompressed"
            ));
        }
    };
    let is_long = root.attribute("header_type") == Some("UInt64");
    Ok(BinaryLayout {
        count_bytes: if is_long { 8 } else { 4 },
        big_endian: root.attribute("byte_order") == Some("BigEndian"),
        zlib,
    })
}

const CUT_OFF: &str = "an array ends before its announced length; was it cut off?";

/// How a file lays out its binary arrays.
pub(super) struct BinaryLayout {
    /// Bytes of a count.
    pub(super) count_bytes: usize,
    pub(super) big_endian: bool,
    pub(super) zlib: bool,
}

impl BinaryLayout {
    /// Values of the array that `bytes` start with, at most `most` of them.
    pub(super) fn values(&self, kind: &str, bytes: &[u8], most: usize) -> Result<Vec<f64>, String> {
        let (size, decode) =
            decoder(kind).ok_or_else(|| format!("an array's type {kind:?} is not known"))?;
        let inflated;
        let data = if self.zlib {
            inflated = self.inflate(bytes, most.saturating_mul(size))?;
            inflated.as_slice()
        } else {
            self.whole_length(bytes)
                .and_then(|end| bytes.get(self.count_bytes..end))
                .ok_or(CUT_OFF)?
        };
        if data.len() / size > most {
            return Err(too_many());
        }
        Ok(decode(data, self.big_endian))
    }

    /// The bytes of the array that base64 starts with; what is encoded behind it is left.
    pub(super) fn decoded(&self, encoded: &[u8]) -> Result<Vec<u8>, String> {
        let mut wanted = self.count_bytes;
        loop {
            let bytes = base64_bytes(encoded, wanted)?;
            let length = self.whole_length(&bytes).unwrap_or_default();
            if length <= wanted || bytes.len() < wanted {
                return Ok(bytes);
            }
            wanted = length;
        }
    }

    /// How long the array is with its counts, as far as `bytes` say: a compressed one has
    /// first the number of its counts.
    fn whole_length(&self, bytes: &[u8]) -> Option<usize> {
        let first = self.count(bytes, 0)?;
        if !self.zlib {
            return first.checked_add(self.count_bytes);
        }
        let counts = first.checked_add(3)?.checked_mul(self.count_bytes)?;
        if counts > bytes.len() {
            return Some(counts);
        }
        (0..first).try_fold(counts, |end, block| {
            end.checked_add(self.count(bytes, 3 + block)?)
        })
    }

    fn count(&self, bytes: &[u8], index: usize) -> Option<usize> {
        let start = index.checked_mul(self.count_bytes)?;
        let bytes = bytes.get(start..start.checked_add(self.count_bytes)?)?;
        let fold = |value: usize, &byte: &u8| value << 8 | usize::from(byte);
        Some(if self.big_endian {
            bytes.iter().fold(0, fold)
        } else {
            bytes.iter().rev().fold(0, fold)
        })
    }

    fn inflate(&self, bytes: &[u8], most: usize) -> Result<Vec<u8>, String> {
        let count = |index| self.count(bytes, index).ok_or(CUT_OFF);
        let blocks = count(0)?;
        if blocks == 0 {
            return Ok(Vec::new());
        }
        let (full, last) = (count(1)?, count(2)?);
        let counts = blocks
            .checked_add(3)
            .and_then(|n| n.checked_mul(self.count_bytes));
        let mut start = counts.ok_or(CUT_OFF)?;
        let mut data = Vec::new();
        for block in 0..blocks {
            // A last block of size 0 is as large as the others.
            let is_partial = block + 1 == blocks && last > 0;
            let announced = if is_partial { last } else { full };
            let end = start.checked_add(count(3 + block)?);
            let packed = end.and_then(|end| bytes.get(start..end)).ok_or(CUT_OFF)?;
            inflate_block(packed, announced, most, &mut data)?;
            start += packed.len();
        }
        Ok(data)
    }
}

/// Adds a block to `data`; a few bytes can hold a thousand times as many, so that what comes
/// out is bounded as it comes.
fn inflate_block(
    packed: &[u8],
    announced: usize,
    most: usize,
    data: &mut Vec<u8>,
) -> Result<(), String> {
    let room = most - data.len();
    let stop = announced.min(room).saturating_add(1);
    let decoder = flate2::read::ZlibDecoder::new(packed);
    let found = decoder
        .take(stop as u64)
        .read_to_end(data)
        .map_err(|_| CUT_OFF)?;
    if found > announced {
        return Err(format!(
            "an array has a compressed block of more than its announced {announced} bytes; \
             save the file again"
        ));
    }
    if found > room {
        return Err(too_many());
    }
    Ok(())
}

fn too_many() -> String {
    "an array unpacks to more values than a mesh in a file of this length has; save the file uncompressed"
        .to_owned()
}

/// The first bytes in base64, `wanted` or up to three more; the counts and the values may each be
/// padded on their own.
fn base64_bytes(encoded: &[u8], wanted: usize) -> Result<Vec<u8>, String> {
    let characters = wanted.div_ceil(3).saturating_add(1).saturating_mul(4);
    let filled = encoded.iter().copied().take_while(|&byte| byte != b'<');
    let filled = filled.filter(|byte| !byte.is_ascii_whitespace());
    let encoded: Vec<u8> = filled.take(characters).collect();
    let mut rest = encoded.as_slice();
    let mut bytes = Vec::with_capacity(rest.len() / 4 * 3);
    while !rest.is_empty() {
        let padding = rest.iter().position(|&byte| byte == b'=');
        let padding = padding.unwrap_or(rest.len());
        // At least one group of four, so that a padding out of place is decoded, and refused.
        let end = padding.next_multiple_of(4).max(4).min(rest.len());
        let (segment, after) = rest.split_at(end);
        STANDARD
            .decode_vec(segment, &mut bytes)
            .map_err(|error| format!("an array's base64 is broken: {error}"))?;
        rest = after;
    }
    Ok(bytes)
}

type Decoder = fn(&[u8], bool) -> Vec<f64>;

/// Bytes of a value of that type, and what makes numbers of them.
fn decoder(kind: &str) -> Option<(usize, Decoder)> {
    macro_rules! of {
        ($number:ty) => {
            (size_of::<$number>(), |bytes, big_endian| {
                let values = bytes.as_chunks::<{ size_of::<$number>() }>().0.iter();
                let from = if big_endian {
                    <$number>::from_be_bytes
                } else {
                    <$number>::from_le_bytes
                };
                values.map(|&value| from(value) as f64).collect()
            })
        };
    }
    Some(match kind {
        "Float32" => of!(f32),
        "Float64" => of!(f64),
        "Int8" => of!(i8),
        "UInt8" => of!(u8),
        "Int16" => of!(i16),
        "UInt16" => of!(u16),
        "Int32" => of!(i32),
        "UInt32" => of!(u32),
        "Int64" => of!(i64),
        "UInt64" => of!(u64),
        _ => return None,
    })
}
