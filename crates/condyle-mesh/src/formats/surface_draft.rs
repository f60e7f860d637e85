//! A surface as it is being read: polygons become triangles, equal points one vertex.

use std::collections::HashMap;
use std::path::Path;

use crate::TriangleMesh;
use crate::Vec3;

use super::error::{FileLine, MeshFileError};

/// Vertices and polygons in the order of the file, with the lines they came from.
pub(crate) struct SurfaceDraft<'a> {
    path: &'a Path,
    /// What the file calls its first vertex: 0 or 1.
    first_vertex: i64,
    points: Vec<Vec3>,
    triangles: Vec<DraftTriangle>,
    polygons: usize,
}

struct DraftTriangle {
    corners: [i64; 3],
    polygon: usize,
    line: Option<usize>,
}

impl<'a> SurfaceDraft<'a> {
    pub(crate) fn new(path: &'a Path, first_vertex: i64) -> Self {
        Self {
            path,
            first_vertex,
            points: Vec::new(),
            triangles: Vec::new(),
            polygons: 0,
        }
    }

    pub(crate) fn points(&self) -> usize {
        self.points.len()
    }

    /// Adds the next vertex.
    pub(crate) fn point(
        &mut self,
        line: Option<usize>,
        point: [f64; 3],
    ) -> Result<(), MeshFileError> {
        let number = self.points.len() as i64 + self.first_vertex;
        if point.iter().any(|coordinate| !coordinate.is_finite()) {
            return Err(MeshFileError::NonFinite {
                at: FileLine::new(self.path, line),
                what: format!("vertex {number}"),
            });
        }
        // Adding zero turns -0 into 0, which would otherwise be another point.
        self.points.push(Vec3::from(point).add_scalar(0.0));
        Ok(())
    }

    /// Adds a polygon by the file's vertex numbers, cut into triangles as a fan.
    pub(crate) fn polygon(
        &mut self,
        line: Option<usize>,
        corners: &[i64],
    ) -> Result<(), MeshFileError> {
        let polygon = self.polygons + self.first_vertex as usize;
        self.polygons += 1;
        if corners.len() < 3 {
            let what = format!(
                "polygon {polygon} has {} corners; it needs three or more",
                corners.len()
            );
            return Err(FileLine::new(self.path, line).error(what));
        }
        let fan = corners[1..].windows(2).map(|ends| DraftTriangle {
            corners: [corners[0], ends[0], ends[1]],
            polygon,
            line,
        });
        self.triangles.extend(fan);
        Ok(())
    }

    /// The mesh, points of equal coordinates welded and those no triangle uses dropped.
    pub(crate) fn finish(self) -> Result<TriangleMesh, MeshFileError> {
        if self.triangles.is_empty() {
            let path = self.path.to_path_buf();
            return Err(MeshFileError::NoTriangles { path });
        }
        let mut used = vec![false; self.points.len()];
        for triangle in &self.triangles {
            for corner in self.positions(triangle)? {
                used[corner] = true;
            }
        }
        let (vertices, vertex_of_point) = weld(&self.points, &used);
        let mut triangles = Vec::with_capacity(self.triangles.len());
        for triangle in &self.triangles {
            triangles.push(
                self.positions(triangle)?
                    .map(|point| vertex_of_point[point]),
            );
        }
        Ok(TriangleMesh {
            vertices,
            triangles,
        })
    }

    fn positions(&self, triangle: &DraftTriangle) -> Result<[usize; 3], MeshFileError> {
        let mut positions = [0; 3];
        for (position, &corner) in positions.iter_mut().zip(&triangle.corners) {
            *position = usize::try_from(corner - self.first_vertex)
                .ok()
                .filter(|&point| point < self.points.len())
                .ok_or_else(|| self.out_of_range(triangle, corner))?;
        }
        Ok(positions)
    }

    fn out_of_range(&self, triangle: &DraftTriangle, index: i64) -> MeshFileError {
        let last = self.points.len() as i64 + self.first_vertex - 1;
        MeshFileError::IndexOutOfRange {
            at: FileLine::new(self.path, triangle.line),
            what: format!("polygon {}", triangle.polygon),
            index,
            numbering: format!("from {} to {last}", self.first_vertex),
        }
    }
}

/// Points of equal coordinates made one; a point that is not used gets no vertex.
fn weld(points: &[Vec3], used: &[bool]) -> (Vec<Vec3>, Vec<u32>) {
    let mut vertices = Vec::new();
    let mut vertex_at: HashMap<[u64; 3], u32> = HashMap::with_capacity(points.len() / 4);
    let mut vertex_of_point = vec![0; points.len()];
    for (index, point) in points.iter().enumerate().filter(|&(index, _)| used[index]) {
        let key = [point.x, point.y, point.z].map(f64::to_bits);
        vertex_of_point[index] = *vertex_at.entry(key).or_insert_with(|| {
            vertices.push(*point);
            vertices.len() as u32 - 1
        });
    }
    (vertices, vertex_of_point)
}
