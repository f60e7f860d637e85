use std::path::Path;

use crate::{
    Vec3,
    formats::{
        Grid, HexFile, MeshFileError, PointArray, PointValues, compact_vtu_bytes, parse_vtu_points,
        parse_vtu_triangles,
        tests::{message, two_cubes},
        vtk::parse_vtu,
        vtu_bytes,
    },
};

const TEXT: &str = r#"<VTKFile type="UnstructuredGrid" version="0.1">
<UnstructuredGrid><Piece NumberOfPoints="13" NumberOfCells="4">
<PointData><DataArray type="Int64" Name="fixed" format="ascii">1 1 0 1 1 0 1 1 0 1 1 0 0</DataArray>
<DataArray type="Float64" Name="depth" format="ascii">1 1 1 1 1 1 1 1 1 1 1 1 1</DataArray></PointData>
<CellData><DataArray type="Int8" Name="top" format="ascii">0 1 1 0</DataArray>
<DataArray type="Int8" Name="second" format="ascii">0 0 0 1</DataArray></CellData>
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0
0 0 1 1 0 1 2 0 1 0 1 1 1 1 1 2 1 1 9 9 9
</DataArray></Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">0 1 4 3 6 7 10 9
6 9 10 7 7 8 11 10
1 2 5 4 7 8 11 10</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">8 12 16 24</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">12 9 9 12</DataArray>
</Cells></Piece></UnstructuredGrid></VTKFile>
"#;

fn read(bytes: &[u8]) -> Result<HexFile, MeshFileError> {
    parse_vtu(Path::new("a.vtu"), bytes)
}

#[test]
fn hexahedra_quads_and_marks_are_read() {
    let file = read(TEXT.as_bytes()).unwrap();
    assert_eq!(file.mesh, two_cubes());
    assert_eq!(
        file.surface("top").unwrap().quads,
        [[6, 7, 10, 9], [7, 8, 11, 10]]
    );
    assert_eq!(file.surface("fixed").unwrap().quads.len(), 5);
    assert!(file.surface("second").is_none() && file.surface("depth").is_none());
}

#[test]
fn what_was_written_comes_back() {
    let mesh = two_cubes();
    let depth: Vec<f64> = (0..12).map(|node| f64::from(node) / 7.0).collect();
    let flags = [0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1];
    let along: Vec<[f64; 3]> = depth.iter().map(|&depth| [depth, 0.0, -depth]).collect();
    let arrays = [
        PointArray {
            name: "direction",
            values: PointValues::Vectors(&along),
        },
        PointArray {
            name: "depth_mm",
            values: PointValues::Float64(&depth),
        },
        PointArray {
            name: "articulating",
            values: PointValues::UInt8(&flags),
        },
    ];
    let bytes = vtu_bytes(&mesh, &arrays).unwrap();
    assert_eq!(bytes, vtu_bytes(&mesh, &arrays).unwrap());
    let points = parse_vtu_points(Path::new("a.vtu"), &bytes).unwrap();
    assert_eq!(points.mesh, mesh);
    assert_eq!(points.values("depth_mm").unwrap(), depth);
    assert_eq!(points.point_vectors, [("direction".to_owned(), along)]);
    assert_eq!(points.values("articulating").unwrap(), flags.map(f64::from));
    let file = read(&bytes).unwrap();
    assert_eq!(file.mesh, mesh);
    let surface = file.surface("articulating").unwrap();
    assert_eq!(surface.quads, [[6, 7, 10, 9], [7, 8, 11, 10]]);
}

#[test]
fn what_is_wrong_is_named() {
    let reported = |from, to| message(read(TEXT.replace(from, to).as_bytes()));
    let kind = reported("12 9 9 12<", "12 9 9 10<");
    assert!(
        kind.starts_with("a.vtu: element 3 is of type 10 (tetrahedron)"),
        "{kind}"
    );
    assert!(reported("12 9 9 12<", "12 9 9<").contains("has 4 cells but 3 types"));
    assert!(reported("8 12 16 24", "7 12 16 24").contains("cell 0 has 7 corners"));
    assert!(reported("1 2 5 4 7", "7 8 11 10 1").contains("hexahedron 3 is inverted"));
    assert!(reported("1 2 5 4 7", "1 2 5 4 77").contains("element 3 names vertex 77"));
    assert!(reported("6 9 10 7 7", "1 4 10 7 7").contains("face of surface \"top\" is not"));
    assert!(reported("0 1 1 0<", "0 1 1<").contains("array \"top\" has 3 values for 4 cells"));
    assert!(reported("2 1 1 9 9 9", "2 1 1 9 9 inf").contains("node 12 has a coordinate"));
    assert!(reported("UnstructuredGrid\"", "PolyData\"").contains("of type UnstructuredGrid"));
}

#[test]
fn a_result_with_a_point_out_of_range_is_an_error() {
    let text = TEXT.replace("1 2 5 4 7", "1 2 5 4 77");
    let reported = message(parse_vtu_points(Path::new("a.vtu"), text.as_bytes()));
    let expected =
        "a.vtu:12: cell 3 names vertex 77, but the file numbers its vertices from 0 to 12";
    assert_eq!(reported, expected);
}

#[test]
fn triangles_come_back() {
    let nodes = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.5]].map(Vec3::from);
    let triangles = [[0, 2, 1], [0, 1, 3]];
    let bytes = compact_vtu_bytes(&Grid::triangles(&nodes, &triangles), &[]).unwrap();
    let mesh = parse_vtu_triangles(Path::new("a.vtu"), &bytes).unwrap();
    assert_eq!(
        (mesh.vertices, mesh.triangles),
        (nodes.into(), triangles.into())
    );
    let quads = compact_vtu_bytes(&Grid::quads(&nodes, &[[0, 1, 2, 3]]), &[]).unwrap();
    let reported = message(parse_vtu_triangles(Path::new("a.vtu"), &quads));
    assert!(reported.contains("a cell is not a triangle"), "{reported}");
}
