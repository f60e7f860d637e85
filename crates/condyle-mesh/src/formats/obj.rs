//! Wavefront OBJ: `v` and `f` rows; normals, texture, groups and materials are passed over.

use std::path::Path;

use super::{
    error::MeshFileError,
    surface_draft::SurfaceDraft,
    text::{At, decode},
};
use crate::TriangleMesh;

pub(crate) fn parse(path: &Path, bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    let mut draft = SurfaceDraft::new(path, 1);
    let content = decode(bytes);
    let mut lines = (1..).zip(content.lines());
    while let Some((line, first)) = lines.next() {
        let at = At::line(path, line);
        let mut row = first.to_owned();
        // A backslash at the end of a line joins the next one to it.
        while row.ends_with('\\') {
            row.pop();
            row.push(' ');
            row.push_str(lines.next().map_or("", |(_, more)| more));
        }
        let row = row.split('#').next().unwrap_or_default();
        let mut words = row.split_ascii_whitespace();
        match words.next() {
            Some("v") => draft.point(at, at.coordinates(words)?)?,
            Some("f") => {
                let points = draft.points() as i64;
                let corners = words.map(|word| {
                    // `7`, `7/1`, `7//3` or `7/1/3`; a negative number counts back from the last vertex.
                    let vertex: i64 = at.number(word.split('/').next().unwrap_or_default())?;
                    Ok(if vertex < 0 {
                        points + 1 + vertex
                    } else {
                        vertex
                    })
                });
                draft.polygon(at, &corners.collect::<Result<Vec<_>, _>>()?)?;
            }
            _ => {}
        }
    }
    draft.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::tests::message;

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
        let reported = message(read(&format!("{SQUARE}f 1 2 3\nf 1 2 9\n")));
        let expected =
            "a.obj:9: polygon 2 names vertex 9, but the file numbers its vertices from 1 to 4";
        assert_eq!(reported, expected);
        let reported = message(read(&format!("{SQUARE}f 0 1 2\n")));
        assert!(reported.contains("names vertex 0"), "{reported}");
    }

    #[test]
    fn bad_rows_are_named_with_their_line() {
        assert!(message(read("v 0 0\n")).starts_with("a.obj:1: a point needs"));
        assert!(message(read(&format!("{SQUARE}f 1 b 3\n"))).starts_with("a.obj:8: \"b\""));
        let reported = message(read(&format!("{SQUARE}f 1 2\n")));
        assert_eq!(
            reported,
            "a.obj:8: polygon 1 has 2 corners; it needs three or more"
        );
        assert!(message(read(SQUARE)).contains("holds no triangles"));
        assert!(message(read("v 0 inf 0\n")).starts_with("a.obj:1: vertex 1 has"));
    }
}
