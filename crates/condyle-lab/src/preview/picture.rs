//! Both bodies as a picture shows them.

use condyle::{
    Vec3,
    evolve::March,
    geometry::TriangleMesh,
    machine::knee::{IE, VV},
};
use condyle_io::case::{Case, Side};
use condyle_report::{
    Side as ReportSide,
    bodies::{BodiesPicture, BodySurface, MachineAxes, bodies_svg},
};

use crate::at_rest::AtRest;

/// The picture as the text of an SVG file.
pub(super) fn svg(case: &Case, march: &March, femur: &TriangleMesh, at_rest: &AtRest) -> String {
    let side = case.heading.side;
    let insert = march.test().insert.mesh();
    let on_insert = |vertex: &Vec3| at_rest.pose.to_insert(vertex);
    let femur = of_triangles(femur.clone().mapped(on_insert));
    let insert = of_quads(&insert.nodes, &insert.boundary_quads());
    let [femur, insert, contact] =
        [femur, insert, pressed(march, at_rest)].map(|body| mirrored(body, side));
    bodies_svg(&BodiesPicture {
        title: &case.heading.title,
        side: match side {
            Side::Right => ReportSide::Right,
            Side::Left => ReportSide::Left,
        },
        femur: &femur,
        insert: &insert,
        contact: &contact,
        axes: Some(axes(march, at_rest, side)),
        caption: &caption(at_rest),
    })
}

fn caption(at_rest: &AtRest) -> String {
    format!(
        "Red: in contact at rest under {:.0} N, {:.0} mm2, up to {:.1} MPa.",
        at_rest.axial_force_n, at_rest.contact_area_mm2, at_rest.peak_pressure_mpa
    )
}

fn of_triangles(mesh: TriangleMesh) -> BodySurface {
    BodySurface {
        vertices: mesh.vertices,
        triangles: mesh.triangles,
    }
}

fn of_quads(nodes: &[Vec3], quads: &[[u32; 4]]) -> BodySurface {
    of_triangles(TriangleMesh::of_quads(
        nodes.to_vec(),
        quads.iter().copied(),
    ))
}

/// Faces of the articulating surface of which most corners are pressed.
fn pressed(march: &March, at_rest: &AtRest) -> BodySurface {
    const MAX_CORNERS: usize = 3;
    let places = march.test().insert.surface().positions;
    let mut is_pressed = vec![false; places.len()];
    for node in &at_rest.touched {
        is_pressed[node.node as usize] = true;
    }
    let corners = |face: &[u32; 4]| {
        face.iter()
            .filter(|&&node| is_pressed[node as usize])
            .count()
    };
    let faces = march.test().insert.surface_faces().iter().copied();
    let faces: Vec<[u32; 4]> = faces.filter(|face| corners(face) >= MAX_CORNERS).collect();
    of_quads(&places, &faces)
}

/// As the files have it: a left knee is computed as a right one.
fn mirrored(mut body: BodySurface, side: Side) -> BodySurface {
    body.vertices
        .iter_mut()
        .for_each(|vertex| vertex.z *= sign(side));
    body
}

fn sign(side: Side) -> f64 {
    match side {
        Side::Right => 1.0,
        Side::Left => -1.0,
    }
}

fn axes(march: &March, at_rest: &AtRest, side: Side) -> MachineAxes {
    let machine = march.test().machine();
    let (vv, ie) = (machine.joint(VV), machine.joint(IE));
    let [x, y, _] = at_rest.flexion_axis_mm;
    MachineAxes {
        flexion_mm: (x, y),
        vv_mm: (vv.axis_point_mm.y, sign(side) * vv.axis_point_mm.z),
        ie_mm: (ie.axis_point_mm.x, sign(side) * ie.axis_point_mm.z),
        ap_zero_mm: x,
    }
}
