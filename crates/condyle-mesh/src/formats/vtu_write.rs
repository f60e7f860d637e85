//! VTK unstructured grids (`.vtu`), out: appended raw bytes, the same bytes for the same mesh.
//!
//! The blocks of bytes stand in the opposite order to the arrays that name them by their offsets.
//! meshio 5.3 takes block after block, gives the first array that has the block's offset, and lets
//! the array have another offset from then on, which may well be that of a later block. Where the
//! array of the later block stands first, it is found first.

use crate::Vec3;
use condyle_fem::HexMesh;

use super::error::MeshFileError;

/// Values at the nodes.
#[derive(Clone, Copy, Debug)]
pub enum PointValues<'a> {
    /// Written as Float64.
    Float64(&'a [f64]),
    /// Written as Float32.
    Float32(&'a [f32]),
    /// Vectors, written as Float64 of three components.
    Vectors(&'a [[f64; 3]]),
    /// Written as UInt8; values of 0 and 1 come back as a node set and a surface.
    UInt8(&'a [u8]),
}

/// A named array with one value or vector a node.
#[derive(Clone, Copy, Debug)]
pub struct PointArray<'a> {
    /// Name with the unit in it, such as `wear_depth_mm`.
    pub name: &'a str,
    /// One value or vector a node of the mesh.
    pub values: PointValues<'a>,
}

impl PointValues<'_> {
    fn len(self) -> usize {
        match self {
            Self::Float64(values) => values.len(),
            Self::Float32(values) => values.len(),
            Self::Vectors(values) => values.len(),
            Self::UInt8(values) => values.len(),
        }
    }

    fn kind(self) -> &'static str {
        match self {
            Self::Float64(_) | Self::Vectors(_) => "Float64",
            Self::Float32(_) => "Float32",
            Self::UInt8(_) => "UInt8",
        }
    }

    fn components(self) -> usize {
        match self {
            Self::Vectors(_) => 3,
            Self::Float64(_) | Self::Float32(_) | Self::UInt8(_) => 1,
        }
    }

    fn bytes(self) -> Vec<u8> {
        match self {
            Self::Float64(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::Float32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::Vectors(vectors) => {
                let values = vectors.as_flattened().iter();
                values.flat_map(|v| v.to_le_bytes()).collect()
            }
            Self::UInt8(values) => values.to_vec(),
        }
    }
}

/// Cells of one kind between nodes.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    nodes: &'a [Vec3],
    /// Nodes of the cells, one cell after the other.
    corners: &'a [u32],
    corners_of_cell: usize,
    /// VTK's number of the kind.
    kind: u8,
}

impl<'a> Grid<'a> {
    /// Triangles, anticlockwise seen from outside.
    pub fn triangles(nodes: &'a [Vec3], triangles: &'a [[u32; 3]]) -> Self {
        Self {
            nodes,
            corners: triangles.as_flattened(),
            corners_of_cell: 3,
            kind: 5,
        }
    }

    /// Quads, anticlockwise seen from outside.
    pub fn quads(nodes: &'a [Vec3], quads: &'a [[u32; 4]]) -> Self {
        Self {
            nodes,
            corners: quads.as_flattened(),
            corners_of_cell: 4,
            kind: 9,
        }
    }

    fn hexahedra(mesh: &'a HexMesh) -> Self {
        Self {
            nodes: &mesh.nodes,
            corners: mesh.hexes.as_flattened(),
            corners_of_cell: 8,
            kind: 12,
        }
    }

    fn cells(&self) -> usize {
        self.corners.len() / self.corners_of_cell
    }
}

/// How many bytes coordinates and node numbers take.
#[derive(Clone, Copy)]
enum Width {
    /// Eight each.
    Whole,
    /// Four each.
    Compact,
}

/// A `.vtu` file of the mesh with its arrays, as bytes.
///
/// # Errors
/// [`MeshFileError::ArrayLength`] where an array does not have one value a node.
pub fn vtu_bytes(mesh: &HexMesh, arrays: &[PointArray]) -> Result<Vec<u8>, MeshFileError> {
    grid_bytes(&Grid::hexahedra(mesh), Width::Whole, arrays)
}

/// A `.vtu` file for pictures, as bytes: coordinates of 32 bits, which is 1e-6 mm in a knee.
///
/// # Errors
/// As [`vtu_bytes`].
pub fn compact_vtu_bytes(grid: &Grid, arrays: &[PointArray]) -> Result<Vec<u8>, MeshFileError> {
    grid_bytes(grid, Width::Compact, arrays)
}

fn grid_bytes(grid: &Grid, width: Width, arrays: &[PointArray]) -> Result<Vec<u8>, MeshFileError> {
    for array in arrays {
        check_length(grid, array)?;
    }
    let data = data_arrays(grid, width, arrays);
    let mut bytes = xml(grid, &data, arrays.len()).into_bytes();
    for array in data.iter().rev() {
        bytes.extend_from_slice(&(array.bytes.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&array.bytes);
    }
    bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
    Ok(bytes)
}

fn check_length(grid: &Grid, array: &PointArray) -> Result<(), MeshFileError> {
    let (values, nodes) = (array.values.len(), grid.nodes.len());
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

/// An array as its element in the XML names it, and its bytes behind the XML.
struct DataArray {
    kind: &'static str,
    name: String,
    components: usize,
    bytes: Vec<u8>,
}

impl DataArray {
    /// Length of its block: a byte count of eight bytes, then the bytes.
    fn block_length(&self) -> usize {
        8 + self.bytes.len()
    }

    fn element(&self, offset: usize) -> String {
        // Readers take an array without a count for a plain list, one with a count of 1 for a column.
        let count = match self.components {
            1 => String::new(),
            components => format!(" NumberOfComponents=\"{components}\""),
        };
        format!(
            "<DataArray type=\"{}\" Name=\"{}\"{count} format=\"appended\" offset=\"{offset}\"/>\n",
            self.kind,
            escaped(&self.name)
        )
    }
}

/// All arrays in the order of the XML: values at the nodes, points, cells.
fn data_arrays(grid: &Grid, width: Width, arrays: &[PointArray]) -> Vec<DataArray> {
    let array = |kind, name: &str, components, bytes| DataArray {
        kind,
        name: name.to_owned(),
        components,
        bytes,
    };
    let (float, integer) = width.kinds();
    let cells = grid.cells();
    let mut corners = grid.corners.iter().map(|&node| node.into());
    let mut ends = (1..=cells).map(|cell| (grid.corners_of_cell * cell) as i64);
    let at_nodes = arrays.iter().map(|given| {
        let values = given.values;
        array(
            values.kind(),
            given.name,
            values.components(),
            values.bytes(),
        )
    });
    let of_mesh = [
        array(float, "Points", 3, width.floats(grid.nodes)),
        array(integer, "connectivity", 1, width.integers(&mut corners)),
        array(integer, "offsets", 1, width.integers(&mut ends)),
        array("UInt8", "types", 1, vec![grid.kind; cells]),
    ];
    at_nodes.chain(of_mesh).collect()
}

/// Everything before the bytes; the first `at_nodes` of the arrays are values at the nodes.
fn xml(grid: &Grid, data: &[DataArray], at_nodes: usize) -> String {
    let (node_count, cell_count) = (grid.nodes.len(), grid.cells());
    let mut offset: usize = data.iter().map(DataArray::block_length).sum();
    let mut elements = data.iter().map(|array| {
        offset -= array.block_length();
        array.element(offset)
    });
    let mut next = |count: usize| elements.by_ref().take(count).collect::<String>();
    let (point_data, points, cells) = (next(at_nodes), next(1), next(3));
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{node_count}\" NumberOfCells=\"{cell_count}\">\n\
         <PointData>\n{point_data}</PointData>\n<Points>\n{points}</Points>\n\
         <Cells>\n{cells}</Cells>\n</Piece>\n</UnstructuredGrid>\n\
         <AppendedData encoding=\"raw\">\n_"
    )
}

impl Width {
    /// VTK's names of the kinds of floating numbers and integers.
    fn kinds(self) -> (&'static str, &'static str) {
        match self {
            Self::Whole => ("Float64", "Int64"),
            Self::Compact => ("Float32", "Int32"),
        }
    }

    fn floats(self, places: &[Vec3]) -> Vec<u8> {
        let values = places.iter().flat_map(|place| [place.x, place.y, place.z]);
        match self {
            Self::Whole => values.flat_map(f64::to_le_bytes).collect(),
            Self::Compact => values.flat_map(|v| (v as f32).to_le_bytes()).collect(),
        }
    }

    fn integers(self, numbers: &mut dyn Iterator<Item = i64>) -> Vec<u8> {
        match self {
            Self::Whole => numbers.flat_map(i64::to_le_bytes).collect(),
            Self::Compact => numbers.flat_map(|n| (n as i32).to_le_bytes()).collect(),
        }
    }
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
    use crate::formats::fixtures::{message, two_cubes};
    use crate::formats::on_disk::{read_vtu_points, write_vtu};

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

    /// As meshio 5.3 finds the arrays of the blocks: the first with the offset of a block is its
    /// array, and has from then on the offset of its base64.
    fn names_of_blocks(bytes: &[u8]) -> Vec<String> {
        let start = bytes.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
        let xml = std::str::from_utf8(&bytes[..start]).unwrap();
        let mut arrays: Vec<(String, usize)> = xml
            .lines()
            .filter_map(|row| {
                let quoted = |key: &str| row.split_once(key)?.1.split('"').next();
                Some((
                    quoted(" Name=\"")?.to_owned(),
                    quoted(" offset=\"")?.parse().ok()?,
                ))
            })
            .collect();
        let (mut at, mut in_base64, mut names) = (0, 0, Vec::new());
        while names.len() < arrays.len() {
            let array = arrays.iter_mut().find(|(_, offset)| *offset == at).unwrap();
            array.1 = in_base64;
            names.push(array.0.clone());
            let count = bytes[start + at..][..8].try_into().unwrap();
            let block = 8 + u64::from_le_bytes(count) as usize;
            at += block;
            in_base64 += block.div_ceil(3) * 4;
        }
        names
    }

    #[test]
    fn meshio_finds_the_array_of_each_block_whatever_the_number_of_points() {
        for more in 0..9 {
            let mut mesh = two_cubes();
            mesh.nodes.extend(vec![Vec3::zeros(); more]);
            let values = vec![0.5; mesh.nodes.len()];
            let names = ["a_mm", "b_mm", "c_mm", "d_mm", "e_mm"];
            let arrays = names.map(|name| PointArray {
                name,
                values: PointValues::Float64(&values),
            });
            let mut found = names_of_blocks(&vtu_bytes(&mesh, &arrays).unwrap());
            found.reverse();
            let of_mesh = ["Points", "connectivity", "offsets", "types"];
            assert_eq!(found, [&names[..], &of_mesh].concat(), "{more} points more");
        }
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
