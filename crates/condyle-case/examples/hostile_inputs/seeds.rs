//! Small valid files, as other programs and users write them.

use std::fmt::Write;

use base64::{Engine, engine::general_purpose::STANDARD};
use condyle::{Vec3, evolve::March, geometry::TriangleMesh};
use condyle_case::case::CaseReader;
use condyle_mesh::files::MemoryFiles;
use condyle_mesh::formats::{
    PointArray, PointValues, parse_vtu_points, pvd_text, vtu_bytes, write_stl,
};
use condyle_results::Checkpoint;

/// A block of 40 by 8 by 60 mm, closed.
fn block() -> TriangleMesh {
    let corner = |i: usize| {
        let at = |axis: usize, low: f64, high: f64| if i >> axis & 1 == 0 { low } else { high };
        Vec3::new(at(0, -20.0, 20.0), at(1, 0.0, 8.0), at(2, -30.0, 30.0))
    };
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    TriangleMesh::of_quads((0..8).map(corner).collect(), quads)
}

/// An open dish, 5 by 5 squares.
fn dish() -> TriangleMesh {
    let place = |i: u32| {
        let (x, z) = (f64::from(i % 6) * 8.0 - 20.0, f64::from(i / 6) * 8.0 - 20.0);
        Vec3::new(x, (x * x + z * z) / 80.0, z)
    };
    let square = |i: u32| {
        let first = i % 5 + 6 * (i / 5);
        [
            [first, first + 6, first + 1],
            [first + 1, first + 6, first + 7],
        ]
    };
    TriangleMesh {
        vertices: (0..36).map(place).collect(),
        triangles: (0..25).flat_map(square).collect(),
    }
}

pub fn stl() -> Vec<Vec<u8>> {
    let binary = [block(), dish()].map(|mesh| {
        let mut bytes = Vec::new();
        write_stl(&mut bytes, &mesh).expect("a vector takes all");
        bytes
    });
    let mut text = String::from("solid block\n");
    for t in 0..12 {
        text += "facet normal 0 0 0\nouter loop\n";
        for at in block().corners(t) {
            let _ = writeln!(text, "vertex {:e} {} {}", at.x, at.y, at.z);
        }
        text += "endloop\nendfacet\n";
    }
    text += "endsolid block\n";
    binary.into_iter().chain([text.into_bytes()]).collect()
}

pub fn obj() -> Vec<Vec<u8>> {
    let mut text = String::from("# block\nmtllib a.mtl\no block\n");
    for at in &block().vertices {
        let _ = writeln!(text, "v {} {} {}", at.x, at.y, at.z);
    }
    text += "vn 0 1 0\nvt 0 0\ns off\nusemtl none\n";
    for [a, b, c] in block().triangles {
        let _ = writeln!(text, "f {}/1/1 {}//1 -{}", a + 1, b + 1, 8 - c);
    }
    let polygon = "v 0 0 0\nv 50 0 0\nv 50 0 50\nv 0 0 50\nv -9 0 20\nf 1 2 3 4 5\n";
    vec![text.into_bytes(), polygon.as_bytes().to_vec()]
}

pub fn ply() -> Vec<Vec<u8>> {
    let header = |format: &str, count: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment a block\nelement vertex 8\nproperty float x\nproperty float y\n\
             property float z\nelement face 12\nproperty list {count} int vertex_indices\nend_header\n"
        )
    };
    let mut text = header("ascii", "uchar");
    block()
        .vertices
        .iter()
        .for_each(|at| text += &format!("{} {} {}\n", at.x, at.y, at.z));
    block()
        .triangles
        .iter()
        .for_each(|[a, b, c]| text += &format!("3 {a} {b} {c}\n"));
    let binary = |format: &str, is_big: bool| {
        let four = |bytes: [u8; 4]| {
            if is_big {
                bytes.into_iter().rev().collect()
            } else {
                bytes.to_vec()
            }
        };
        let mut bytes = header(format, "uchar").into_bytes();
        let coordinates = block()
            .vertices
            .into_iter()
            .flat_map(|at| [at.x, at.y, at.z]);
        coordinates.for_each(|value| bytes.extend(four((value as f32).to_le_bytes())));
        for triangle in block().triangles {
            bytes.push(3);
            triangle
                .iter()
                .for_each(|number| bytes.extend(four(number.to_le_bytes())));
        }
        bytes
    };
    vec![
        text.into_bytes(),
        binary("binary_little_endian", false),
        binary("binary_big_endian", true),
    ]
}

fn bytes_of<const N: usize>(values: impl Iterator<Item = [u8; N]>) -> Vec<u8> {
    values.flatten().collect()
}

/// Returns the file of a block around three arrays, each with the attributes that locate its values, and the values.
fn vtp_file(attributes: &str, arrays: [(String, String); 3], tail: &[u8]) -> Vec<u8> {
    let [points, corners, ends] = arrays;
    let xml = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\"{attributes}>\n<PolyData><Piece NumberOfPoints=\"8\" NumberOfPolys=\"12\"><Points>\
         <DataArray type=\"Float64\" NumberOfComponents=\"3\" {}>{}</DataArray></Points><Polys>\
         <DataArray type=\"Int64\" Name=\"connectivity\" {}>{}</DataArray>\
         <DataArray type=\"Int64\" Name=\"offsets\" {}>{}</DataArray></Polys></Piece></PolyData>\n",
        points.0, points.1, corners.0, corners.1, ends.0, ends.1
    );
    [xml.as_bytes(), tail, b"</VTKFile>\n"].concat()
}

pub fn vtp() -> Vec<Vec<u8>> {
    let mesh = block();
    let coordinates = || mesh.vertices.iter().flat_map(|at| [at.x, at.y, at.z]);
    let points = bytes_of(coordinates().map(f64::to_le_bytes));
    let corners = bytes_of(
        mesh.triangles
            .iter()
            .flatten()
            .map(|&v| i64::from(v).to_le_bytes()),
    );
    let ends = bytes_of((1..=12i64).map(|n| (3 * n).to_le_bytes()));
    let arrays = [&points, &corners, &ends];
    let joined = |values: Vec<String>| values.join(" ");
    let text = [
        joined(coordinates().map(|value| value.to_string()).collect()),
        joined(
            mesh.triangles
                .iter()
                .flatten()
                .map(u32::to_string)
                .collect(),
        ),
        joined((1..=12).map(|n| (3 * n).to_string()).collect()),
    ];
    let ascii = text.map(|text| ("format=\"ascii\"".to_owned(), text));
    let with_length = |data: &[u8]| [&(data.len() as u64).to_le_bytes(), data].concat();
    let inline = arrays.map(|data| {
        (
            "format=\"binary\"".to_owned(),
            STANDARD.encode(with_length(data)),
        )
    });
    let zipped = arrays.map(|data| {
        let header = [1, data.len() as u64, 0, zlib(data).len() as u64]
            .map(u64::to_le_bytes)
            .concat();
        let content = STANDARD.encode(header) + &STANDARD.encode(zlib(data));
        ("format=\"binary\"".to_owned(), content)
    });
    let mut tail = b"<AppendedData encoding=\"raw\">_".to_vec();
    let start = tail.len();
    let appended = arrays.map(|data| {
        let place = format!("format=\"appended\" offset=\"{}\"", tail.len() - start);
        tail.extend(with_length(data));
        (place, String::new())
    });
    tail.extend(b"</AppendedData>");
    vec![
        vtp_file("", ascii, b""),
        vtp_file("", inline, b""),
        vtp_file(" compressor=\"vtkZLibDataCompressor\"", zipped, b""),
        vtp_file("", appended, &tail),
    ]
}

fn zlib(data: &[u8]) -> Vec<u8> {
    use std::io::Write;
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder
        .write_all(data)
        .and_then(|()| encoder.finish())
        .expect("a vector takes all")
}

pub fn vtu() -> Vec<Vec<u8>> {
    let text = r#"<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt32">
<UnstructuredGrid><Piece NumberOfPoints="8" NumberOfCells="1">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
0 0 0 20 0 0 20 20 0 0 20 0 0 0 20 20 0 20 20 20 20 0 20 20
</DataArray></Points>
<Cells>
<DataArray type="Int32" Name="connectivity" format="ascii">0 1 2 3 4 5 6 7</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">8</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">12</DataArray>
</Cells><PointData><DataArray type="UInt8" Name="top" format="ascii">0 0 1 1 0 0 1 1</DataArray></PointData>
</Piece></UnstructuredGrid></VTKFile>
"#;
    let read = parse_vtu_points(std::path::Path::new("a.vtu"), text.as_bytes());
    let mesh = read.expect("the file is valid").mesh;
    let depths = [0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.25, 0.0];
    let arrays = [
        PointArray {
            name: "wear_depth_mm",
            values: PointValues::Float64(&depths),
        },
        PointArray {
            name: "articulating",
            values: PointValues::UInt8(&[1, 1, 1, 1, 0, 0, 0, 0]),
        },
    ];
    let binary = vtu_bytes(&mesh, &arrays).expect("a value a node");
    vec![text.as_bytes().to_vec(), binary]
}

pub fn msh() -> Vec<Vec<u8>> {
    let v2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"top side\"\n3 9 \"insert\"\n$EndPhysicalNames\n\
        $Nodes\n12\n1 0 0 0\n2 10 0 0\n3 20 0 0\n4 0 10 0\n5 10 10 0\n6 20 10 0\n7 0 0 10\n8 10 0 10\n9 20 0 10\n\
        10 0 10 10\n11 10 10 10\n12 20 10 10\n$EndNodes\n$Elements\n5\n1 15 2 4 1 1\n2 3 2 1 6 7 10 11 8\n\
        3 3 2 1 6 8 9 12 11\n4 5 2 9 1 1 2 5 4 7 8 11 10\n5 5 2 9 1 2 3 6 5 8 9 12 11\n$EndElements\n";
    let v4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"top side\"\n$EndPhysicalNames\n$Entities\n\
        0 0 1 1\n6 0 0 1 2 1 1 1 1 0\n1 0 0 0 2 1 1 0 0\n$EndEntities\n$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n\
        0 0 0\n20 0 0\n20 20 0\n0 20 0\n0 0 20\n20 0 20\n20 20 20\n0 20 20\n$EndNodes\n$Elements\n2 2 1 2\n2 6 3 1\n\
        1 3 4 8 7\n3 1 5 1\n2 1 2 3 4 5 6 7 8\n$EndElements\n";
    [v2, v4].map(|text| text.as_bytes().to_vec()).to_vec()
}

pub fn inp() -> Vec<Vec<u8>> {
    let text = "*HEADING\na block\n*NODE, NSET=ALL\n1, 0, 0, 0\n2, 10, 0, 0\n3, 10, 0, -10\n4, 0, 0, -10\n5, 0, 10, 0\n\
        6, 10, 10, 0\n7, 10, 10, -10\n8, 0, 10, -10\n*ELEMENT, TYPE=C3D8, ELSET=BODY\n1, 1, 2, 3, 4, 5, 6, 7, 8\n\
        *NSET, NSET=SOME, GENERATE\n1, 7, 2\n*ELSET, ELSET=E\n1\n*SURFACE, NAME=TOP, TYPE=ELEMENT\nBODY, S2\n\
        *SURFACE, NAME=PTS, TYPE=NODE\nSOME\n*MATERIAL, NAME=PE\n*ELASTIC\n463, 0.46\n";
    let parts = "*PART, NAME=P\n*NODE\n1, 0, 0, 0\n2, 9, 0, 0\n3, 9, 9, 0\n4, 0, 9, 0\n5, 0, 0, 9\n6, 9, 0, 9\n7, 9, 9, 9\n\
        8, 0, 9, 9\n*ELEMENT, TYPE=C3D8R\n1, 1, 2, 3, 4,\n5, 6, 7, 8\n*END PART\n*ASSEMBLY, NAME=A\n\
        *INSTANCE, NAME=I, PART=P\n1., 2., 3.\n0,0,0,0,0,1,90\n*END INSTANCE\n*END ASSEMBLY\n";
    [text, parts].map(|text| text.as_bytes().to_vec()).to_vec()
}

pub fn pvd() -> Vec<Vec<u8>> {
    vec![pvd_text([(0.0, 0, "insert_0.vtu"), (5e6, 0, "insert_1.vtu")]).into_bytes()]
}

const CASE: &str = "title = \"hostile\"\nside = \"left\"\n\n[femur]\nshape = \"mesh\"\nfile = \"f.stl\"\nlength_unit = \"mm\"\n\
    axes = [\"anterior\", \"superior\", \"right\"]\nstart_mm = [1.0, 0.5]\n\n[insert]\nshape = \"mesh\"\nfile = \"i.stl\"\n\
    edge_mm = 1.5\nlayers = 3\nclip_below_mm = 1.0\n\n[contact]\nlaw = \"tabulated\"\ntable_file = \"table.csv\"\nfriction = 0.04\n\n\
    [machine]\npreset = \"stanmore-force\"\nfrequency_hz = 1.1\n\n[machine.axial_force]\nwaveform = \"wave.csv\"\n\n\
    [machine.flexion]\nwaveform = \"iso-like\"\n\n[march]\ncycles = 5_000_000\nupdates = 10\n";

pub fn case() -> Vec<Vec<u8>> {
    let shipped = [
        include_str!("../../../../cases/stanmore-force.toml"),
        include_str!("../../../../cases/stanmore-displacement.toml"),
        include_str!("../../../../cases/stanmore-force-auto.toml"),
    ];
    shipped
        .into_iter()
        .chain([CASE])
        .map(|text| text.as_bytes().to_vec())
        .collect()
}

pub fn waveform() -> Vec<Vec<u8>> {
    let shipped = include_str!("../../waveforms/paper-like-axial-force.csv");
    vec![
        shipped.as_bytes().to_vec(),
        b"percent,force_n\n0,200\n25,2000\n50,900\n75,150\n100,200\n".to_vec(),
    ]
}

pub fn pressure_table() -> Vec<Vec<u8>> {
    vec![
        b"# made up\noverclosure_mm,pressure_mpa\n0,0\n0.01,10\n0.02,17\n0.05,25\n0.1,30\n"
            .to_vec(),
        b"overclosure_mm,pressure_mpa\r\n0.0,0.0\r\n1.0,2000\r\n".to_vec(),
    ]
}

const STRAIN_CASE: &str = "[contact]\nlaw = \"tabulated-strain\"\nstrain_table_file = \"strain.csv\"\npeak_error_percent = 4.5\n";

pub fn strain_table() -> Vec<Vec<u8>> {
    vec![
        b"# made up\noverclosure_over_thickness,pressure_mpa\n0,0\n0.005,5\n0.02,15\n0.05,30\n"
            .to_vec(),
    ]
}

const ROWS_STUDY: &str = "case = \"strain.toml\"\n[design]\nkind = \"rows\"\nfile = \"rows.csv\"\n";

pub fn study() -> Vec<Vec<u8>> {
    let shipped = include_str!("../../../../cases/studies/generic-implant.toml");
    let every_table = "case = \"strain.toml\"\ntitle = \"hostile\"\n[design]\nkind = \"sobol\"\nsize = 8\nseed = 1\n\
        [[vary]]\nkey = \"contact.friction\"\nlow = 0.02\nhigh = 0.1\n\
        [[vary]]\nkey = \"insert.thickness_mm\"\ndistribution = \"triangular\"\nlow = 8.0\nmode = 9.0\nhigh = 10.0\n\
        [[vary]]\nkey = \"wear.law\"\nlevels = [\"archard\", \"kang\"]\n\
        [[correlation]]\nkeys = [\"contact.friction\", \"insert.thickness_mm\"]\ncoefficient = 0.3\n\
        [[alternative]]\nname = \"flat\"\nset = [\"insert.sagittal_radius_mm=70\"]\n\
        [[limit]]\noutput = \"peak_pressure_mpa\"\nmost = 40.0\n\
        [answers]\noutputs = [\"mass_loss_mg\"]\n";
    let search = "case = \"strain.toml\"\n[design]\nkind = \"optimise\"\nsize = 40\nminimise = \"mass_loss_mg\"\n\
        [[vary]]\nkey = \"insert.sagittal_radius_mm\"\nlow = 45.0\nhigh = 60.0\n";
    let shipped = shipped.replace("../stanmore-force.toml", "strain.toml");
    let texts = [shipped.as_str(), every_table, search];
    texts.map(|text| text.as_bytes().to_vec()).to_vec()
}

pub fn study_rows() -> Vec<Vec<u8>> {
    vec![b"# made up\ncontact.friction,insert.thickness_mm,wear.law\n0.04,9,archard\n0.07,9.5,kang\n".to_vec()]
}

/// The files of the case that names others.
pub fn case_files() -> [(&'static str, Vec<u8>); 9] {
    [
        ("case.toml", CASE.as_bytes().to_vec()),
        ("f.stl", b"solid".to_vec()),
        ("i.stl", b"solid".to_vec()),
        ("wave.csv", waveform().remove(1)),
        ("table.csv", pressure_table().remove(0)),
        ("strain.toml", STRAIN_CASE.as_bytes().to_vec()),
        ("strain.csv", strain_table().remove(0)),
        ("rows.toml", ROWS_STUDY.as_bytes().to_vec()),
        ("rows.csv", study_rows().remove(0)),
    ]
}

/// The files of measured data.
pub const MEASURED: [&str; 4] = ["measured.toml", "kinematics.csv", "masses.csv", "scan.csv"];

/// One of them, its first lines.
pub fn measured(name: &str) -> Vec<Vec<u8>> {
    let text = match name {
        "kinematics.csv" => include_str!("../../../../cases/measured-example/kinematics.csv"),
        "masses.csv" => include_str!("../../../../cases/measured-example/masses.csv"),
        "scan.csv" => include_str!("../../../../cases/measured-example/scan.csv"),
        _ => include_str!("../../../../cases/measured-example/measured.toml"),
    };
    let lines: Vec<&str> = text.lines().take(100).collect();
    vec![lines.join("\n").into_bytes()]
}

/// Returns a checkpoint of a started march on a coarse insert.
pub fn checkpoint() -> Vec<Vec<u8>> {
    let text = "[insert]\nedge_mm = 5\nlayers = 1\n[march]\ncycles = 1000\nupdates = 1\n";
    let files = MemoryFiles::default().with("case.toml", text);
    let case = CaseReader::new(files)
        .read("case.toml".as_ref())
        .expect("the case is valid");
    let test = case.build(1).expect("the generic implant").test;
    let march = March::start(test).expect("the bodies settle");
    let checkpoint = Checkpoint {
        inputs_blake3: "0".repeat(64),
        version: "0.1.0".to_owned(),
        state: march.state().clone(),
    };
    vec![checkpoint.to_bytes()]
}
