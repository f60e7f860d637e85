//! VTK unstructured grids (`.vtu`), out: appended raw bytes, the same bytes for the same mesh.
//!
//! The blocks of bytes are in the opposite order to the arrays that refer to them by their offsets. meshio 5.3 reads
//! block after block, assigns each to the first array with the block's offset, and then changes the offset of that
//! array, possibly to that of a later block. If the array of the later block comes first, meshio finds it first.

use condyle_fem::HexMesh;

use super::error::MeshFileError;
use crate::Vec3;

/// Values at the nodes.
#[derive(Clone, Copy, Debug)]
pub enum PointValues<'a> {
    /// Written as Float64.
    Float64(&'a [f64]),
    /// Written as Float32.
    Float32(&'a [f32]),
    /// Vectors, written as Float64 of three components.
    Vectors(&'a [[f64; 3]]),
    /// Written as UInt8; values of 0 and 1 are read back as a surface.
    UInt8(&'a [u8]),
}

/// A named array with one value or vector per node.
#[derive(Clone, Copy, Debug)]
pub struct PointArray<'a> {
    /// Name with the unit in it, such as `wear_depth_mm`.
    pub name: &'a str,
    /// One value or vector per node of the mesh.
    pub values: PointValues<'a>,
}

/// Cells of one kind between nodes.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    nodes: &'a [Vec3],
    corners: &'a [u32],
    corners_of_cell: usize,
    kind: u8,
}

impl<'a> Grid<'a> {
    /// Creates a grid of triangles, anticlockwise seen from outside.
    pub fn triangles(nodes: &'a [Vec3], triangles: &'a [[u32; 3]]) -> Self {
        Self::new(nodes, triangles, 5)
    }

    /// Creates a grid of quads, anticlockwise seen from outside.
    pub fn quads(nodes: &'a [Vec3], quads: &'a [[u32; 4]]) -> Self {
        Self::new(nodes, quads, 9)
    }

    fn new<const N: usize>(nodes: &'a [Vec3], cells: &'a [[u32; N]], kind: u8) -> Self {
        Self {
            nodes,
            corners: cells.as_flattened(),
            corners_of_cell: N,
            kind,
        }
    }
}

/// Returns a `.vtu` file of the mesh with its arrays, as bytes.
///
/// # Errors
/// [`MeshFileError::ArrayLength`] if an array does not have one value per node.
pub fn vtu_bytes(mesh: &HexMesh, arrays: &[PointArray]) -> Result<Vec<u8>, MeshFileError> {
    let grid = Grid::new(&mesh.nodes, &mesh.hexes, 12);
    grid_bytes(&grid, arrays, false)
}

/// Returns a `.vtu` file for pictures, as bytes: coordinates of 32 bits, which resolve 1e-6 mm in a knee.
///
/// # Errors
/// As [`vtu_bytes`].
pub fn compact_vtu_bytes(grid: &Grid, arrays: &[PointArray]) -> Result<Vec<u8>, MeshFileError> {
    grid_bytes(grid, arrays, true)
}

/// An array with the attributes of its XML element, and its bytes behind the XML.
struct DataArray<'a> {
    name: &'a str,
    kind: &'static str,
    components: usize,
    bytes: Vec<u8>,
}

fn le_bytes<T, const N: usize>(
    values: impl IntoIterator<Item = T>,
    to_bytes: fn(T) -> [u8; N],
) -> Vec<u8> {
    values.into_iter().flat_map(to_bytes).collect()
}

impl<'a> DataArray<'a> {
    /// Encodes an array, if it has a value for each of some nodes.
    fn at_nodes(array: &PointArray<'a>, nodes: usize) -> Result<Self, MeshFileError> {
        let doubles = |values: &[f64]| le_bytes(values.iter().copied(), f64::to_le_bytes);
        let (kind, components, values, bytes) = match array.values {
            PointValues::Float64(v) => ("Float64", 1, v.len(), doubles(v)),
            PointValues::Vectors(v) => ("Float64", 3, v.len(), doubles(v.as_flattened())),
            PointValues::Float32(v) => {
                let bytes = le_bytes(v.iter().copied(), f32::to_le_bytes);
                ("Float32", 1, v.len(), bytes)
            }
            PointValues::UInt8(v) => ("UInt8", 1, v.len(), v.to_vec()),
        };
        if values != nodes {
            let name = array.name.to_string();
            return Err(MeshFileError::ArrayLength {
                name,
                values,
                nodes,
            });
        }
        Ok(Self {
            name: array.name,
            kind,
            components,
            bytes,
        })
    }

    /// Returns the length of its block: a byte count of eight bytes, then the bytes.
    fn block_length(&self) -> usize {
        8 + self.bytes.len()
    }
}

fn grid_bytes(grid: &Grid, arrays: &[PointArray], compact: bool) -> Result<Vec<u8>, MeshFileError> {
    let arrays = arrays.iter();
    let at_nodes = arrays.map(|array| DataArray::at_nodes(array, grid.nodes.len()));
    let mut data: Vec<DataArray> = at_nodes.collect::<Result<_, _>>()?;
    let count = data.len();
    data.extend(mesh_arrays(grid, compact));
    let mut bytes = xml(grid, &data, count).into_bytes();
    for array in data.iter().rev() {
        bytes.extend_from_slice(&(array.bytes.len() as u64).to_le_bytes());
        bytes.extend_from_slice(&array.bytes);
    }
    bytes.extend_from_slice(b"\n</AppendedData>\n</VTKFile>\n");
    Ok(bytes)
}

/// Encodes points, connectivity, offsets and types, in the order of the XML; `compact` numbers take 32 bits.
fn mesh_arrays(grid: &Grid, compact: bool) -> [DataArray<'static>; 4] {
    let nodes = grid.nodes.iter();
    let places = nodes.flat_map(|place| [place.x, place.y, place.z]);
    let cells = grid.corners.len() / grid.corners_of_cell;
    let corners = grid.corners.iter().copied();
    let ends = (1..=cells as u32).map(|cell| grid.corners_of_cell as u32 * cell);
    let (float, integer, points, connectivity, offsets) = if compact {
        let points = le_bytes(places.map(|v| v as f32), f32::to_le_bytes);
        let corners = le_bytes(corners, u32::to_le_bytes);
        let ends = le_bytes(ends, u32::to_le_bytes);
        ("Float32", "Int32", points, corners, ends)
    } else {
        let points = le_bytes(places, f64::to_le_bytes);
        let corners = le_bytes(corners.map(i64::from), i64::to_le_bytes);
        let ends = le_bytes(ends.map(i64::from), i64::to_le_bytes);
        ("Float64", "Int64", points, corners, ends)
    };
    [
        ("Points", float, 3, points),
        ("connectivity", integer, 1, connectivity),
        ("offsets", integer, 1, offsets),
        ("types", "UInt8", 1, vec![grid.kind; cells]),
    ]
    .map(|(name, kind, components, bytes)| DataArray {
        name,
        kind,
        components,
        bytes,
    })
}

/// Returns everything before the bytes; the first `at_nodes` of the arrays are values at the nodes.
fn xml(grid: &Grid, data: &[DataArray], at_nodes: usize) -> String {
    let mut offset: usize = data.iter().map(DataArray::block_length).sum();
    let mut elements = data.iter().map(|array| {
        offset -= array.block_length();
        // Readers take an array without a count for a plain list, one with a count of 1 for a column.
        let count = match array.components {
            1 => String::new(),
            components => format!(" NumberOfComponents=\"{components}\""),
        };
        format!(
            "<DataArray type=\"{}\" Name=\"{}\"{count} format=\"appended\" offset=\"{offset}\"/>\n",
            array.kind,
            escaped(array.name)
        )
    });
    let mut next = |count: usize| elements.by_ref().take(count).collect::<String>();
    let (point_data, points, cells) = (next(at_nodes), next(1), next(3));
    let (node_count, cell_count) = (grid.nodes.len(), grid.corners.len() / grid.corners_of_cell);
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" \
         byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n\
         <Piece NumberOfPoints=\"{node_count}\" NumberOfCells=\"{cell_count}\">\n\
         <PointData>\n{point_data}</PointData>\n<Points>\n{points}</Points>\n\
         <Cells>\n{cells}</Cells>\n</Piece>\n</UnstructuredGrid>\n\
         <AppendedData encoding=\"raw\">\n_"
    )
}

/// Escapes text as the value of an XML attribute.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::parse_vtu_points;
    use crate::formats::tests::{message, two_cubes};

    #[test]
    fn a_file_is_written_and_read_back() {
        let values = [0.5; 12];
        let array = PointArray {
            name: "a<b & \"c\"",
            values: PointValues::Float64(&values),
        };
        let bytes = vtu_bytes(&two_cubes(), &[array]).unwrap();
        let file = parse_vtu_points("insert.vtu".as_ref(), &bytes).unwrap();
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
        let reported = message(vtu_bytes(&two_cubes(), &[array]));
        assert_eq!(
            reported,
            "array \"mark\" has 2 values for 12 nodes; give one value per node"
        );
    }
}
