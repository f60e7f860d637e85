//! STL, binary and text: triangles without connections, welded on the way in.

use std::{
    io::{self, Write},
    path::Path,
};

use super::{
    error::MeshFileError,
    surface_draft::SurfaceDraft,
    text::{At, Rows, decode},
};
use crate::TriangleMesh;

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let count = bytes.get(80..HEADER_BYTES).and_then(|c| c.try_into().ok());
    let announced = count.map(|count| u32::from_le_bytes(count) as usize);
    let binary_length = announced.map(|triangles| HEADER_BYTES + TRIANGLE_BYTES * triangles);
    // Many binary files start with `solid` too, so the length that the count implies decides first.
    if bytes.trim_ascii_start().starts_with(b"solid") && binary_length != Some(bytes.len()) {
        return parse_text(path, &decode(bytes));
    }
    let announced = announced
        .ok_or_else(|| At::file(path).error("is too short for an STL file; was it cut off?"))?;
    let at = At::file(path);
    let records = bytes[HEADER_BYTES..].chunks_exact(TRIANGLE_BYTES);
    if records.len() < announced {
        return Err(at.error(format!(
            "announces {announced} triangles but ends after {}; was it cut off?",
            records.len()
        )));
    }
    let mut draft = SurfaceDraft::new(path, 0);
    for record in records.take(announced) {
        // Twelve bytes of normal, which follows from the order of the corners, then the three corners.
        for corner in record[12..48].as_chunks::<12>().0 {
            let [x, y, z] =
                [0, 4, 8].map(|i| f32::from_le_bytes([0, 1, 2, 3].map(|k| corner[i + k])));
            draft.point(at, [x.into(), y.into(), z.into()])?;
        }
        draft.triangle_of_last_points(at)?;
    }
    draft.finish()
}

fn parse_text(path: &Path, content: &str) -> Result<TriangleMesh, MeshFileError> {
    let mut draft = SurfaceDraft::new(path, 0);
    let mut facet_start = 0;
    for (at, row) in Rows::new(path, content) {
        let mut words = row.split_ascii_whitespace();
        let keyword = words.next().unwrap_or_default().to_ascii_lowercase();
        match keyword.as_str() {
            "facet" => facet_start = draft.points(),
            "vertex" => draft.point(at, at.coordinates(words)?)?,
            "endfacet" if draft.points() == facet_start + 3 => draft.triangle_of_last_points(at)?,
            "endfacet" => {
                let corners = draft.points() - facet_start;
                return Err(at.error(format!(
                    "a facet ends here with {corners} vertices; STL facets have three"
                )));
            }
            "" | "solid" | "outer" | "endloop" | "endsolid" => {}
            word => return Err(at.error(format!("{word:?} is not a keyword of STL"))),
        }
    }
    draft.finish()
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
        let [a, b, c] = mesh.corners(triangle);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
        let mut record = [0; TRIANGLE_BYTES];
        let rows = [normal.unwrap_or_default(), a, b, c];
        let values = rows.iter().flat_map(|row| [row.x, row.y, row.z]);
        for (slot, value) in record.chunks_exact_mut(4).zip(values) {
            slot.copy_from_slice(&(value as f32).to_le_bytes());
        }
        out.write_all(&record)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;
    use crate::formats::tests::{corners, message, tetrahedron};

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
    fn a_truncated_binary_file_is_an_error() {
        let bytes = binary();
        let reported = message(read(&bytes[..bytes.len() - 10]));
        assert_eq!(
            reported,
            "a.stl: announces 4 triangles but ends after 3; was it cut off?"
        );
        assert!(message(read(&bytes[..40])).contains("too short"));
    }

    #[test]
    fn bad_text_is_named_with_its_line() {
        let reported = |from, to| message(read(TEXT.replace(from, to).as_bytes()));
        assert_eq!(
            reported("1e0", "one"),
            "a.stl:5: \"one\" is not a number here"
        );
        assert_eq!(
            reported("outer", "inner"),
            "a.stl:3: \"inner\" is not a keyword of STL"
        );
        assert!(reported(" 1e0 0", " 1").starts_with("a.stl:5: a point needs three"));
        assert!(reported("vertex 1 0 0", "").starts_with("a.stl:8: a facet ends here with 2"));
    }

    #[test]
    fn a_coordinate_that_is_not_finite_is_an_error() {
        let reported = message(read(TEXT.replace("1e0", "nan").as_bytes()));
        assert!(
            reported.starts_with("a.stl:5: vertex 1 has a coordinate"),
            "{reported}"
        );
        let mut bytes = binary();
        bytes[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert!(message(read(&bytes)).starts_with("a.stl: vertex 0 has a coordinate"));
    }

    #[test]
    fn no_triangles_is_an_error() {
        let reported = message(read(b"solid nothing\nendsolid nothing\n"));
        assert!(
            reported.starts_with("a.stl: holds no triangles"),
            "{reported}"
        );
    }
}
