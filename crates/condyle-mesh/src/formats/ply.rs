//! PLY, text and binary of both byte orders, parsed by `ply-rs-bw`.

use std::{io::Cursor, path::Path};

use ply_rs_bw::{
    parser::{ParseError, Parser, Reader},
    ply::{Encoding, Header, Property, PropertyAccess, PropertyAccessResult},
};

use super::{
    error::MeshFileError,
    surface_draft::{SurfaceDraft, no_triangles},
    text::At,
};
use crate::TriangleMesh;

/// A row of any element: its properties that belong to a point or to a polygon.
struct PlyElement {
    point: [f64; 3],
    corners: Vec<i64>,
}

impl PropertyAccess for PlyElement {
    fn new() -> Self {
        Self {
            // A file without, say, z must not be read as flat.
            point: [f64::NAN; 3],
            corners: Vec::new(),
        }
    }

    fn set_property(&mut self, name: &str, value: Property) -> PropertyAccessResult {
        match name {
            "x" => self.point[0] = scalar(&value),
            "y" => self.point[1] = scalar(&value),
            "z" => self.point[2] = scalar(&value),
            "vertex_indices" | "vertex_index" => self.corners = list(value),
            _ => return PropertyAccessResult::Ignored,
        }
        PropertyAccessResult::Set
    }
}

fn scalar(value: &Property) -> f64 {
    match *value {
        Property::Char(v) => v.into(),
        Property::UChar(v) => v.into(),
        Property::Short(v) => v.into(),
        Property::UShort(v) => v.into(),
        Property::Int(v) => v.into(),
        Property::UInt(v) => v.into(),
        Property::Float(v) => v.into(),
        Property::Double(v) => v,
        _ => f64::NAN,
    }
}

fn list(value: Property) -> Vec<i64> {
    match value {
        Property::ListChar(v) => v.into_iter().map(i64::from).collect(),
        Property::ListUChar(v) => v.into_iter().map(i64::from).collect(),
        Property::ListShort(v) => v.into_iter().map(i64::from).collect(),
        Property::ListUShort(v) => v.into_iter().map(i64::from).collect(),
        Property::ListInt(v) => v.into_iter().map(i64::from).collect(),
        Property::ListUInt(v) => v.into_iter().map(i64::from).collect(),
        _ => Vec::new(),
    }
}

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let parser = Parser::<PlyElement>::new();
    let mut reader = Reader::new(Cursor::new(bytes));
    let header = parser.read_header(&mut reader);
    let header = header.map_err(|error| located(path, &error))?;
    check_header(path, bytes, &header)?;
    let mut draft = SurfaceDraft::new(path, 0);
    for element in header.elements.values() {
        let first_line = reader.line();
        let rows = parser.read_payload_for_element(&mut reader, element, &header);
        let rows = rows.map_err(|error| located(path, &error))?;
        for (index, row) in rows.iter().enumerate() {
            let line = (header.encoding == Encoding::Ascii).then_some(first_line + index);
            let at = At { path, line };
            match element.name.as_str() {
                "vertex" => draft.point(at, row.point)?,
                "face" => draft.polygon(at, &row.corners)?,
                _ => {}
            }
        }
    }
    draft.finish()
}

fn check_header(path: &Path, bytes: &[u8], header: &Header) -> Result<(), MeshFileError> {
    let has = |element: &str, property: &str| {
        let element = header.elements.get(element);
        element.is_some_and(|element| element.properties.contains_key(property))
    };
    if !["x", "y", "z"].iter().all(|axis| has("vertex", axis)) {
        let problem = "the header has no element vertex with properties x, y and z";
        return Err(At::file(path).error(problem));
    }
    if !has("face", "vertex_indices") && !has("face", "vertex_index") {
        return Err(no_triangles(path));
    }
    // A row takes at least a byte, except that one without properties takes none in a binary file:
    // without this bound a few bytes could announce any number of rows.
    let mut left = bytes.len();
    for (name, element) in &header.elements {
        left = left.checked_sub(element.count).ok_or_else(|| {
            let announces = |row: &[u8]| {
                let words = row.split(u8::is_ascii_whitespace);
                let mut words = words.filter(|word| !word.is_empty());
                words.next() == Some(b"element") && words.next() == Some(name.as_bytes())
            };
            let row = bytes.split(|&byte| byte == b'\n').position(announces);
            let line = row.map(|row| row + 1);
            At { path, line }.error(format!(
                "announces {} rows of element {name}, more than a file of {} bytes can hold; \
                 was it cut off?",
                element.count,
                bytes.len()
            ))
        })?;
    }
    Ok(())
}

/// Returns the parser's error in one line, its line number as the place.
fn located(path: &Path, error: &ParseError) -> MeshFileError {
    let (line, message) = (error.line(), error.to_string());
    let prefix = line.map(|line| format!("Line {line}: "));
    let message = message
        .strip_prefix(&prefix.unwrap_or_default())
        .unwrap_or(&message);
    let words: Vec<&str> = message.split_whitespace().collect();
    At { path, line }.error(format!("is not PLY: {}", words.join(" ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::tests::{message, tetrahedron};

    const TEXT: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\n\
        property float x\nproperty float y\nproperty float z\nproperty uchar red\n\
        element face 4\nproperty list uchar int vertex_indices\nend_header\n\
        0 0 0 9\n1 0 0 9\n0 1 0 9\n0 0 1 9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

    fn read(bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
        parse(Path::new("a.ply"), bytes)
    }

    fn binary(order: &str, float: fn(f64) -> [u8; 8], int: fn(u32) -> [u8; 4]) -> Vec<u8> {
        let mut bytes = format!(
            "ply\nformat binary_{order}_endian 1.0\nelement vertex 4\nproperty double x\n\
             property double y\nproperty double z\nelement face 4\n\
             property list uchar uint vertex_index\nend_header\n"
        )
        .into_bytes();
        let mesh = tetrahedron();
        bytes.extend(
            mesh.vertices
                .iter()
                .flat_map(|v| [v.x, v.y, v.z])
                .flat_map(float),
        );
        for triangle in mesh.triangles {
            bytes.push(3);
            bytes.extend(triangle.into_iter().flat_map(int));
        }
        bytes
    }

    #[test]
    fn text_and_both_byte_orders_are_read() {
        assert_eq!(read(TEXT.as_bytes()).unwrap(), tetrahedron());
        let little = binary("little", f64::to_le_bytes, u32::to_le_bytes);
        assert_eq!(read(&little).unwrap(), tetrahedron());
        let big = binary("big", f64::to_be_bytes, u32::to_be_bytes);
        assert_eq!(read(&big).unwrap(), tetrahedron());
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let reported = |from, to| message(read(TEXT.replace(from, to).as_bytes()));
        let parse = reported("3 0 1 3", "3 0 one 3");
        assert!(
            parse.starts_with("a.ply:17: is not PLY: Couldn't read"),
            "{parse}"
        );
        let range = reported("3 1 2 3", "3 1 2 4");
        assert!(
            range.starts_with("a.ply:18: polygon 2 names vertex 4"),
            "{range}"
        );
        let infinite = reported("0 1 0 9", "0 1e999 0 9");
        assert!(infinite.starts_with("a.ply:14: vertex 2 has"), "{infinite}");
        let short = reported("3 2 0 3\n", "");
        assert!(short.contains("end of file"), "{short}");
        assert!(reported("float z", "float w").contains("properties x, y and z"));
        assert!(reported("vertex_indices", "neighbours").contains("holds no triangles"));
        assert!(reported("ply\n", "plywood\n").contains("is not PLY"));
    }

    #[test]
    fn a_cut_off_binary_file_is_an_error() {
        let bytes = binary("little", f64::to_le_bytes, u32::to_le_bytes);
        assert!(message(read(&bytes[..bytes.len() - 5])).starts_with("a.ply"));
    }

    #[test]
    fn rows_that_the_file_cannot_hold_are_refused() {
        let bytes = binary("little", f64::to_le_bytes, u32::to_le_bytes);
        let header = |from: &str, to: &str| {
            let end = bytes
                .windows(10)
                .position(|word| word == b"end_header")
                .unwrap();
            let text = String::from_utf8(bytes[..end].to_vec()).unwrap();
            [text.replace(from, to).as_bytes(), &bytes[end..]].concat()
        };
        let reported = message(read(&header(
            "element face",
            "element empty 4000000000\nelement face",
        )));
        let expected = "a.ply:7: announces 4000000000 rows of element empty, more than a file of \
            344 bytes can hold; was it cut off?";
        assert_eq!(reported, expected);
        let many = message(read(&header("vertex 4", "vertex 4000000000")));
        assert!(
            many.starts_with("a.ply:3: announces 4000000000 rows"),
            "{many}"
        );
        let rows = ["a", "b"]
            .map(|name| format!("element {name} 300\n"))
            .concat();
        let sum = message(read(&header(
            "element face",
            &format!("{rows}element face"),
        )));
        assert!(
            sum.starts_with("a.ply:8: announces 300 rows of element b"),
            "{sum}"
        );
        let none = header("element face", "element none 0\nelement face");
        assert_eq!(read(&none).unwrap(), tetrahedron());
    }

    #[test]
    fn a_binary_coordinate_that_is_not_finite_is_an_error() {
        let bytes = binary("little", |v| (v / 0.0).to_le_bytes(), u32::to_le_bytes);
        let reported = message(read(&bytes));
        assert!(reported.starts_with("a.ply: vertex 0 has"), "{reported}");
    }
}
