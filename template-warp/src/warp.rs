//! The warp of a matched template: options, result, and the checks that stand
//! between them.

use crate::error::WarpError;
use crate::geometry::{box_centre, norm, signed_area, Path, P};
use crate::hierarchy::warp_domain;
use crate::instance::{Domain, DomainSide};
use crate::library::Library;
use crate::matching::Candidate;
use crate::region::Region;
use crate::tiling::{certify, stitch};
use geo_types::LineString;
use std::collections::BTreeMap;

/// How a warp is computed and what it must satisfy.
#[derive(Clone, Debug, PartialEq)]
pub struct WarpOptions {
    /// Most iterations of registration and regression on each level. Default 30,
    /// the paper's count.
    pub iterations: usize,
    /// The iteration ends when the energy falls by less than this share twice in
    /// a row. Default 1e-4.
    pub tolerance: f64,
    /// Steps that Anderson acceleration remembers; 0 switches it off. Default 5.
    pub anderson_depth: usize,
    /// Least street frontage of a parcel that is not exempt, metres. Default 3.
    pub min_frontage: f64,
    /// Greatest area of a parcel over its ideal area, and inverse of the least.
    /// Default 2.5.
    pub max_area_ratio: f64,
}

impl Default for WarpOptions {
    fn default() -> Self {
        Self {
            iterations: 30,
            tolerance: 1e-4,
            anderson_depth: 5,
            min_frontage: 3.0,
            max_area_ratio: 2.5,
        }
    }
}

/// A face of a warped template.
#[derive(Clone, Debug, PartialEq)]
pub struct WarpedFace {
    /// What the face is: `parcel`, `park` or `street` in the standard library.
    pub label: String,
    /// Counter-clockwise, open ring, metres. Neighbours share coordinates bit
    /// for bit; a vertex of one on an edge of another is a vertex of both.
    pub ring: Vec<P>,
    /// Area that the template gives the face undeformed, square metres.
    pub ideal_area: f64,
    /// Root mean square registration distance, metres (the paper's
    /// p_similarity for one parcel).
    pub registration: f64,
    /// Metres of the ring along streets.
    pub frontage: f64,
    /// Whether the template means the face to have no street access.
    pub access_exempt: bool,
}

/// A template warped onto a region: faces that tile it exactly.
#[derive(Clone, Debug, PartialEq)]
pub struct Warped {
    /// Name of the template.
    pub template: String,
    /// All faces, streets included.
    pub faces: Vec<WarpedFace>,
    /// Mean over the faces other than streets, by area, of the mean squared
    /// registration distance (the paper's equation 1 divided by the number of vertices),
    /// divided by the area of the ideal parcel: dimensionless, 0 for a perfect
    /// fit; 0.01 means vertices about a tenth of the root of a parcel's area
    /// (2.3 m for 30 x 18 m) from their ideal places.
    pub energy: f64,
    /// Centrelines of the streets inside, each from the region's boundary
    /// inwards.
    pub centrelines: Vec<LineString<f64>>,
    /// Iterations of the level that took most.
    pub iterations: usize,
}

/// Warps the candidate's template onto the region.
///
/// Each level of the template is placed by arc length on the boundary and mean
/// value coordinates inside, then improved by alternating registration of its
/// faces and regression of its points; areas are then replaced by their child
/// templates, which repeat as often as the lengths demand. The result is checked:
/// the faces tile the region edge for edge, each is simple, parcels have the
/// frontage and about the size that the options ask for.
///
/// # Errors
///
/// [`WarpError::BadCandidate`] for a candidate of another library or region,
/// [`WarpError::BadOption`], and the refusals [`WarpError::FoldedFace`],
/// [`WarpError::NotTiled`], [`WarpError::NoFrontage`] and
/// [`WarpError::WrongSize`].
///
/// # Examples
///
/// ```
/// use template_warp::{geo_types::coord, match_templates, warp};
/// use template_warp::{EdgeUse, Library, MatchOptions, Region, WarpOptions};
///
/// let ring = vec![
///     coord! { x: 0.0, y: 0.0 }, coord! { x: 108.0, y: 0.0 },
///     coord! { x: 108.0, y: 60.0 }, coord! { x: 0.0, y: 60.0 },
/// ];
/// let region = Region::new(ring, vec![EdgeUse::Street; 4], "block")?;
/// let library = Library::standard().subset(&["double-row"])?;
/// let candidates = match_templates(&library, &region, &MatchOptions::default());
/// let warped = warp(&library, &region, &candidates[0], &WarpOptions::default())?;
/// assert_eq!(warped.faces.len(), 12);
/// assert!(warped.energy < 1e-12);
/// # Ok::<(), template_warp::WarpError>(())
/// ```
pub fn warp(
    library: &Library,
    region: &Region,
    candidate: &Candidate,
    options: &WarpOptions,
) -> Result<Warped, WarpError> {
    check_options(options)?;
    let template = library.variant(candidate.template, candidate.mirrored)?;
    let ring = region.ring();
    let n = ring.len();
    let stray = |problem: String| WarpError::BadCandidate { problem };
    if candidate.corners.len() != template.sides.len() {
        return Err(stray(format!(
            "it has {} corners, the template {}",
            candidate.corners.len(),
            template.sides.len()
        )));
    }
    if let Some(&v) = candidate.corners.iter().find(|&&v| v >= n) {
        return Err(stray(format!("it names vertex {v}, the region has {n}")));
    }
    let steps: usize = cyclic_steps(&candidate.corners, n).iter().sum();
    if steps != n {
        return Err(stray(
            "its corners are not distinct and in boundary order".into(),
        ));
    }

    // Work near the origin; the region's own vertices come back untouched.
    let centre = box_centre(ring);
    let local: Vec<P> = ring.iter().map(|&q| q - centre).collect();
    let size = local.iter().map(|&q| norm(q)).fold(0.0, f64::max);
    let m = candidate.corners.len();
    let sides = (0..m)
        .map(|k| {
            let (a, b) = (candidate.corners[k], candidate.corners[(k + 1) % m]);
            let count = (b + n - a) % n;
            let path = Path::new((0..=count).map(|i| local[(a + i) % n]).collect());
            let uses = (0..count).map(|i| region.uses()[(a + i) % n]).collect();
            DomainSide { path, uses }
        })
        .collect();
    let mut pieces = warp_domain(library, template, &Domain { sides }, options, 0)?;
    let energy = pieces.mean_square() / library.sizes().parcel_area();
    let (boundary, uses) = stitch(&mut pieces.faces, &local, region.uses(), 1e-8 * size);

    let back: BTreeMap<(u64, u64), P> = local
        .iter()
        .zip(ring)
        .map(|(l, &q)| ((l.x.to_bits(), l.y.to_bits()), q))
        .collect();
    let to_region = |q: P| {
        back.get(&(q.x.to_bits(), q.y.to_bits()))
            .copied()
            .unwrap_or(q + centre)
    };
    let frontage =
        certify(&template.name, &pieces.faces, &boundary, &uses).map_err(|e| shifted(e, centre))?;
    let mut faces = Vec::with_capacity(pieces.faces.len());
    for (k, (piece, frontage)) in pieces.faces.into_iter().zip(frontage).enumerate() {
        let at = to_region(piece.ring[0]);
        let place = || (template.name.clone(), at.x, at.y);
        if piece.label == "parcel" {
            let ratio = signed_area(&piece.ring) / piece.ideal_area;
            if !(ratio <= options.max_area_ratio && ratio >= 1.0 / options.max_area_ratio) {
                let (template, x, y) = place();
                return Err(WarpError::WrongSize {
                    template,
                    face: k,
                    x,
                    y,
                    ratio,
                });
            }
            if !piece.access_exempt && frontage < options.min_frontage {
                let (template, x, y) = place();
                return Err(WarpError::NoFrontage {
                    template,
                    face: k,
                    x,
                    y,
                    frontage,
                    required: options.min_frontage,
                });
            }
        }
        faces.push(WarpedFace {
            label: piece.label,
            ring: piece.ring.into_iter().map(to_region).collect(),
            ideal_area: piece.ideal_area,
            registration: piece.mean_square.sqrt(),
            frontage,
            access_exempt: piece.access_exempt,
        });
    }
    let centrelines = pieces
        .centrelines
        .into_iter()
        .map(|line| LineString::new(line.into_iter().map(to_region).collect()))
        .collect();
    Ok(Warped {
        template: template.name.clone(),
        faces,
        energy,
        centrelines,
        iterations: pieces.iterations,
    })
}

/// Steps from each corner to the next, walking the ring once.
fn cyclic_steps(corners: &[usize], n: usize) -> Vec<usize> {
    let m = corners.len();
    (0..m)
        .map(|k| match (corners[(k + 1) % m] + n - corners[k]) % n {
            0 => n,
            steps => steps,
        })
        .collect()
}

fn check_options(options: &WarpOptions) -> Result<(), WarpError> {
    let checks = [
        (
            "max_area_ratio",
            options.max_area_ratio,
            options.max_area_ratio >= 1.0,
        ),
        (
            "min_frontage",
            options.min_frontage,
            options.min_frontage >= 0.0,
        ),
        ("tolerance", options.tolerance, options.tolerance >= 0.0),
    ];
    for (option, value, fine) in checks {
        if !fine {
            return Err(WarpError::BadOption { option, value });
        }
    }
    Ok(())
}

/// Puts the place named in a refusal back where the caller's region lies.
fn shifted(error: WarpError, centre: P) -> WarpError {
    match error {
        WarpError::FoldedFace {
            template,
            face,
            x,
            y,
        } => WarpError::FoldedFace {
            template,
            face,
            x: x + centre.x,
            y: y + centre.y,
        },
        WarpError::NotTiled {
            template,
            x,
            y,
            problem,
        } => WarpError::NotTiled {
            template,
            x: x + centre.x,
            y: y + centre.y,
            problem,
        },
        other => other,
    }
}
