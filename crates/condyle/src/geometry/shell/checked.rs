//! A triangle mesh checked as a shell, and repaired.

use serde::{Deserialize, Serialize};

use super::{
    crossing::{Crossings, crossings},
    degenerate::without_degenerate,
    edges::{check_manifold, edge_uses},
    error::ShellError,
    orientation::orient,
};
use crate::geometry::triangle_mesh::TriangleMesh;

/// A triangle mesh that has passed every check of [`checked_shell`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckedShell {
    /// The mesh: no degenerate triangles, neighbours turned alike, facing outwards if closed.
    pub mesh: TriangleMesh,
    /// No edge has only one triangle.
    pub closed: bool,
    /// The mesh came inside-out and was turned round. For an open surface it is not known which
    /// side is out: this stays false, and the caller decides.
    pub turned_round: bool,
    /// Triangles turned to agree with the majority of their neighbours.
    pub made_consistent: usize,
    /// Triangles without area that were taken out.
    pub removed_degenerate: usize,
    /// Pairs of neighbouring triangles that cross a little: a flaw to warn of, left as it is.
    pub wrinkles: usize,
}

/// Checks a triangle mesh as a shell and repairs what can be repaired for certain.
///
/// Takes out triangles without area; turns triangles so that neighbours agree, with the majority;
/// turns a closed shell that is inside-out. Equal points must be one vertex already. Lengths in
/// mm; only positions in messages depend on it.
///
/// What counts as a crossing, and what as a wrinkle that is let pass, is said at [`crossings`].
///
/// # Errors
/// [`ShellError`]: no triangles, an edge of three or more, a one-sided surface, a crossing.
pub fn checked_shell(mesh: TriangleMesh) -> Result<CheckedShell, ShellError> {
    let cleaned = without_degenerate(mesh);
    let mut mesh = cleaned.mesh;
    if mesh.triangles.is_empty() {
        return Err(ShellError::Empty);
    }
    let uses = edge_uses(&mesh);
    check_manifold(&mesh, &uses)?;
    let oriented = orient(&mut mesh, &uses)?;
    let Crossings { first, wrinkles } = crossings(&mesh);
    if let Some(crossing) = first {
        let [first, second] = crossing
            .triangles
            .map(|triangle| cleaned.came_from[triangle]);
        let at_mm = crossing.at_mm;
        return Err(ShellError::CrossesItself {
            first: first.min(second),
            second: first.max(second),
            at_mm,
        });
    }
    Ok(CheckedShell {
        mesh,
        closed: oriented.closed,
        turned_round: oriented.turned_round,
        made_consistent: oriented.made_consistent,
        removed_degenerate: cleaned.removed,
        wrinkles,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Vec3,
        geometry::shell::fixtures::{block, joined, unit_block},
    };

    fn inside_out(mut mesh: TriangleMesh) -> TriangleMesh {
        mesh.triangles
            .iter_mut()
            .for_each(|triangle| triangle.swap(1, 2));
        mesh
    }

    #[test]
    fn a_sound_closed_shell_is_left_alone() {
        let shell = checked_shell(unit_block()).unwrap();
        assert_eq!(shell.mesh, unit_block());
        assert!(shell.closed && !shell.turned_round);
        assert_eq!((shell.made_consistent, shell.removed_degenerate), (0, 0));
    }

    #[test]
    fn an_inside_out_closed_shell_is_turned_round() {
        let shell = checked_shell(inside_out(unit_block())).unwrap();
        assert!(shell.turned_round);
        assert_eq!(shell.made_consistent, 0);
        assert!((shell.mesh.signed_volume() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn one_of_two_bodies_inside_out_is_turned_round() {
        let other = block(Vec3::repeat(2.0), Vec3::repeat(3.0));
        let shell = checked_shell(joined(unit_block(), inside_out(other))).unwrap();
        assert!(shell.turned_round);
        assert!((shell.mesh.signed_volume() - 2.0).abs() < 1e-14);
    }

    #[test]
    fn a_hollow_keeps_its_inner_wall_turned_inwards() {
        let hollow = inside_out(block(Vec3::repeat(0.25), Vec3::repeat(0.75)));
        let shell = checked_shell(joined(unit_block(), hollow)).unwrap();
        assert!(!shell.turned_round);
        assert!((shell.mesh.signed_volume() - 0.875).abs() < 1e-14);
    }

    #[test]
    fn an_open_surface_is_not_turned_round() {
        let mut open = inside_out(unit_block());
        open.triangles.pop();
        let shell = checked_shell(open).unwrap();
        assert!(!shell.closed && !shell.turned_round);
    }

    #[test]
    fn a_few_triangles_turned_wrong_are_made_consistent() {
        let mut mesh = unit_block();
        mesh.triangles[3].swap(0, 1);
        mesh.triangles[8].swap(0, 1);
        let shell = checked_shell(mesh).unwrap();
        assert_eq!(shell.made_consistent, 2);
        assert!(!shell.turned_round);
        assert!((shell.mesh.signed_volume() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn nothing_and_points_only_are_empty() {
        let said = checked_shell(TriangleMesh::default())
            .unwrap_err()
            .to_string();
        assert_eq!(
            said,
            "the mesh has no triangle with an area; check the export"
        );
        let mut mesh = unit_block();
        mesh.triangles = vec![[0, 0, 1], [2, 3, 2]];
        assert_eq!(checked_shell(mesh), Err(ShellError::Empty));
    }

    #[test]
    fn a_third_triangle_on_an_edge_is_an_error() {
        let mut mesh = unit_block();
        mesh.vertices.push(Vec3::new(-1.0, -1.0, 0.5));
        mesh.triangles.push([0, 4, 8]);
        let said = checked_shell(mesh).unwrap_err().to_string();
        let expected = "3 triangles share the edge from (0.0000, 0.0000, 0.0000) to \
            (0.0000, 0.0000, 1.0000) mm; a shell has at most two, so take out inner walls and \
            doubled faces";
        assert_eq!(said, expected);
    }

    #[test]
    fn a_moebius_strip_is_an_error() {
        let mut mesh = TriangleMesh::default();
        for step in 0..6 {
            let around = f64::from(step) / 6.0 * std::f64::consts::TAU;
            let (radial, height) = ((around / 2.0).cos() * 0.3, (around / 2.0).sin() * 0.3);
            for side in [-1.0, 1.0] {
                let radius = 1.0 + side * radial;
                let (sine, cosine) = around.sin_cos();
                mesh.vertices
                    .push(Vec3::new(radius * cosine, radius * sine, side * height));
            }
        }
        for step in 0..6 {
            let [a, b] = [2 * step, 2 * step + 1];
            // After one round the two rims change places.
            let [c, d] = if step == 5 { [1, 0] } else { [a + 2, b + 2] };
            mesh.triangles.extend([[a, b, c], [b, d, c]]);
        }
        let said = checked_shell(mesh).unwrap_err().to_string();
        assert!(said.contains("comes back turned at ("), "{said}");
    }

    #[test]
    fn two_blocks_through_one_another_are_an_error() {
        let other = block(Vec3::new(0.2, 0.3, 0.5), Vec3::new(0.6, 0.7, 1.5));
        let error = checked_shell(joined(unit_block(), other)).unwrap_err();
        let ShellError::CrossesItself {
            first,
            second,
            at_mm,
        } = &error
        else {
            panic!("{error}");
        };
        assert!(*first < 4 && *second >= 12, "{first} {second}");
        assert!((at_mm.z - 1.0).abs() < 1e-12, "{at_mm}");
        assert!(
            error
                .to_string()
                .starts_with("the surface crosses itself: triangles ")
        );
    }

    #[test]
    fn a_crossing_is_named_by_the_triangles_as_they_came_in() {
        let mut mesh = unit_block();
        mesh.triangles.insert(0, [0, 0, 1]);
        let other = block(Vec3::new(0.2, 0.3, 0.5), Vec3::new(0.6, 0.7, 1.5));
        let error = checked_shell(joined(mesh, other)).unwrap_err();
        assert!(matches!(
            error,
            ShellError::CrossesItself {
                first: 3 | 4,
                second: 13..,
                ..
            }
        ));
    }
}
