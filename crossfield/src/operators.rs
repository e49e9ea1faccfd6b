//! Edge weights and matrices of the discrete Laplacians, and gradients.

use sprs::CsMatI;

use crate::domain::Domain;
use crate::plane::{left, wedge, V2};

/// How differences along the edges of the mesh are weighed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Laplacian {
    /// Cotangents of the opposite angles (Pinkall and Polthier 1993): what is
    /// computed does not depend on the mesh, up to its fineness.
    #[default]
    Cotangent,
    /// Each edge counts once, as the paper's sum is written: where the mesh
    /// is fine, the field is stiffer.
    Uniform,
}

/// The weight of each edge, parallel to the rows of the domain's adjacency.
pub(crate) fn edge_weights(domain: &Domain, laplacian: Laplacian) -> Vec<f64> {
    let inner = &*domain.inner;
    let adjacency = &inner.adjacency;
    if laplacian == Laplacian::Uniform {
        return vec![1.0; adjacency.len()];
    }
    // First the entries of the earlier vertices in each row, by searching
    // their part of the row, which is short.
    let mut weights = vec![0.0; adjacency.len()];
    let sorted = by_last_vertex(&inner.mesh.triangles, domain.vertex_count());
    for triangle in &sorted {
        let points = triangle.map(|v| inner.mesh.points[v as usize]);
        for k in 0..3 {
            let [b, c] = [(k + 1) % 3, (k + 2) % 3];
            let half = half_cotangent(points[b] - points[k], points[c] - points[k]);
            let (v, w) = (triangle[b], triangle[c]);
            if let Some(slot) = adjacency.slot(v.max(w), v.min(w)) {
                weights[slot] += half;
            }
        }
    }
    // Then those of the later ones. As rows ascend, the rows that name a
    // vertex are met in the order of its own later entries.
    let mut next: Vec<u32> = (0..domain.vertex_count())
        .map(|v| {
            let earlier = adjacency.of(v).partition_point(|&w| (w as usize) < v);
            (adjacency.row(v).start + earlier) as u32
        })
        .collect();
    for v in 0..domain.vertex_count() {
        let row = adjacency.row(v);
        for (&w, slot) in adjacency.of(v).iter().zip(row) {
            if w as usize >= v {
                break;
            }
            let mirrored = &mut next[w as usize];
            weights[*mirrored as usize] = weights[slot];
            *mirrored += 1;
        }
    }
    weights
}

/// The triangles, in the order of their largest vertex: neighbours in space
/// are neighbours in memory then, as they are not in the triangulation's own
/// order.
fn by_last_vertex(triangles: &[[u32; 3]], count: usize) -> Vec<[u32; 3]> {
    let last = |t: &[u32; 3]| t[0].max(t[1]).max(t[2]) as usize;
    let mut starts = vec![0_u32; count + 1];
    for triangle in triangles {
        starts[last(triangle) + 1] += 1;
    }
    for v in 0..count {
        starts[v + 1] += starts[v];
    }
    let mut sorted = vec![[0; 3]; triangles.len()];
    for triangle in triangles {
        let place = &mut starts[last(triangle)];
        sorted[*place as usize] = *triangle;
        *place += 1;
    }
    sorted
}

/// Half the cotangent of the angle from `p` to `q`, to its left.
///
/// A triangle flattened by rounding would have infinite cotangents: they are
/// cut at angles of 1e-8.
fn half_cotangent(p: V2, q: V2) -> f64 {
    const MOST: f64 = 1e8;
    let (sine, cosine) = (wedge(p, q), p.dot(&q));
    let cotangent = if sine > 0.0 {
        (cosine / sine).clamp(-MOST, MOST)
    } else if cosine == 0.0 {
        0.0
    } else {
        MOST.copysign(cosine)
    };
    cotangent / 2.0
}

/// The upper triangle of the matrix L + diag(extra), L the Laplacian with
/// positive diagonal, in compressed columns.
pub(crate) fn laplacian_plus(domain: &Domain, weights: &[f64], extra: &[f64]) -> CsMatI<f64, u32> {
    let adjacency = &domain.inner.adjacency;
    let count = domain.vertex_count();
    let entries = adjacency.len() / 2 + count;
    let mut starts = Vec::with_capacity(count + 1);
    let mut rows = Vec::with_capacity(entries);
    let mut values = Vec::with_capacity(entries);
    starts.push(0);
    for (v, &extra) in extra.iter().enumerate() {
        let mut sum = extra;
        for (&w, &weight) in adjacency.of(v).iter().zip(&weights[adjacency.row(v)]) {
            sum += weight;
            if (w as usize) < v {
                rows.push(w);
                values.push(-weight);
            }
        }
        // Rows ascend, so the diagonal comes last.
        rows.push(v as u32);
        values.push(sum);
        starts.push(rows.len() as u32);
    }
    CsMatI::new_csc((count, count), starts, rows, values)
}

/// The area of each vertex: a third of that of its triangles.
pub(crate) fn vertex_areas(domain: &Domain) -> Vec<f64> {
    let mesh = &domain.inner.mesh;
    let mut areas = vec![0.0; mesh.points.len()];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.points[v as usize]);
        for &v in triangle {
            areas[v as usize] += wedge(b - a, c - a) / 6.0;
        }
    }
    areas
}

/// Gradient of the linear function with the given values at the corners of a
/// triangle; `None` if the triangle has no area.
pub(crate) fn gradient(points: [V2; 3], values: [f64; 3]) -> Option<V2> {
    let area = wedge(points[1] - points[0], points[2] - points[0]);
    if area <= 0.0 {
        return None;
    }
    // Each corner's hat function rises from the opposite edge.
    let sum = (0..3).fold(V2::zeros(), |sum, k| {
        sum + left(points[(k + 2) % 3] - points[(k + 1) % 3]) * values[k]
    });
    Some(sum / area)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::DomainOptions;
    use geo_types::polygon;

    /// The product of a matrix, given by its upper triangle, with `x`.
    fn image(matrix: &CsMatI<f64, u32>, x: &[f64]) -> Vec<f64> {
        let mut image = vec![0.0; x.len()];
        for (j, column) in matrix.outer_iterator().enumerate() {
            for (i, &entry) in column.iter() {
                image[i] += entry * x[j];
                if i < j {
                    image[j] += entry * x[i];
                }
            }
        }
        image
    }

    #[test]
    fn linear_functions_are_harmonic_and_have_their_gradient() {
        let shape = polygon![(x: 0., y: 0.), (x: 9., y: 1.), (x: 7., y: 6.), (x: 2., y: 5.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        let value = |p: V2| 3.0 * p.x - 2.0 * p.y + 1.0;
        let points = &domain.inner.mesh.points;
        let weights = edge_weights(&domain, Laplacian::Cotangent);
        let matrix = laplacian_plus(&domain, &weights, &vec![0.0; points.len()]);
        let values: Vec<f64> = points.iter().map(|&p| value(p)).collect();
        let image = image(&matrix, &values);
        for v in domain.inner_vertices() {
            assert!(image[v].abs() < 1e-10);
        }
        for triangle in domain.triangles() {
            let corners = triangle.map(|v| points[v as usize]);
            let slope = gradient(corners, corners.map(value)).expect("area");
            assert!((slope - V2::new(3.0, -2.0)).norm() < 1e-9);
        }
    }

    #[test]
    fn cotangents_are_cut_and_have_no_scale() {
        for scale in [1e-150, 1.0, 1e150] {
            let at = |angle: f64| V2::new(angle.cos(), angle.sin()) * scale;
            assert!((half_cotangent(at(0.3), at(0.8)) - 0.5 / 0.5_f64.tan()).abs() < 1e-14);
            assert!(half_cotangent(at(0.0), V2::new(0.0, scale)).abs() < 1e-15);
            assert_eq!(half_cotangent(at(0.3), at(0.3)), 5e7);
            assert_eq!(half_cotangent(at(0.3), -at(0.3)), -5e7);
        }
        assert_eq!(half_cotangent(V2::zeros(), V2::zeros()), 0.0);
    }

    #[test]
    fn constants_are_in_the_null_space() {
        let shape = polygon![(x: 0., y: 0.), (x: 9., y: 1.), (x: 7., y: 6.), (x: 2., y: 5.)];
        let domain = Domain::new(&shape, &DomainOptions::default()).expect("valid");
        for laplacian in [Laplacian::Cotangent, Laplacian::Uniform] {
            let weights = edge_weights(&domain, laplacian);
            let matrix = laplacian_plus(&domain, &weights, &vec![0.0; domain.vertex_count()]);
            let ones = vec![1.0; domain.vertex_count()];
            assert!(image(&matrix, &ones).iter().all(|sum| sum.abs() < 1e-9));
        }
    }
}
