//! Wavefront OBJ: `v` and `f` rows; normals, texture, groups and materials are passed over.

use std::path::Path;

use crate::TriangleMesh;

use super::error::MeshFileError;
use super::surface_draft::SurfaceDraft;
use super::text;

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let mut draft = SurfaceDraft::new(path, 1);
    for (line, row) in joined_rows(&text::decode(bytes)) {
        let row = row.split('#').next().unwrap_or_default();
        let mut words = row.split_ascii_whitespace();
        match words.next() {
            Some("v") => draft.point(Some(line), text::coordinates(path, line, &mut words)?)?,
            Some("f") => {
                let corners = corners(path, line, draft.points(), words)?;
                draft.polygon(Some(line), &corners)?;
            }
            _ => {}
        }
    }
    draft.finish()
}

/// Rows with the line they start on; a backslash at the end joins the next line on.
fn joined_rows(content: &str) -> Vec<(usize, String)> {
    let mut rows: Vec<(usize, String)> = Vec::new();
    let mut open = false;
    for (line, text) in (1..).zip(content.lines()) {
        let (text, continues) = text
            .strip_suffix('\\')
            .map_or((text, false), |text| (text, true));
        match rows.last_mut().filter(|_| open) {
            Some((_, row)) => {
                row.push(' ');
                row.push_str(text);
            }
            None => rows.push((line, text.to_string())),
        }
        open = continues;
    }
    rows
}

/// Vertex numbers out of `7`, `7/1`, `7//3`, `7/1/3`; a negative one counts back from the last.
fn corners<'w>(
    path: &Path,
    line: usize,
    points: usize,
    words: impl Iterator<Item = &'w str>,
) -> Result<Vec<i64>, MeshFileError> {
    words
        .map(|word| {
            let vertex = word.split('/').next().unwrap_or_default();
            let index: i64 = text::number(path, line, vertex)?;
            Ok(if index < 0 {
                points as i64 + 1 + index
            } else {
                index
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::fixtures::message;

    fn read(content: &str) -> Result<TriangleMesh, MeshFileError> {
        parse(Path::new("a.obj"), content.as_bytes())
    }

    const SQUARE: &str =
        "# made by hand\no square\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n";

    #[test]
    fn a_quad_becomes_a_fan_of_two_triangles() {
        let mesh = read(&format!("{SQUARE}f 1//1 2//1 3//1 4//1\n")).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.vertices[2].as_slice(), [1.0, 1.0, 0.0]);
    }

    #[test]
    fn negative_numbers_count_back_and_a_backslash_continues() {
        let mesh = read(&format!("{SQUARE}f -4/1 -3/2 \\\n -2/3\n")).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(
            mesh.vertices.len(),
            3,
            "the point no triangle uses is dropped"
        );
    }

    #[test]
    fn a_row_of_many_lines_is_read_in_time() {
        let blank = "\\\n".repeat(450_000);
        let mesh = read(&format!("{SQUARE}f 1 2 {blank} 3\n")).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
    }

    #[test]
    fn a_vertex_that_is_not_there_is_named_with_its_line() {
        let said = message(read(&format!("{SQUARE}f 1 2 3\nf 1 2 9\n")));
        let expected =
            "a.obj:9: polygon 2 names vertex 9, but the file numbers its vertices from 1 to 4";
        assert_eq!(said, expected);
        let said = message(read(&format!("{SQUARE}f 0 1 2\n")));
        assert!(said.contains("names vertex 0"), "{said}");
    }

    #[test]
    fn bad_rows_are_named_with_their_line() {
        assert!(message(read("v 0 0\n")).starts_with("a.obj:1: a point needs"));
        assert!(message(read(&format!("{SQUARE}f 1 b 3\n"))).starts_with("a.obj:8: \"b\""));
        let said = message(read(&format!("{SQUARE}f 1 2\n")));
        assert_eq!(
            said,
            "a.obj:8: polygon 1 has 2 corners; it needs three or more"
        );
        assert!(message(read(SQUARE)).contains("holds no triangles"));
        assert!(message(read("v 0 inf 0\n")).starts_with("a.obj:1: vertex 1 has"));
    }
}
