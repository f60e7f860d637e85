//! `slip_paths.csv`: slip of the femur past some places of the insert in the last cycle.

use condyle::{Vec3, evolve::March, geometry::SurfaceRegions};

use super::side::{Side, point_on_side};

/// Distance of the other places of a side from its deepest one, mm.
const AROUND_MM: f64 = 6.0;

/// Returns `slip_paths.csv`: the slip of the femur past the deepest place of each region and past four places
/// around it, with one row per increment in which the place is under pressure; none before a march has solved a cycle.
pub(super) fn slip_paths_csv(march: &March, side: Side) -> Option<String> {
    let cycle = march.last_cycle()?;
    let mut text = String::from("path,x_mm,z_mm,percent,pressure_mpa,slip_x_mm,slip_z_mm\n");
    let depth_mm = &march.fields().wear_depth_mm;
    let nodes = places(&cycle.surface.positions, depth_mm, march.insert().regions());
    for (path, node) in nodes.into_iter().enumerate() {
        let path = path + 1;
        let place = point_on_side(&cycle.surface.positions[node], side);
        for (increment, row) in cycle.rows.iter().enumerate() {
            let Some(moment) = cycle.moment(increment, node) else {
                continue;
            };
            let [x, z] = moment.slip_mm;
            let slip = point_on_side(&Vec3::new(x, 0.0, z), side);
            let (x, z, percent, pressure) = (place.x, place.z, row.percent, moment.pressure_mpa);
            text += &format!(
                "{path},{x},{z},{percent},{pressure},{},{}\n",
                slip.x, slip.z
            );
        }
    }
    Some(text)
}

/// Returns the deepest node of each region that is worn and the nodes nearest to the places around it, each once.
fn places(positions: &[Vec3], depth_mm: &[f64], regions: &SurfaceRegions) -> Vec<usize> {
    let mut nodes = Vec::new();
    for region in 0..regions.count() {
        let own = (0..positions.len())
            .filter(|&node| regions.of_node(node) == region && depth_mm[node] > 0.0);
        let Some(deepest) = own.max_by(|&a, &b| depth_mm[a].total_cmp(&depth_mm[b])) else {
            continue;
        };
        let middle = positions[deepest];
        let around = [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        for [x, z] in around {
            let (x, z) = (middle.x + AROUND_MM * x, middle.z + AROUND_MM * z);
            let distance = |node: usize| (positions[node].x - x).hypot(positions[node].z - z);
            let nearest = |&a: &usize, &b: &usize| distance(a).total_cmp(&distance(b));
            let node = (0..positions.len()).min_by(nearest).unwrap_or(0);
            // On a coarse mesh one node may be nearest to several places.
            if !nodes.contains(&node) {
                nodes.push(node);
            }
        }
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_the_deepest_of_each_side_and_four_around_each_once() {
        let at = |x: f64, z: f64| Vec3::new(x, 0.0, z);
        let left = [
            at(0.0, -20.0),
            at(6.0, -20.0),
            at(-6.0, -20.0),
            at(0.0, -14.0),
            at(0.0, -26.0),
        ];
        let positions = [&left[..], &[at(1.0, 20.0)]].concat();
        let depth_mm = [0.3, 0.1, 0.2, 0.1, 0.0, 0.1];
        // On the right there is one node, nearest to every place around it.
        let names = ["left", "right"];
        let regions =
            SurfaceRegions::split(&names, positions.clone(), |at| usize::from(at.z > 0.0));
        let found = |depth_mm: &[f64]| places(&positions, depth_mm, &regions);
        assert_eq!(found(&depth_mm), [0, 1, 2, 3, 4, 5]);
        assert_eq!(found(&[0.0, 0.1, 0.0, 0.0, 0.0, 0.0])[0], 1);
        assert!(found(&[0.0; 6]).is_empty());
    }
}
