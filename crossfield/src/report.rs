//! What a designer compares fields by, and the comparison.

use std::fmt;

use crate::cross::Cross;
use crate::field::Field;
use crate::singularity::IndexCheck;
use crate::FieldError;

/// The figures of one field that need no streamline (UrbanFab 2023, "Field
/// evaluation criteria": divergence, boundary parallelism, singularities), and
/// the index laws. Each is better the nearer it is to 0.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FieldReport {
    /// Number of singularities.
    pub singularities: usize,
    /// Sum of the absolute values of their quarter indices.
    pub total_index: u32,
    /// See [`Field::energy`]; no unit.
    pub energy: f64,
    /// See [`Field::mean_abs_divergence`]; 1 / metre.
    pub mean_abs_divergence: f64,
    /// Largest |div| of either arm in any regular triangle; 1 / metre.
    pub max_abs_divergence: f64,
    /// See [`Field::boundary_deviation`]; radians.
    pub mean_boundary_deviation: f64,
    /// Largest angle between the boundary and the field along it; radians.
    pub max_boundary_deviation: f64,
    /// The numbers of the index laws.
    pub check: IndexCheck,
}

impl FieldReport {
    /// UrbanFab's boundary parallelism for a field: the mean deviation from
    /// the boundary in parts of the largest there can be, 45 degrees. 0 for a
    /// field that follows the boundary, 1 for one that crosses it diagonally.
    ///
    /// The paper compares the segments of streamlines with the boundary near
    /// them; this takes the field on the boundary itself. For a cross,
    /// parallel and perpendicular are the same.
    #[must_use]
    pub fn boundary_parallelism(&self) -> f64 {
        self.mean_boundary_deviation / std::f64::consts::FRAC_PI_4
    }
}

impl Field {
    /// Mean and largest angle between the boundary and the nearest arm of the
    /// field along it, radians; the mean is by length.
    ///
    /// Exact within each boundary edge of the mesh up to Simpson's rule. Where
    /// the field vanishes on the boundary, pi/4 counts.
    #[must_use]
    pub fn boundary_deviation(&self) -> (f64, f64) {
        let inner = &*self.domain().inner;
        let (mut sum, mut most, mut total) = (0.0, 0.0_f64, 0.0);
        for border in &inner.mesh.borders {
            let along = inner.rings[border.ring as usize].direction(border.edge as usize);
            let Some(boundary) = Cross::from_direction(crate::plane::coord(along)) else {
                continue;
            };
            let [a, b] = [border.from, border.to].map(|v| v as usize);
            let [d, e] = [a, b].map(|v| self.vectors()[v]);
            let length = (inner.mesh.points[b] - inner.mesh.points[a]).norm();
            let off = |d| {
                Cross::from_vector(d).map_or(std::f64::consts::FRAC_PI_4, |cross| {
                    cross.deviation(&boundary)
                })
            };
            let [first, middle, last] = [d, (d + e) / 2.0, e].map(off);
            sum += length * (first + 4.0 * middle + last) / 6.0;
            most = most.max(first).max(middle).max(last);
            total += length;
        }
        (if total > 0.0 { sum / total } else { 0.0 }, most)
    }

    /// All figures of the field that need no streamline.
    ///
    /// ```
    /// use crossfield::{geo_types::polygon, BoundaryField, Domain, DomainOptions, FieldDesign};
    ///
    /// let site = polygon![(x: 0., y: 0.), (x: 60., y: 0.), (x: 60., y: 40.), (x: 0., y: 40.)];
    /// let domain = Domain::new(&site, &DomainOptions::default())?;
    /// let report = BoundaryField::default().design(&domain)?.report();
    /// assert_eq!(report.singularities, 0);
    /// assert!(report.boundary_parallelism() < 1e-9 && report.check.holds());
    /// # Ok::<(), crossfield::FieldError>(())
    /// ```
    #[must_use]
    pub fn report(&self) -> FieldReport {
        let found = self.singularities();
        let most = (0..self.domain().triangles().len())
            .filter_map(|t| self.turning_in(t))
            .flat_map(|turning| turning.divergence())
            .fold(0.0, |most: f64, d| most.max(d.abs()));
        let (mean_boundary_deviation, max_boundary_deviation) = self.boundary_deviation();
        FieldReport {
            singularities: found.len(),
            total_index: found.iter().map(|s| s.quarter_index.unsigned_abs()).sum(),
            energy: self.energy(),
            mean_abs_divergence: self.mean_abs_divergence(),
            max_abs_divergence: most,
            mean_boundary_deviation,
            max_boundary_deviation,
            check: self.index_check(),
        }
    }
}

/// Several fields on one domain, side by side; made by [`compare`].
///
/// `Display` writes a table with one line a field.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Comparison {
    /// Name and figures of each field, in the order given.
    pub fields: Vec<(String, FieldReport)>,
    /// Mean angle between the crosses of two fields over the domain, by
    /// area, radians, between 0 and pi/4: entry `[i][j]` for fields `i` and
    /// `j`. Symmetric, with zeros on the diagonal.
    pub differences: Vec<Vec<f64>>,
}

/// Compares fields on one domain.
///
/// ```
/// use crossfield::{compare, geo_types::polygon, BoundaryField, DistanceField, Domain,
///     DomainOptions, FieldDesign};
///
/// let site = polygon![(x: 0., y: 0.), (x: 120., y: 0.), (x: 155., y: 90.), (x: 0., y: 85.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let d = DistanceField::default().design(&domain)?;
/// let b = BoundaryField::default().design(&domain)?;
/// let comparison = compare(&[("distance", &d), ("boundary", &b)])?;
/// assert_eq!(comparison.fields.len(), 2);
/// println!("{comparison}");
/// # Ok::<(), crossfield::FieldError>(())
/// ```
///
/// # Errors
///
/// [`FieldError::BadOption`] if the fields do not share one mesh: figures
/// that depend on the mesh would be compared then.
pub fn compare(fields: &[(&str, &Field)]) -> Result<Comparison, FieldError> {
    for pair in fields.windows(2) {
        if !pair[0].1.domain().is_same(pair[1].1.domain()) {
            return Err(FieldError::option(
                "fields",
                format!(
                    "`{}` and `{}` live on different domains; design all on one",
                    pair[0].0, pair[1].0
                ),
            ));
        }
    }
    let mut differences = vec![vec![0.0; fields.len()]; fields.len()];
    for i in 0..fields.len() {
        for j in 0..i {
            let mean = mean_difference(fields[i].1, fields[j].1);
            differences[i][j] = mean;
            differences[j][i] = mean;
        }
    }
    Ok(Comparison {
        fields: fields
            .iter()
            .map(|(name, field)| ((*name).to_owned(), field.report()))
            .collect(),
        differences,
    })
}

/// Mean angle between the crosses of two fields on one mesh, each vertex with
/// a third of its triangles' area; singular vertices are left out.
fn mean_difference(one: &Field, other: &Field) -> f64 {
    let mesh = &one.domain().inner.mesh;
    let (mut sum, mut total) = (0.0, 0.0);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| mesh.points[v as usize]);
        let area = crate::plane::orient(a, b, c) / 2.0;
        for v in triangle.map(|v| v as usize) {
            let crosses = [one, other].map(|f| Cross::from_vector(f.vectors()[v]));
            if let [Some(p), Some(q)] = crosses {
                sum += area * p.deviation(&q);
                total += area;
            }
        }
    }
    if total > 0.0 {
        sum / total
    } else {
        0.0
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = self.fields.iter().map(|(name, _)| name.chars().count());
        let width = names.max().unwrap_or(0).max(5);
        writeln!(
            f,
            "{:width$} | singular |  energy | mean |div| /m | max |div| /m | off boundary, mean / max deg | indices",
            "field"
        )?;
        for (name, r) in &self.fields {
            writeln!(
                f,
                "{name:width$} | {:8} | {:7.3} | {:13.3e} | {:12.3e} | {:17.2} / {:8.2} | {}",
                r.singularities,
                r.energy,
                r.mean_abs_divergence,
                r.max_abs_divergence,
                r.mean_boundary_deviation.to_degrees(),
                r.max_boundary_deviation.to_degrees(),
                r.check,
            )?;
        }
        for (i, row) in self.differences.iter().enumerate() {
            for (j, mean) in row.iter().enumerate().take(i) {
                let (a, b) = (&self.fields[j].0, &self.fields[i].0);
                writeln!(
                    f,
                    "{a} and {b} differ by {:.2} deg on average",
                    mean.to_degrees()
                )?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BoundaryField, DistanceField, Domain, DomainOptions, FieldDesign};
    use geo_types::polygon;

    fn square() -> Domain {
        let shape = polygon![(x: 0., y: 0.), (x: 8., y: 0.), (x: 8., y: 8.), (x: 0., y: 8.)];
        Domain::new(&shape, &DomainOptions::default()).expect("valid")
    }

    fn constant(domain: &Domain, angle: f64) -> Field {
        let cross = Cross::from_angle(angle).representative();
        Field::from_representatives(domain, vec![cross; domain.vertex_count()]).expect("fits")
    }

    #[test]
    fn parallelism_is_0_along_and_1_across() {
        let domain = square();
        for (angle, parts) in [(0.0, 0.0), (0.2, 0.2), (std::f64::consts::FRAC_PI_4, 1.0)] {
            let report = constant(&domain, angle).report();
            let wanted = if parts == 1.0 {
                1.0
            } else {
                angle / std::f64::consts::FRAC_PI_4
            };
            assert!((report.boundary_parallelism() - wanted).abs() < 1e-9);
            assert!((report.max_boundary_deviation - angle).abs() < 1e-9);
            assert!(report.energy < 1e-20 && report.singularities == 0);
        }
    }

    #[test]
    fn constant_fields_differ_by_their_angle() {
        let domain = square();
        let (a, b) = (constant(&domain, 0.1), constant(&domain, 0.4));
        let comparison = compare(&[("a", &a), ("b", &b)]).expect("one domain");
        assert!((comparison.differences[1][0] - 0.3).abs() < 1e-9);
        let text = comparison.to_string();
        assert_eq!(text.lines().count(), 4);
        assert!(text.contains("a and b differ by 17.19 deg"), "{text}");
        // An equal mesh is as good as the same one, another is not.
        let again = constant(&square(), 0.4);
        assert!(compare(&[("a", &a), ("again", &again)]).is_ok());
        let wide = polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 9., y: 2.), (x: 0., y: 2.)];
        let wide = Domain::new(&wide, &DomainOptions::default()).expect("valid");
        let other = constant(&wide, 0.1);
        assert!(compare(&[("a", &a), ("other", &other)]).is_err());
        assert!(compare(&[]).expect("nothing to compare").fields.is_empty());
    }

    #[test]
    fn figures_of_designed_fields() {
        let pentagon = polygon![(x: 0., y: 0.), (x: 9., y: 0.), (x: 11., y: 6.), (x: 5., y: 10.), (x: -2., y: 6.)];
        let domain = Domain::new(&pentagon, &DomainOptions::default()).expect("valid");
        let d = DistanceField::default()
            .design(&domain)
            .expect("a field")
            .report();
        let b = BoundaryField::default()
            .design(&domain)
            .expect("a field")
            .report();
        for report in [&d, &b] {
            assert!(report.check.holds() && report.check.aligned);
            assert!(report.max_abs_divergence >= report.mean_abs_divergence);
            // One singularity of index -1, but for pairs that a D-field may
            // leave on the medial axis.
            assert_eq!(report.total_index % 2, 1);
        }
        assert_eq!(b.singularities, 1);
        assert!(b.energy < d.energy);
    }
}
