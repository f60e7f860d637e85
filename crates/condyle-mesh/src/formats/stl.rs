//! STL, binary and text: triangles without connections, welded on the way in.

use std::io::{self, Write};
use std::path::Path;

use crate::TriangleMesh;
use crate::Vec3;

use super::error::{FileLine, MeshFileError};
use super::surface_draft::SurfaceDraft;
use super::text;

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    if is_text(bytes) {
        parse_text(path, &text::decode(bytes))
    } else {
        parse_binary(path, bytes)
    }
}

/// Many binary files start with `solid` too, so the length that the count asks for decides first.
fn is_text(bytes: &[u8]) -> bool {
    let starts_solid = bytes.trim_ascii_start().starts_with(b"solid");
    let binary_length =
        announced_triangles(bytes).map(|triangles| HEADER_BYTES + TRIANGLE_BYTES * triangles);
    starts_solid && binary_length != Some(bytes.len())
}

fn announced_triangles(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER_BYTES)?.try_into().ok()?;
    Some(u32::from_le_bytes(count) as usize)
}

fn parse_binary(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let announced = announced_triangles(bytes).ok_or_else(|| {
        FileLine::file(path).error("is too short for an STL file; was it cut off?")
    })?;
    let records = bytes[HEADER_BYTES..].chunks_exact(TRIANGLE_BYTES);
    if records.len() < announced {
        let what = format!(
            "announces {announced} triangles but ends after {}; was it cut off?",
            records.len()
        );
        return Err(FileLine::file(path).error(what));
    }
    let mut draft = SurfaceDraft::new(path, 0);
    for record in records.take(announced) {
        // 12 bytes of normal, then three corners; the order of the corners says the normal again.
        for corner in record[12..48].chunks_exact(12) {
            draft.point(None, single_precision(corner))?;
        }
        close_triangle(&mut draft, None)?;
    }
    draft.finish()
}

fn single_precision(bytes: &[u8]) -> [f64; 3] {
    [0, 4, 8].map(|at| {
        let value = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
        f64::from(f32::from_le_bytes(value))
    })
}

fn close_triangle(draft: &mut SurfaceDraft, line: Option<usize>) -> Result<(), MeshFileError> {
    let end = draft.points() as i64;
    draft.polygon(line, &[end - 3, end - 2, end - 1])
}

fn parse_text(path: &Path, content: &str) -> Result<TriangleMesh, MeshFileError> {
    let mut draft = SurfaceDraft::new(path, 0);
    let mut facet_start = 0;
    for (line, row) in (1..).zip(content.lines()) {
        let mut words = row.split_ascii_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("facet") => facet_start = draft.points(),
            Some("vertex") => {
                let point = text::coordinates(path, line, &mut words)?;
                draft.point(Some(line), point)?;
            }
            Some("endfacet") => close_facet(path, line, facet_start, &mut draft)?,
            None | Some("solid" | "outer" | "endloop" | "endsolid") => {}
            Some(word) => {
                let what = format!("{word:?} is not a word of STL");
                return Err(FileLine::line(path, line).error(what));
            }
        }
    }
    draft.finish()
}

fn close_facet(
    path: &Path,
    line: usize,
    facet_start: usize,
    draft: &mut SurfaceDraft,
) -> Result<(), MeshFileError> {
    let corners = draft.points() - facet_start;
    if corners != 3 {
        let what = format!("a facet ends here with {corners} vertices; STL facets have three");
        return Err(FileLine::line(path, line).error(what));
    }
    close_triangle(draft, Some(line))
}

/// Writes a surface as binary STL: single precision, normals from the corners.
///
/// # Errors
/// Those of `out`.
pub fn write_stl(mut out: impl Write, mesh: &TriangleMesh) -> io::Result<()> {
    let mut header = [b' '; HEADER_BYTES];
    header[..7].copy_from_slice(b"condyle");
    header[80..].copy_from_slice(&(mesh.triangles.len() as u32).to_le_bytes());
    out.write_all(&header)?;
    for triangle in 0..mesh.triangles.len() {
        out.write_all(&record(mesh.corners(triangle)))?;
    }
    Ok(())
}

fn record([a, b, c]: [Vec3; 3]) -> [u8; TRIANGLE_BYTES] {
    let normal = (b - a)
        .cross(&(c - a))
        .try_normalize(0.0)
        .unwrap_or_default();
    let mut bytes = [0; TRIANGLE_BYTES];
    let values = [normal, a, b, c]
        .into_iter()
        .flat_map(|point| [point.x, point.y, point.z]);
    for (slot, value) in bytes.chunks_exact_mut(4).zip(values) {
        slot.copy_from_slice(&(value as f32).to_le_bytes());
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::fixtures::{corners, message, tetrahedron};

    const TEXT: &str = "solid wedge\n facet normal 0 0 -1\n  outer loop\n   vertex 0 0 0\n   \
        vertex 0 1e0 0\n   vertex 1 0 0\n  endloop\n endfacet\nendsolid wedge\n";

    fn read(bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
        parse(Path::new("a.stl"), bytes)
    }

    fn binary() -> Vec<u8> {
        let mut bytes = Vec::new();
        write_stl(&mut bytes, &tetrahedron()).unwrap();
        bytes
    }

    #[test]
    fn binary_comes_back_welded() {
        let mesh = read(&binary()).unwrap();
        assert_eq!(corners(&mesh), corners(&tetrahedron()));
        assert_eq!(mesh.vertices.len(), 4);
    }

    #[test]
    fn binary_that_starts_with_solid_is_still_binary() {
        let mut bytes = binary();
        bytes[..6].copy_from_slice(b"solid ");
        let mesh = read(&bytes).unwrap();
        assert_eq!(corners(&mesh), corners(&tetrahedron()));
        assert_eq!(mesh.vertices.len(), 4);
    }

    #[test]
    fn text_is_read() {
        let mesh = read(TEXT.as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(mesh.vertices[1], Vec3::new(0.0, 1.0, 0.0));
    }

    #[test]
    fn negative_zero_is_welded_to_zero() {
        let second = TEXT.replace("vertex 0 0 0", "vertex -0 0 0");
        let mesh = read(format!("{TEXT}{second}").as_bytes()).unwrap();
        assert_eq!(mesh.vertices.len(), 3);
    }

    #[test]
    fn a_cut_off_binary_file_says_so() {
        let bytes = binary();
        let said = message(read(&bytes[..bytes.len() - 10]));
        assert_eq!(
            said,
            "a.stl: announces 4 triangles but ends after 3; was it cut off?"
        );
        assert!(message(read(&bytes[..40])).contains("too short"));
    }

    #[test]
    fn bad_text_is_named_with_its_line() {
        let said = |from, to| message(read(TEXT.replace(from, to).as_bytes()));
        assert_eq!(said("1e0", "one"), "a.stl:5: \"one\" is not a number here");
        assert_eq!(
            said("outer", "inner"),
            "a.stl:3: \"inner\" is not a word of STL"
        );
        assert!(said(" 1e0 0", " 1").starts_with("a.stl:5: a point needs three"));
        assert!(said("vertex 1 0 0", "").starts_with("a.stl:8: a facet ends here with 2"));
    }

    #[test]
    fn a_coordinate_that_is_not_finite_is_an_error() {
        let said = message(read(TEXT.replace("1e0", "nan").as_bytes()));
        assert!(
            said.starts_with("a.stl:5: vertex 1 has a coordinate"),
            "{said}"
        );
        let mut bytes = binary();
        bytes[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert!(message(read(&bytes)).starts_with("a.stl: vertex 0 has a coordinate"));
    }

    #[test]
    fn no_triangles_is_an_error() {
        let said = message(read(b"solid nothing\nendsolid nothing\n"));
        assert!(said.starts_with("a.stl: holds no triangles"), "{said}");
    }
}
