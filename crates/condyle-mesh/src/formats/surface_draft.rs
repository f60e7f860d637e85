//! A surface while it is read: polygons become triangles, equal points one vertex.

use std::{collections::HashMap, path::Path};

use super::{error::MeshFileError, text::At};
use crate::{TriangleMesh, Vec3};

/// Vertices and polygons in the order of the file, with their lines.
pub(crate) struct SurfaceDraft<'a> {
    path: &'a Path,
    /// The file's number of its first vertex, 0 or 1.
    first_vertex: i64,
    points: Vec<Vec3>,
    triangles: Vec<DraftTriangle>,
    polygons: usize,
}

struct DraftTriangle {
    /// Numbers of points from 0; a number that the file does not have is out of range.
    corners: [usize; 3],
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

    pub(crate) fn point(&mut self, at: At, point: [f64; 3]) -> Result<(), MeshFileError> {
        let number = self.points.len() as i64 + self.first_vertex;
        let position = at.position(format_args!("vertex {number}"), point)?;
        // Adding zero turns -0 into 0: points are welded by their bits.
        self.points.push(position.add_scalar(0.0));
        Ok(())
    }

    /// Adds a polygon by the file's vertex numbers, cut into triangles as a fan.
    pub(crate) fn polygon(&mut self, at: At, corners: &[i64]) -> Result<(), MeshFileError> {
        let polygon = self.polygons + self.first_vertex as usize;
        self.polygons += 1;
        if corners.len() < 3 {
            return Err(at.error(format!(
                "polygon {polygon} has {} corners; it needs three or more",
                corners.len()
            )));
        }
        // A number below the first one wraps round and is as much out of range.
        let index = |corner: i64| corner.wrapping_sub(self.first_vertex) as usize;
        let fan = corners[1..].windows(2).map(|ends| DraftTriangle {
            corners: [corners[0], ends[0], ends[1]].map(index),
            polygon,
            line: at.line,
        });
        self.triangles.extend(fan);
        Ok(())
    }

    pub(crate) fn triangle_of_last_points(&mut self, at: At) -> Result<(), MeshFileError> {
        let end = self.points.len() as i64 + self.first_vertex;
        self.polygon(at, &[end - 3, end - 2, end - 1])
    }

    /// Returns the mesh, with points of equal coordinates welded and unused ones dropped.
    pub(crate) fn finish(self) -> Result<TriangleMesh, MeshFileError> {
        if self.triangles.is_empty() {
            return Err(no_triangles(self.path));
        }
        let first = self.first_vertex;
        let last = self.points.len() as i64 + first - 1;
        let mut used = vec![false; self.points.len()];
        for triangle in &self.triangles {
            for &corner in &triangle.corners {
                let used = used.get_mut(corner).ok_or_else(|| {
                    let (path, line) = (self.path, triangle.line);
                    At { path, line }.no_such_vertex(
                        format_args!("polygon {}", triangle.polygon),
                        (corner as i64).wrapping_add(first),
                        format_args!("from {first} to {last}"),
                    )
                })?;
                *used = true;
            }
        }
        let mut vertices = Vec::new();
        let mut vertex_at = HashMap::with_capacity(self.points.len() / 4);
        let mut vertex_of_point = vec![0; self.points.len()];
        for (index, point) in self.points.iter().enumerate().filter(|&(i, _)| used[i]) {
            let key = [point.x, point.y, point.z].map(f64::to_bits);
            vertex_of_point[index] = *vertex_at.entry(key).or_insert_with(|| {
                vertices.push(*point);
                vertices.len() as u32 - 1
            });
        }
        let triangles = self.triangles.iter();
        let triangles = triangles.map(|triangle| triangle.corners.map(|p| vertex_of_point[p]));
        Ok(TriangleMesh {
            triangles: triangles.collect(),
            vertices,
        })
    }
}

pub(crate) fn no_triangles(path: &Path) -> MeshFileError {
    At::file(path).error("holds no triangles; export the surface as triangles")
}
