//! Gradient-aligned fields: the paper's alternative to H-fields.
//!
//! The cross is parallel and orthogonal to grad z of a harmonic function
//! (supplement, section 4.2, last paragraph, after Dong et al. 2005). Each
//! side of the boundary, from corner to corner, is either crossed by the
//! gradient (z is constant on it) or followed by it (no flux), and so is
//! followed by the cross, bent or not. The paper leaves open which sides
//! should be which; here the assignments are tried from the likeliest on, and
//! for each the constants are searched as those of an H-field are.

use super::discs::Discs;
use super::elements::{Elements, Nodes};
use super::family::{complement, Family, Kind};
use super::gallery::{candidates, distinct, ranked, Candidate, GalleryEntry, Wanted};
use super::pieces::BoundaryPiece;
use super::recovery::{Condition, Derivative, Patch, Recovery};
use super::sides::Sides;
use super::{basis, check_counts, pick};
use crate::cross::QUARTER;
use crate::domain::Domain;
use crate::field::{Field, FieldDesign};
use crate::plane::V2;
use crate::FieldError;

/// Fields along the gradient of a harmonic function.
///
/// They follow bent sides as closely as straight ones. Where they have
/// singularities inside these are of index -1, and the fewest are met with two
/// crossed runs of sides: then there is none in a domain without holes.
///
/// ```
/// use crossfield::{geo_types::{coord, Polygon}, Cross, Cursor, Domain, DomainOptions,
///     FieldDesign, GradientField};
///
/// // A ring: radial crosses, those of z = log r.
/// let circle = |r: f64| -> Vec<(f64, f64)> {
///     (0..90).map(|k| f64::from(4 * k).to_radians()).map(|t| (r * t.cos(), r * t.sin())).collect()
/// };
/// let site = Polygon::new(circle(50.0).into(), vec![circle(20.0).into()]);
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let field = GradientField::default().design(&domain)?;
/// let cross = field.cross(coord! { x: 28.0, y: 21.0 }, &mut Cursor::default());
/// let radial = Cross::from_angle((21.0_f64).atan2(28.0));
/// assert!(cross.expect("inside").deviation(&radial) < 0.01);
/// # Ok::<(), crossfield::FieldError>(())
/// ```
///
#[doc = include_str!("../../images/g-field.svg")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct GradientField {
    /// Which entry of the gallery [`FieldDesign::design`] gives; 0 is the one
    /// of least energy.
    ///
    /// Default value: 0.
    pub entry: usize,
    /// Entries of the gallery at most.
    ///
    /// Default value: 8.
    pub entries: usize,
    /// Assignments of the two kinds of sides that are tried; each costs a
    /// factorisation.
    ///
    /// Default value: 12.
    pub assignments: usize,
    /// Starts of the search for the constants of each assignment that has any
    /// left to choose.
    ///
    /// Default value: 6.
    pub starts: usize,
    /// Seed of the random starts (generator PCG32).
    ///
    /// Default value: 0.
    pub seed: u64,
    /// Weight of being different from earlier entries against that of low
    /// energy in the order of the gallery, between 0 and 1.
    ///
    /// Default value: 0.3.
    pub diversity: f64,
    /// Radius of the discs around singularities and singular corners that the
    /// energy leaves out, metres; 0 for a twenty-fifth of the square root of
    /// the area.
    ///
    /// Default value: 0.
    pub disc_radius: f64,
}

impl Default for GradientField {
    fn default() -> Self {
        Self {
            entry: 0,
            entries: 8,
            assignments: 12,
            starts: 6,
            seed: 0,
            diversity: 0.3,
            disc_radius: 0.0,
        }
    }
}

/// Sides more than this are too many to assign.
const MOST_SIDES: usize = 1000;

impl GradientField {
    /// The sides of a domain, from corner to corner, ring by ring: what
    /// [`GalleryEntry::crossed`] speaks of. A ring without a corner is one
    /// side.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] if there are more than a thousand.
    pub fn sides(domain: &Domain) -> Result<Vec<BoundaryPiece>, FieldError> {
        Ok(Sides::new(domain, MOST_SIDES)?.pieces.all)
    }

    /// Distinct fields of low divergence, ranked as
    /// [`HarmonicField::gallery`](crate::HarmonicField::gallery) ranks them.
    /// Never empty.
    ///
    /// # Errors
    ///
    /// [`FieldError::NoHarmonicField`] if no assignment has two separate runs
    /// of crossed sides, as on a triangle or a disc;
    /// [`FieldError::BadOption`] for an option out of its range;
    /// [`FieldError::SingularSystem`] if a solution does not satisfy its
    /// system.
    ///
    /// # Complexity
    ///
    /// For each assignment one sparse Cholesky factorisation in four times
    /// the number of vertices.
    pub fn gallery(&self, domain: &Domain) -> Result<Vec<GalleryEntry>, FieldError> {
        self.check()?;
        let sides = Sides::new(domain, MOST_SIDES)?;
        self.search(domain, &sides, &sides.assignments(self.assignments))
    }

    /// The gallery with given kinds of sides: `crossed` says for each of
    /// [`GradientField::sides`] whether the gradient crosses it.
    ///
    /// # Errors
    ///
    /// As [`GradientField::gallery`]; [`FieldError::BadOption`] if `crossed`
    /// does not have one entry a side.
    pub fn gallery_for(
        &self,
        domain: &Domain,
        crossed: &[bool],
    ) -> Result<Vec<GalleryEntry>, FieldError> {
        self.check()?;
        let sides = Sides::new(domain, MOST_SIDES)?;
        if crossed.len() != sides.turns.len() {
            return Err(FieldError::option(
                "crossed",
                format!(
                    "has {} entries; the boundary has {} sides, give one a side",
                    crossed.len(),
                    sides.turns.len()
                ),
            ));
        }
        let given = if sides.runs(crossed).1 >= 2 {
            vec![crossed.to_vec()]
        } else {
            vec![]
        };
        self.search(domain, &sides, &given)
    }

    fn search(
        &self,
        domain: &Domain,
        sides: &Sides,
        assignments: &[Vec<bool>],
    ) -> Result<Vec<GalleryEntry>, FieldError> {
        if assignments.is_empty() {
            return Err(FieldError::NoHarmonicField {
                pieces: sides.turns.len(),
            });
        }
        let wanted = Wanted {
            starts: self.starts,
            seed: self.seed,
            entries: self.entries,
            diversity: self.diversity,
        };
        let nodes = Nodes::new(domain, Elements::Quadratic);
        let radius = basis::disc_radius(self.disc_radius, domain);
        let mut all: Vec<Candidate> = Vec::new();
        for crossed in assignments {
            let family = family(domain, &nodes, sides, crossed, radius)?;
            for mut candidate in candidates(&family, &wanted, self.starts)? {
                candidate.entry.crossed.clone_from(crossed);
                all.push(candidate);
            }
        }
        Ok(ranked(distinct(all), &wanted))
    }

    fn check(&self) -> Result<(), FieldError> {
        check_counts(self.starts, self.entries, self.diversity, self.disc_radius)?;
        if self.assignments == 0 {
            return Err(FieldError::option("assignments", "is 0; give 1 or more"));
        }
        Ok(())
    }
}

impl FieldDesign for GradientField {
    /// The chosen entry of the gallery.
    ///
    /// # Errors
    ///
    /// As [`GradientField::gallery`]; and [`FieldError::BadOption`] if the
    /// gallery has fewer entries than [`entry`](Self::entry) asks for.
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        pick(self.gallery(domain)?, self.entry)
    }
}

/// The gradients for one assignment: a member for each run of crossed sides,
/// with the value 1 there and 0 on the others.
fn family(
    domain: &Domain,
    nodes: &Nodes,
    sides: &Sides,
    crossed: &[bool],
    radius: f64,
) -> Result<Family, FieldError> {
    let mesh = &domain.inner.mesh;
    let (run_of, count) = sides.runs(crossed);
    let mut fixed = vec![false; nodes.count()];
    let mut values = vec![vec![0.0; nodes.count()]; count];
    for (k, border) in mesh.borders.iter().enumerate() {
        let Some(run) = run_of[sides.pieces.of(border.ring, border.edge)] else {
            continue;
        };
        for (node, _) in nodes.border_shares(k) {
            fixed[node] = true;
            values[run][node] = 1.0;
        }
    }
    let solutions = nodes.mixed(&fixed, &values)?;
    let conditions = crossed
        .iter()
        .map(|&crossed| {
            if crossed {
                Condition::Value
            } else {
                Condition::Closed
            }
        })
        .collect();
    let recovery = Recovery::new(
        domain,
        nodes,
        &sides.pieces,
        conditions,
        Derivative::Gradient,
    );
    let mut patch = Patch::default();
    let mut columns = vec![V2::zeros(); domain.vertex_count() * count];
    for v in 0..domain.vertex_count() {
        let stencil = recovery.stencil(v, &mut patch);
        for (column, solution) in columns[v * count..][..count].iter_mut().zip(&solutions) {
            for &(node, weight) in &stencil.nodes {
                *column += weight * (solution[node as usize] - solution[v]);
            }
        }
    }
    Ok(Family {
        domain: domain.clone(),
        kind: Kind::Gradient,
        count,
        columns,
        // Adding a constant changes nothing.
        space: complement(count, &[vec![1.0; count]]),
        radius,
        discs: singular_corners(domain, sides, crossed, radius),
        charged: Vec::new(),
        charge: 0.0,
    })
}

/// Discs around the corners where the gradient has no direction.
///
/// Near a corner of inner angle alpha it behaves like r^(pi/alpha - 1)
/// between sides of one kind, and like r^(pi/(2 alpha) - 1) between sides of
/// two: only a convex right angle between two kinds is regular.
fn singular_corners(domain: &Domain, sides: &Sides, crossed: &[bool], radius: f64) -> Discs {
    let mut discs = Vec::new();
    for (index, ring) in domain.inner.rings.iter().enumerate() {
        for k in (0..ring.len()).filter(|&k| ring.corner[k]) {
            let [before, after] =
                [ring.previous(k), k].map(|edge| sides.pieces.of(index as u32, edge as u32));
            let right = (ring.turn[k] - QUARTER).abs() < basis::RIGHT;
            if !right || crossed[before] == crossed[after] {
                let lengths = [before, after].map(|side| sides.pieces.all[side].length);
                let most = lengths[0].min(lengths[1]) / 4.0;
                discs.push((ring.points[k], radius.min(most)));
            }
        }
    }
    Discs::new(discs)
}
