//! The maps of a run: fields of the last mesh, and the slip paths.

use colorous::{CIVIDIS, Gradient, MAGMA, VIRIDIS};
use condyle_mesh::Vec3;
use condyle_results::{Directions, MAP_PICTURES, SLIP_PATHS_PICTURE};

use crate::figure::{ColourRange, Map, MapStyle, Path, finite_range};
use crate::results::{Results, SurfaceFields, Table};

pub(crate) struct MappedField {
    pub(crate) field: &'static str,
    /// Name of the picture as a file, without an ending.
    pub(crate) file: &'static str,
    pub(crate) style: MapStyle,
    pub(crate) caption: &'static str,
}

const fn style([id, title, unit, largest]: [&'static str; 4], shades: Gradient) -> MapStyle {
    MapStyle {
        id,
        title,
        unit,
        largest,
        shades,
    }
}

/// All fields that have a map, in the order of the page; wear depth is the first.
pub(crate) static MAPS: [MappedField; 6] = [
    MappedField {
        field: "wear_depth_mm",
        file: MAP_PICTURES[0],
        style: style(["map-wear", "Wear depth", "mm", "Deepest"], MAGMA),
        caption: "",
    },
    MappedField {
        field: "peak_pressure_mpa",
        file: MAP_PICTURES[1],
        style: style(["map-pressure", "Peak pressure", "MPa", "Highest"], VIRIDIS),
        caption: "Largest contact pressure of each node in the final cycle, averaged over its share of the surface.",
    },
    MappedField {
        field: "sliding_distance_mm",
        file: MAP_PICTURES[2],
        style: style(
            ["map-sliding", "Sliding distance", "mm", "Highest"],
            CIVIDIS,
        ),
        caption: "Sliding distance of the counterface over each place under pressure in the final cycle: the mean of all activities by \
         their shares of the cycles.",
    },
    MappedField {
        field: "cross_shear",
        file: MAP_PICTURES[3],
        style: style(
            ["map-cross-shear", "Cross-shear ratio", "", "Highest"],
            MAGMA,
        ),
        caption: "The part of pressure times sliding across the principal direction of each place, in the final cycle: 0 for \
         sliding along a line, 0.5 for a circle.",
    },
    MappedField {
        field: "creep_depth_mm",
        file: MAP_PICTURES[4],
        style: style(["map-creep", "Creep", "mm", "Deepest"], VIRIDIS),
        caption: "Depth of the surface by creep under load, at the last update; creep loses no mass.",
    },
    MappedField {
        field: "permanent_set_mm",
        file: MAP_PICTURES[5],
        style: style(["map-set", "Permanent set", "mm", "Deepest"], VIRIDIS),
        caption: "Permanent depth of the surface by yielding, after the final cycle, without wear.",
    },
];

/// Returns the colours of a field at even distances from little to much: those of its map, or of a map of its own.
pub(crate) fn colours(field: &str) -> Vec<String> {
    const COUNT: usize = 33;
    let mapped = MAPS.iter().find(|mapped| mapped.field == field);
    let style = mapped.unwrap_or(&MAPS[1]).style;
    let share = |at: usize| at as f64 / (COUNT - 1) as f64;
    (0..COUNT).map(|at| style.colour(share(at))).collect()
}

impl MappedField {
    /// Returns the map of a surface; `None` without the field.
    pub(crate) fn of<'a>(
        &self,
        surface: &'a SurfaceFields,
        directions: Directions,
        px_per_mm: f64,
    ) -> Option<Map<'a>> {
        Some(Map {
            style: self.style,
            surface,
            values: surface.field(self.field)?,
            directions,
            range: ColourRange::Own,
            px_per_mm: readable(px_per_mm, surface),
        })
    }
}

/// A map as it is drawn on a page or into a file.
pub(crate) struct DrawnMap {
    /// Name of the picture as a file, without an ending.
    pub(crate) file: &'static str,
    pub(crate) caption: &'static str,
    pub(crate) svg: String,
}

/// Returns a scale at which the labels of a map, which have one size, do not cover each other on a small surface: that of the
/// page, or more.
fn readable(px_per_mm: f64, surface: &SurfaceFields) -> f64 {
    /// Least length of the longer side.
    const LEAST_PX: f64 = 200.0;
    let [x_mm, z_mm] = surface.bounds().map(|(low, high)| high - low);
    px_per_mm.max(LEAST_PX / x_mm.max(z_mm))
}

/// Draws the maps of those of the fields that a run has, then the slip paths; `draw` makes a picture of a map, its
/// description and what is drawn over it.
pub(crate) fn drawn(
    fields: &[MappedField],
    results: &Results,
    px_per_mm: f64,
    draw: impl Fn(&Map<'_>, &str, &str) -> String,
) -> Vec<DrawnMap> {
    let Some(surface) = &results.surface else {
        return Vec::new();
    };
    let map = |field: &MappedField| {
        let map = field.of(surface, results.directions(), px_per_mm)?;
        Some(DrawnMap {
            file: field.file,
            caption: field.caption,
            svg: draw(&map, &map.desc(), ""),
        })
    };
    let mut maps: Vec<_> = fields.iter().filter_map(map).collect();
    let bare = vec![0.0; surface.nodes.len()];
    let map = Map {
        style: style(["map-slip", "Slip paths", "", ""], MAGMA),
        surface,
        values: &bare,
        directions: results.directions(),
        range: ColourRange::Own,
        px_per_mm: readable(px_per_mm, surface),
    };
    let paths = results.slip_paths.as_ref();
    let paths = paths
        .and_then(|table| slip_paths(table, &map))
        .unwrap_or_default();
    if !paths.is_empty() {
        let desc = format!(
            "Paths of the counterface past {} places of the articulating surface shortened and widened.",
            paths.len()
        );
        maps.push(DrawnMap {
            file: SLIP_PATHS_PICTURE,
            caption: "Slip of the counterface past the deepest place of each region and past four places around it, \
                      while they are loaded, in the final cycle. Each path is drawn around the dot of \
                      its place, with its length times 0.4 and its width times 1.6, so its width is exaggerated by a \
                      factor of four. Wide paths have more cross-shear.",
            svg: draw(&map, &desc, &paths.concat()),
        });
    }
    maps
}

/// Factors on length and width with which a slip path is drawn: neighbours stay apart, and its width shows.
const DRAWN: [f64; 2] = [0.4, 1.6];
const DOT_PX: f64 = 2.2;

/// Draws each path of `slip_paths.csv` with its middle at its place, and a dot there; `None` if the table lacks a column.
fn slip_paths(table: &Table, map: &Map<'_>) -> Option<Vec<String>> {
    let column = |name| table.column(name);
    let (numbers, x, z) = (column("path")?, column("x_mm")?, column("z_mm")?);
    let either = |name, earlier| column(name).or_else(|| column(earlier));
    // Earlier versions wrote the names of a knee's directions.
    let slip_x = either("slip_x_mm", "slip_anterior_mm")?;
    let slip_z = either("slip_z_mm", "slip_right_mm")?;
    let middle = |values: &mut dyn Iterator<Item = f64>| {
        finite_range(values).map_or(0.0, |(low, high)| f64::midpoint(low, high))
    };
    let flat = map.surface.flat();
    // Of a cup, the place of the nearest node: the file states x and z only.
    let on_map = |x: f64, z: f64| {
        let away = |node: &Vec3| (node.x - x).hypot(node.z - z);
        let nodes = map.surface.nodes.iter().zip(&flat);
        let nearest = nodes.min_by(|a, b| away(a.0).total_cmp(&away(b.0)));
        let nearest = nearest.filter(|_| map.surface.is_cup);
        nearest.map_or([x, z], |(_, place)| *place)
    };
    let path = |rows: &[usize]| {
        let mut at = (0.0, 0.0);
        let mut points = vec![at];
        for &row in rows {
            at = (at.0 + DRAWN[0] * slip_x[row], at.1 + DRAWN[1] * slip_z[row]);
            points.push(at);
        }
        let across = middle(&mut points.iter().map(|point| point.0));
        let along = middle(&mut points.iter().map(|point| point.1));
        let [x, z] = on_map(x[rows[0]], z[rows[0]]);
        let mut line = Path::default();
        let places = points.iter();
        line.open(places.map(|point| map.place()(x + point.0 - across, z + point.1 - along)));
        let (line, (x, y)) = (line.data(), map.place()(x, z));
        format!(
            r#"<path class="slip" d="{line}"/><circle class="slip-place" cx="{x:.1}" cy="{y:.1}" r="{DOT_PX}"/>"#
        )
    };
    let rows = Vec::from_iter(0..table.rows());
    let paths = rows.chunk_by(|&one, &next| numbers[one] == numbers[next]);
    Some(paths.map(path).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_one_number_are_one_path() {
        let text = "path,x_mm,z_mm,percent,pressure_mpa,slip_x_mm,slip_z_mm\n\
            1,2,3,0.5,4,1,0\n1,2,3,1,4,0,1\n2,5,6,1,4,-1,0\n";
        let table = Table::parse(text, "slip_paths.csv".as_ref()).unwrap();
        let corner = |at: f64| Vec3::new(at, 0.0, at);
        let surface = SurfaceFields {
            nodes: vec![corner(-10.0), corner(10.0)],
            ..SurfaceFields::default()
        };
        let map = Map {
            style: MAPS[0].style,
            surface: &surface,
            values: &[0.0; 2],
            directions: Directions::default(),
            range: ColourRange::Own,
            px_per_mm: 10.0,
        };
        let paths = slip_paths(&table, &map).unwrap();
        assert_eq!(paths.len(), 2);
        // Anterior is up and right is to the right; 0.4 mm and 1.6 mm around (2, 3).
        assert!(
            paths[0].contains(r#"d="m152 112l0-4l16 0""#),
            "{}",
            paths[0]
        );
        assert!(paths[1].contains(r#"cx="190.0" cy="80.0""#), "{}", paths[1]);
    }
}
