//! Prints the insert of a case as tetrahedra in a legacy VTK file, mm, for programs that want them.
//!
//! `cargo run --release -p condyle-lab --example insert_tetrahedra -- CASE > insert.vtk`

use std::error::Error;

use condyle_case::case::Case;

/// A hexahedron as six tetrahedra around its diagonal from corner 0 to corner 6; neighbours whose
/// corners are numbered alike fit.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 2, 6],
    [0, 2, 3, 6],
    [0, 3, 7, 6],
    [0, 7, 4, 6],
    [0, 4, 5, 6],
    [0, 5, 1, 6],
];

fn main() -> Result<(), Box<dyn Error>> {
    let case = std::env::args().nth(1).ok_or("say a case")?;
    let test = Case::read(case.as_ref())?.build(1)?.test;
    let mesh = test.insert.mesh();
    let count = mesh.hexes.len() * TETRAHEDRA.len();
    println!("# vtk DataFile Version 3.0\ninsert, mm\nASCII\nDATASET UNSTRUCTURED_GRID");
    println!("POINTS {} double", mesh.nodes.len());
    for node in &mesh.nodes {
        println!("{} {} {}", node.x, node.y, node.z);
    }
    println!("CELLS {count} {}", 5 * count);
    for hex in mesh.hexes.iter() {
        for corners in TETRAHEDRA {
            let [a, b, c, d] = corners.map(|corner| hex[corner]);
            println!("4 {a} {b} {c} {d}");
        }
    }
    println!("CELL_TYPES {count}");
    println!("{}", "10\n".repeat(count));
    Ok(())
}
