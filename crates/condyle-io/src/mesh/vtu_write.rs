//! VTK unstructured grids (`.vtu`), out: appended raw bytes, the same bytes for the same mesh.

use std::fmt::Write as _;

use condyle_fem::HexMesh;

use super::error::MeshFileError;

/// Values at the nodes.
#[derive(Clone, Copy, Debug)]
pub enum PointValues<'a> {
    /// Written as Float64.
    Float64(&'a [f64]),
    /// Written as UInt8; values of 0 and 1 come back as a node set and a surface.
    UInt8(&'a [u8]),
}

/// A named array with one value a node.
#[derive(Clone, Copy, Debug)]
pub struct PointArray<'a> {
    /// Name with the unit in it, such as `wear_depth_mm`.
    pub name: &'a str,
    /// One value a node of the mesh.
    pub values: PointValues<'a>,
}

impl PointValues<'_> {
    fn len(self) -> usize {
        match self {
            Self::Float64(values) => values.len(),
            Self::UInt8(values) => values.len(),
        }
    }

    fn kind(self) -> &'static str {
        match self {
            Self::Float64(_) => "Float64",
            Self::UInt8(_) => "UInt8",
        }
    }

    fn append(self, appended: &mut Appended) -> usize {
        match self {
            Self::Float64(values) => appended.block(values.iter().map(|value| value.to_le_bytes())),
            Self::UInt8(values) => appended.block(values.iter().map(|value| [*value])),
        }
    }
}

/// A `.vtu` file of the mesh with its arrays, as bytes.
///
/// # Errors
/// [`MeshFileError::ArrayLength`] where an array does not have one value a node.
pub fn vtu_bytes(mesh: &HexMesh, arrays: &[PointArray]) -> Result<Vec<u8>, MeshFileError> {
    for array in arrays {
        check_length(mesh, array)?;
    }
    let mut appended = Appended::default();
    let mut bytes = xml(mesh, arrays, &mut appended).into_bytes();
    bytes.extend_from_slice(&appended.bytes);
    bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
    Ok(bytes)
}

fn check_length(mesh: &HexMesh, array: &PointArray) -> Result<(), MeshFileError> {
    let (values, nodes) = (array.values.len(), mesh.nodes.len());
    if values == nodes {
        return Ok(());
    }
    let name = array.name.to_string();
    Err(MeshFileError::ArrayLength {
        name,
        values,
        nodes,
    })
}

/// The blocks behind the XML: each a byte count of eight bytes, then the bytes.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// Adds a block and gives its offset.
    fn block<const N: usize>(&mut self, values: impl ExactSizeIterator<Item = [u8; N]>) -> usize {
        let offset = self.bytes.len();
        let length = values.len() * N;
        self.bytes.reserve(length + 8);
        self.bytes.extend_from_slice(&(length as u64).to_le_bytes());
        values.for_each(|value| self.bytes.extend_from_slice(&value));
        offset
    }
}

fn xml(mesh: &HexMesh, arrays: &[PointArray], appended: &mut Appended) -> String {
    let (nodes, hexes) = (mesh.nodes.len(), mesh.hexes.len());
    let mut xml = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n",
    );
    let _ = writeln!(
        xml,
        "<Piece NumberOfPoints=\"{nodes}\" NumberOfCells=\"{hexes}\">"
    );
    xml.push_str("<PointData>\n");
    for array in arrays {
        let offset = array.values.append(appended);
        data_array(
            &mut xml,
            array.values.kind(),
            &escaped(array.name),
            1,
            offset,
        );
    }
    xml.push_str("</PointData>\n<Points>\n");
    let offset = appended.block(coordinates(mesh).iter().map(|value| value.to_le_bytes()));
    data_array(&mut xml, "Float64", "Points", 3, offset);
    xml.push_str("</Points>\n<Cells>\n");
    let corners = mesh.hexes.as_flattened().iter();
    let offset = appended.block(corners.map(|&node| i64::from(node).to_le_bytes()));
    data_array(&mut xml, "Int64", "connectivity", 1, offset);
    let ends: Vec<i64> = (1..=hexes as i64).map(|hex| 8 * hex).collect();
    let offset = appended.block(ends.iter().map(|end| end.to_le_bytes()));
    data_array(&mut xml, "Int64", "offsets", 1, offset);
    let offset = appended.block(vec![[12]; hexes].into_iter());
    data_array(&mut xml, "UInt8", "types", 1, offset);
    xml.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_");
    xml
}

fn coordinates(mesh: &HexMesh) -> Vec<f64> {
    mesh.nodes
        .iter()
        .flat_map(|node| [node.x, node.y, node.z])
        .collect()
}

fn data_array(xml: &mut String, kind: &str, name: &str, components: usize, offset: usize) {
    // Readers take an array without a count for a plain list, one with a count of 1 for a column.
    let count = match components {
        1 => String::new(),
        _ => format!(" NumberOfComponents=\"{components}\""),
    };
    let _ = writeln!(
        xml,
        "<DataArray type=\"{kind}\" Name=\"{name}\"{count} format=\"appended\" offset=\"{offset}\"/>"
    );
}

/// Text as the value of an XML attribute.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::fixtures::{message, two_cubes};
    use crate::mesh::on_disk::{read_vtu_points, write_vtu};

    #[test]
    fn a_file_is_written_and_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("insert.vtu");
        let values = [0.5; 12];
        let array = PointArray {
            name: "a<b & \"c\"",
            values: PointValues::Float64(&values),
        };
        write_vtu(&path, &two_cubes(), &[array]).unwrap();
        let file = read_vtu_points(&path).unwrap();
        assert_eq!(file.mesh, two_cubes());
        assert_eq!(file.values("a<b & \"c\"").unwrap(), values);
    }

    #[test]
    fn an_array_of_the_wrong_length_is_refused() {
        let array = PointArray {
            name: "mark",
            values: PointValues::UInt8(&[1, 0]),
        };
        let said = message(vtu_bytes(&two_cubes(), &[array]));
        assert_eq!(
            said,
            "array \"mark\" has 2 values for 12 nodes; give one a node"
        );
    }

    #[test]
    fn a_folder_that_is_not_there_cannot_be_written_to() {
        let said = message(write_vtu("nowhere/insert.vtu", &two_cubes(), &[]));
        assert!(
            said.starts_with("nowhere/insert.vtu: cannot be written"),
            "{said}"
        );
    }
}
