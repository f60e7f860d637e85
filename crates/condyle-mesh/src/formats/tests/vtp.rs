use std::path::Path;

use crate::{
    TriangleMesh,
    formats::{
        MeshFileError,
        tests::{message, tetrahedron},
        vtk::parse_vtp,
    },
};

const TEXT: &str = r#"<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<PolyData><Piece NumberOfPoints="4" NumberOfPolys="4">
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">
0 0 0 1 0 0
0 1 0 0 0 1
</DataArray></Points>
<Polys>
<DataArray type="Int32" Name="connectivity" format="ascii">0 2 1 0 1 3 1 2 3 2 0 3</DataArray>
<DataArray type="Int32" Name="offsets" format="ascii">3 6 9 12</DataArray>
</Polys></Piece></PolyData></VTKFile>
"#;

fn read(bytes: &[u8]) -> Result<TriangleMesh, MeshFileError> {
    parse_vtp(Path::new("a.vtp"), bytes)
}

#[test]
fn text_arrays_are_read() {
    assert_eq!(read(TEXT.as_bytes()).unwrap(), tetrahedron());
}

/// The tetrahedron with arrays encoded by `encode`, inline or appended.
fn encoded(attributes: &str, appended: Option<&str>, encode: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let points: Vec<u8> = [0f64, 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let corners: Vec<u8> = [0i64, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let ends: Vec<u8> = [3i64, 6, 9, 12]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    let mut tail = Vec::new();
    let mut array = |name: &str, kind: &str, data: &[u8]| {
        let data = encode(data);
        let (format, content) = if appended.is_some() {
            let offset = tail.len();
            tail.extend(data);
            (
                format!("format=\"appended\" offset=\"{offset}\""),
                String::new(),
            )
        } else {
            (
                "format=\"binary\"".to_string(),
                String::from_utf8(data).unwrap(),
            )
        };
        format!(
            "<DataArray Name=\"{name}\" type=\"{kind}\" NumberOfComponents=\"{}\" {format}>{content}</DataArray>",
            if name == "Points" { 3 } else { 1 }
        )
    };
    let body = format!(
        "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" {attributes}><PolyData><Piece><Points>{}</Points><Polys>{}{}</Polys></Piece></PolyData>",
        array("Points", "Float64", &points),
        array("connectivity", "Int64", &corners),
        array("offsets", "Int64", &ends),
    );
    let mut bytes = body.into_bytes();
    if let Some(encoding) = appended {
        bytes.extend(format!("<AppendedData encoding=\"{encoding}\">\n _").bytes());
        bytes.extend(tail);
        bytes.extend(b"\n</AppendedData>");
    }
    bytes.extend(b"</VTKFile>");
    bytes
}

fn counted(data: &[u8]) -> Vec<u8> {
    [&(data.len() as u32).to_le_bytes(), data].concat()
}

fn base64(data: &[u8]) -> Vec<u8> {
    use base64::Engine;
    base64::engine::general_purpose::STANDARD
        .encode(data)
        .into_bytes()
}

const ZLIB: &str = "compressor=\"vtkZLibDataCompressor\"";

fn zlib_header_and_block(data: &[u8]) -> (Vec<u8>, Vec<u8>) {
    use std::io::Write;
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(data).unwrap();
    let block = encoder.finish().unwrap();
    let header = [1, data.len() as u32, 0, block.len() as u32];
    (
        header
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect(),
        block,
    )
}

#[test]
fn inline_binary_is_read_padded_as_one_or_as_two() {
    let together = encoded("", None, |data| base64(&counted(data)));
    assert_eq!(read(&together).unwrap(), tetrahedron());
    let apart = encoded("", None, |data| {
        [base64(&(data.len() as u32).to_le_bytes()), base64(data)].concat()
    });
    assert_eq!(read(&apart).unwrap(), tetrahedron());
}

#[test]
fn appended_raw_and_base64_are_read() {
    let raw = encoded("", Some("raw"), counted);
    assert_eq!(read(&raw).unwrap(), tetrahedron());
    let text = encoded("", Some("base64"), |data| base64(&counted(data)));
    assert_eq!(read(&text).unwrap(), tetrahedron());
}

#[test]
fn zlib_is_read_and_other_compressors_are_refused() {
    let inline = encoded(ZLIB, None, |data| {
        let (header, block) = zlib_header_and_block(data);
        [base64(&header), base64(&block)].concat()
    });
    assert_eq!(read(&inline).unwrap(), tetrahedron());
    let raw = encoded(ZLIB, Some("raw"), |data| {
        let (header, block) = zlib_header_and_block(data);
        [header, block].concat()
    });
    assert_eq!(read(&raw).unwrap(), tetrahedron());
    let lz4 = encoded("compressor=\"vtkLZ4DataCompressor\"", Some("raw"), counted);
    let reported = message(read(&lz4));
    assert_eq!(
        reported,
        "a.vtp: is compressed by vtkLZ4DataCompressor; save it with zlib or uncompressed"
    );
}

#[test]
fn a_compressed_block_ends_at_its_announced_size() {
    let short = encoded(ZLIB, Some("raw"), |data| {
        let (mut header, block) = zlib_header_and_block(data);
        header[4..8].copy_from_slice(&(data.len() as u32 - 1).to_le_bytes());
        [header, block].concat()
    });
    let expected = "a.vtp:1: an array has a compressed block of more than its announced 95 \
        bytes; save the file again";
    assert_eq!(message(read(&short)), expected);
}

#[test]
fn arrays_that_unpack_to_far_more_than_the_file_are_refused() {
    let zeros = vec![0; 100_000_000];
    let (header, block) = zlib_header_and_block(&zeros);
    let honest = encoded(ZLIB, Some("raw"), |_| [&header[..], &block].concat());
    let reported = message(read(&honest));
    assert!(
        reported.starts_with("a.vtp:1: an array unpacks to more values"),
        "{reported}"
    );
    let data = [&200_000u64.to_le_bytes()[..], &zeros[..200_000]].concat();
    let all_the_same: String = (0..4_000)
        .map(|_| "<DataArray type=\"UInt8\" format=\"appended\" offset=\"0\"/>")
        .collect();
    let mut overlapping = TEXT
        .trim_end()
        .replace("<Points>", &format!("<Points>{all_the_same}"))
        .replace("</VTKFile>", "<AppendedData encoding=\"raw\">_")
        .into_bytes();
    overlapping.extend(data);
    let reported = message(read(&overlapping));
    assert!(
        reported.starts_with("a.vtp:4: an array unpacks to more values"),
        "{reported}"
    );
}

#[test]
fn many_arrays_are_read_in_time() {
    let empty = "<DataArray type=\"Int32\" format=\"ascii\"/>".repeat(25_000);
    let many = TEXT.replace(
        "</DataArray></Points>",
        &format!("</DataArray>{empty}</Points>"),
    );
    assert_eq!(read(many.as_bytes()).unwrap(), tetrahedron());
    let data = base64(&counted(&vec![0; 300_000]));
    let encoded = "<DataArray type=\"UInt8\" format=\"appended\" offset=\"99996\"/>";
    let many = TEXT
        .replace(
            "</DataArray></Points>",
            &format!("</DataArray>{}</Points>", encoded.repeat(8_000)),
        )
        .replace("</VTKFile>", "<AppendedData encoding=\"base64\">_");
    let many = [many.as_bytes(), &data, b"</AppendedData></VTKFile>"].concat();
    assert_eq!(read(&many).unwrap(), tetrahedron());
}

#[test]
fn a_tag_of_far_too_many_attributes_is_refused() {
    let attributes: String = (0..90_000).map(|i| format!(" a{i}='>'")).collect();
    let many = TEXT.replace("<Points>", &format!("<Points{attributes}>"));
    let expected = "a.vtp:4: has a tag of more than 8192 bytes; is this a VTK file?";
    assert_eq!(message(read(many.as_bytes())), expected);
    let comment = format!("<!-- it's > {attributes} --><Points>");
    let commented = TEXT.replace("<Points>", &comment);
    assert_eq!(read(commented.as_bytes()).unwrap(), tetrahedron());
}

#[test]
fn strips_alternate_their_sense() {
    let strip = TEXT.replace("Polys>", "Strips>").replace("3 6 9 12", "4");
    let strip = strip.replace("0 2 1 0 1 3 1 2 3 2 0 3", "0 1 2 3");
    assert_eq!(
        read(strip.as_bytes()).unwrap().triangles,
        [[0, 1, 2], [1, 3, 2]]
    );
}

#[test]
fn what_is_wrong_is_named_with_its_line() {
    let reported = |from, to| message(read(TEXT.replace(from, to).as_bytes()));
    assert_eq!(
        reported("0 1 0 0 0 1", "0 x 0 0 0 1"),
        "a.vtp:6: \"x\" is not a number here"
    );
    assert!(reported("2 0 3<", "2 0 7<").starts_with("a.vtp:9: polygon 3 names vertex 7"));
    assert!(reported("9 12", "9 13").starts_with("a.vtp:10: offset 13 does not fit"));
    assert!(reported("0 1 0 0 0 1", "0 nan 0 0 0 1").starts_with("a.vtp: vertex 2 has"));
    assert!(
        reported("\"PolyData\"", "\"ImageData\"").contains("is not a VTKFile of type PolyData")
    );
    assert!(reported("</Piece>", "</Piece><Piece/>").starts_with("a.vtp:11: has a second Piece"));
    assert!(reported("</Polys>", "").starts_with("a.vtp:11: is not XML"));
    assert!(reported("Polys>", "Lines>").contains("holds no triangles"));
    assert!(
        reported("format=\"ascii\">3", "format=\"hex\">3")
            .starts_with("a.vtp:10: unknown array format")
    );
}

#[test]
fn cut_off_arrays_are_named() {
    let mut raw = encoded("", Some("raw"), counted);
    raw.truncate(raw.len() - 60);
    assert!(message(read(&raw)).contains("was it cut off?"));
    let broken = encoded("", None, |_| b"a*c=".to_vec());
    assert!(message(read(&broken)).contains("base64 is broken"));
}

#[test]
fn a_padding_out_of_place_is_named() {
    for stray in ["=", "==", "====", "=AAA"] {
        let stray = |data: &[u8]| [stray.as_bytes(), &base64(&counted(data))].concat();
        let reported = message(read(&encoded("", None, stray)));
        assert!(
            reported.starts_with("a.vtp:1: an array's base64 is broken"),
            "{reported}"
        );
    }
}
