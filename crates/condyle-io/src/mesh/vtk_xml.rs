//! The XML container of VTK's files: data arrays as text, base64 or appended bytes.
//!
//! Layout after VTK's "File Formats" document: a binary array is a byte count and the values;
//! a compressed one is the number of blocks, the size of a block, the size of the last block,
//! the compressed sizes, and the blocks.

use std::io::Read;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use roxmltree::{Document, Node};

use super::error::{FileLine, MeshFileError};
use super::text;

const APPENDED: &[u8] = b"<AppendedData";

/// A file cut into its XML and the bytes appended to it, which may be no XML at all.
pub(crate) struct VtkSource<'a> {
    xml: String,
    appended: Option<&'a [u8]>,
    appended_is_raw: bool,
}

impl<'a> VtkSource<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        let Some(start) = find(bytes, APPENDED) else {
            let xml = text::decode(bytes).into_owned();
            return Self {
                xml,
                appended: None,
                appended_is_raw: false,
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
        }
    }
}

fn find(bytes: &[u8], pattern: &[u8]) -> Option<usize> {
    bytes
        .windows(pattern.len())
        .position(|window| window == pattern)
}

/// The parsed XML with what is needed to decode its arrays.
pub(crate) struct VtkDocument<'a> {
    path: &'a Path,
    document: Document<'a>,
    source: &'a VtkSource<'a>,
    count_bytes: usize,
    big_endian: bool,
    zlib: bool,
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
        let zlib = match root.attribute("compressor") {
            None => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                let what = format!("is compressed by {other}; save it with zlib or uncompressed");
                return Err(FileLine::file(path).error(what));
            }
        };
        let count_bytes = if root.attribute("header_type") == Some("UInt64") {
            8
        } else {
            4
        };
        let big_endian = root.attribute("byte_order") == Some("BigEndian");
        Ok(Self {
            path,
            document,
            source,
            count_bytes,
            big_endian,
            zlib,
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
        self.document.text_pos_at(node.range().start).row as usize
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
                let bytes = self.base64(node, node.text().unwrap_or_default().as_bytes())?;
                self.binary_values(node, kind, &bytes)?
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
            return self.binary_values(node, kind, bytes);
        }
        let end = find(bytes, b"<").unwrap_or(bytes.len());
        let bytes = self.base64(node, &bytes[..end])?;
        self.binary_values(node, kind, &bytes)
    }

    /// Decodes base64; the byte count and the values may each be padded on their own.
    fn base64(&self, node: Node, encoded: &[u8]) -> Result<Vec<u8>, MeshFileError> {
        let mut rest = encoded.to_vec();
        rest.retain(|byte| !byte.is_ascii_whitespace());
        let mut rest = rest.as_slice();
        let mut bytes = Vec::with_capacity(rest.len() / 4 * 3);
        while !rest.is_empty() {
            let padding = rest
                .iter()
                .position(|&byte| byte == b'=')
                .unwrap_or(rest.len());
            // At least one group of four, so that a padding out of place is decoded, and refused.
            let end = padding.next_multiple_of(4).max(4).min(rest.len());
            let (segment, after) = rest.split_at(end);
            STANDARD
                .decode_vec(segment, &mut bytes)
                .map_err(|error| self.at(node, format!("an array's base64 is broken: {error}")))?;
            rest = after;
        }
        Ok(bytes)
    }

    fn binary_values(
        &self,
        node: Node,
        kind: &str,
        bytes: &[u8],
    ) -> Result<Vec<f64>, MeshFileError> {
        let cut_off = || {
            self.at(
                node,
                "an array ends before its announced length; was it cut off?",
            )
        };
        let decode = decoder(kind)
            .ok_or_else(|| self.at(node, format!("an array's type {kind:?} is not known")))?;
        let inflated;
        let data = if self.zlib {
            inflated = self.inflate(bytes).ok_or_else(cut_off)?;
            inflated.as_slice()
        } else {
            let length = self.count(bytes, 0).ok_or_else(cut_off)?;
            let end = length.checked_add(self.count_bytes).ok_or_else(cut_off)?;
            bytes.get(self.count_bytes..end).ok_or_else(cut_off)?
        };
        Ok(decode(data, self.big_endian))
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

    fn inflate(&self, bytes: &[u8]) -> Option<Vec<u8>> {
        let blocks = self.count(bytes, 0)?;
        if blocks == 0 {
            return Some(Vec::new());
        }
        let mut start = blocks.checked_add(3)?.checked_mul(self.count_bytes)?;
        let mut data = Vec::new();
        for block in 0..blocks {
            let end = start.checked_add(self.count(bytes, 3 + block)?)?;
            let mut decoder = flate2::read::ZlibDecoder::new(bytes.get(start..end)?);
            decoder.read_to_end(&mut data).ok()?;
            start = end;
        }
        Some(data)
    }
}

type Decoder = fn(&[u8], bool) -> Vec<f64>;

fn decoder(kind: &str) -> Option<Decoder> {
    macro_rules! of {
        ($number:ty) => {
            |bytes, big_endian| {
                let values = bytes.as_chunks::<{ size_of::<$number>() }>().0.iter();
                let from = if big_endian {
                    <$number>::from_be_bytes
                } else {
                    <$number>::from_le_bytes
                };
                values.map(|&value| from(value) as f64).collect()
            }
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
