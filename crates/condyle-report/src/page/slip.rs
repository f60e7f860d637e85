//! The paths that the femur slides past places of the insert.

use crate::figure::{ColourRange, Map, Path, Shades};
use crate::results::{contents::Results, surface::SurfaceFields, table::Table};

/// Parts of its true length and width that a path is drawn with: neighbours stay apart, and how wide it is shows.
const DRAWN: [f64; 2] = [0.4, 1.6];
/// Radius of the dot at a place, px.
const DOT_PX: f64 = 2.2;

/// The slip past one place of the insert.
struct SlipPath {
    /// x and z of the place, mm.
    place: (f64, f64),
    /// Slip of each increment, anterior and to the right, mm.
    slips: Vec<(f64, f64)>,
}

/// The bare surface with the paths, each about its place, as `picture` makes it of the map, a sentence and what is drawn
/// over it; `None` without any.
pub(crate) fn slip_map(
    results: &Results,
    px_per_mm: f64,
    picture: impl Fn(&Map<'_>, &str, &str) -> String,
) -> Option<String> {
    let (surface, table) = (results.surface.as_ref()?, results.slip_paths.as_ref()?);
    let paths = slip_paths(table)?;
    let bare = vec![0.0; surface.nodes.len()];
    let map = bare_map(surface, &bare, results, px_per_mm);
    let drawn: String = paths.iter().map(|path| drawn(path, &map)).collect();
    let desc = format!(
        "Paths of the femur past {} places of the articulating surface from above, anterior up, shortened and widened.",
        paths.len()
    );
    (!paths.is_empty()).then(|| picture(&map, &desc, &drawn))
}

fn bare_map<'a>(
    surface: &'a SurfaceFields,
    bare: &'a [f64],
    results: &Results,
    px_per_mm: f64,
) -> Map<'a> {
    Map {
        id: "map-slip",
        title: "Slip paths",
        unit: "",
        largest: "",
        surface,
        values: bare,
        side: results.side,
        shades: Shades::Magma,
        range: ColourRange::Own,
        px_per_mm,
    }
}

/// The paths of `slip_paths.csv`; `None` if it lacks a column.
fn slip_paths(table: &Table) -> Option<Vec<SlipPath>> {
    let column = |name| table.column(name);
    let (numbers, x, z) = (column("path")?, column("x_mm")?, column("z_mm")?);
    let (anterior, right) = (column("slip_anterior_mm")?, column("slip_right_mm")?);
    let mut paths: Vec<SlipPath> = Vec::new();
    for row in 0..table.rows() {
        if row == 0 || numbers[row] != numbers[row - 1] {
            paths.push(SlipPath {
                place: (x[row], z[row]),
                slips: Vec::new(),
            });
        }
        if let Some(path) = paths.last_mut() {
            path.slips.push((anterior[row], right[row]));
        }
    }
    Some(paths)
}

/// A path with its middle at its place, and a dot there.
fn drawn(path: &SlipPath, map: &Map<'_>) -> String {
    let sums = path.slips.iter().scan((0.0, 0.0), |at, slip| {
        *at = (at.0 + DRAWN[0] * slip.0, at.1 + DRAWN[1] * slip.1);
        Some(*at)
    });
    let points: Vec<(f64, f64)> = std::iter::once((0.0, 0.0)).chain(sums).collect();
    let middle = (
        middle(points.iter().map(|point| point.0)),
        middle(points.iter().map(|point| point.1)),
    );
    let (x, z) = path.place;
    let mut line = Path::default();
    line.open(
        points
            .iter()
            .map(|point| map.place()(x + point.0 - middle.0, z + point.1 - middle.1)),
    );
    let (across, down) = map.place()(x, z);
    format!(
        r#"<path class="slip" d="{}"/><circle class="slip-place" cx="{across:.1}" cy="{down:.1}" r="{DOT_PX}"/>"#,
        line.data()
    )
}

/// Half way between the least and the largest.
fn middle(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let low = values.clone().fold(f64::INFINITY, f64::min);
    f64::midpoint(low, values.fold(f64::NEG_INFINITY, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_one_number_are_one_path() {
        let text = "path,x_mm,z_mm,percent,pressure_mpa,slip_anterior_mm,slip_right_mm\n\
            1,2,3,0.5,4,1,0\n1,2,3,1,4,0,1\n2,5,6,1,4,-1,0\n";
        let table = Table::parse(text, "slip_paths.csv".as_ref()).unwrap();
        let paths = slip_paths(&table).unwrap();
        assert_eq!(paths.len(), 2);
        assert_eq!(paths[0].slips, [(1.0, 0.0), (0.0, 1.0)]);
        assert_eq!(paths[1].place, (5.0, 6.0));
    }
}
