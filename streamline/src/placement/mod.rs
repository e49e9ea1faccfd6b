//! Evenly spaced lines of both families.

mod chords;
mod even;
mod grow;
mod junction;
mod lattice;
mod near;
mod options;
mod spacing;
mod watch;

pub use lattice::lattice;
pub use options::{Ends, PlacementOptions, Strategy};

use crate::candidates::Seed;
use crate::error::TraceError;
use crate::field::DirectionField;
use crate::streamline::Streamline;
use crate::vector::{is_finite, unit};
use geo_types::Coord;
use grow::Placer;
use spacing::Spacing;

/// Places evenly spaced streamlines of both families over the region that the
/// seeds cover.
///
/// The seeds say where lines are wanted: vertices of a mesh, or a
/// [`lattice`] for a formula. They may lie as far apart as half the separation;
/// a line need not pass through any of them. How the lines are spaced is for
/// [`PlacementOptions`]; [`place_scaled`] varies the separation by place.
///
/// # Shape
///
/// Lines in the order of placement. `family` is inherited from line to line, so
/// that it names the same set of neighbours wherever the field allows; next to
/// singularities, where the families change places, it is that of the line's
/// start. `seed_index` is the seed that the line's first forerunner started
/// from.
///
/// # What holds
///
/// With d_sep the separation and d_test = `test` * d_sep:
///
/// - Two lines, and a line and itself, stay d_test apart wherever their
///   tangents differ by less than 45 degrees, up to step^2 / (8 d_test) between
///   points (and 0.002 d_sep on curves; the last piece before the boundary, at
///   most one step long, is not tested). Between families of different
///   separation next to singularities the smaller one counts.
/// - Every seed has, of each orientation, a line within d_sep that runs
///   alongside, or the line through it would have been too short. With
///   [`Ends::Junction`] this holds before ends are cut.
/// - With [`PlacementOptions::widest`] all but a few points (under 1 % where we
///   measured it, with [`Strategy::Neighbour`]) have another line within that
///   many separations, on one side or the other.
/// - The same input gives the same lines, in the same order.
///
/// # Complexity
///
/// Linear in the total length of the lines and in the number of seeds, with
/// [`Strategy::Farthest`] at a somewhat higher cost.
///
/// # Errors
///
/// [`TraceError::BadOption`], [`TraceError::SeedNotFinite`] or
/// [`TraceError::NoHeading`], before any tracing. No seeds give no lines.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon, Rect};
/// use streamline::{arm_nearest, from_fn, lattice, place, PlacementOptions};
///
/// let land = polygon![(x: 0., y: 0.), (x: 600., y: 0.), (x: 600., y: 400.), (x: 0., y: 400.)];
/// let grid = from_fn(land, |_, heading| Some(arm_nearest(0.0, heading)));
/// let extent = Rect::new(coord! { x: 0., y: 0. }, coord! { x: 600., y: 400. });
/// let seeds = lattice(&grid, extent, 37.5)?;
///
/// let lines = place(&grid, &seeds, &PlacementOptions::default())?;
/// // From the middle outwards: five to the east, 75 m apart, and four to the
/// // north, 150 m apart.
/// assert_eq!(lines.iter().filter(|l| l.family == 0).count(), 5);
/// assert_eq!(lines.iter().filter(|l| l.family == 1).count(), 4);
/// # Ok::<(), streamline::TraceError>(())
/// ```
///
/// # References
///
/// B. Jobard, W. Lefer, *Creating Evenly-Spaced Streamlines of Arbitrary
/// Density*, Visualization in Scientific Computing '97. A. Mebarki, P. Alliez,
/// O. Devillers, *Farthest Point Seeding for Efficient Placement of
/// Streamlines*, IEEE Visualization 2005. Both place one family of a vector
/// field; that two families share the work, that gaps are filled before they
/// are two separations wide, and the T-junctions are ours.
pub fn place<F: DirectionField + ?Sized>(
    field: &F,
    seeds: &[Seed],
    options: &PlacementOptions,
) -> Result<Vec<Streamline>, TraceError> {
    place_scaled(field, seeds, options, &|_| 1.0)
}

/// [`place`] with separations that vary: at each point they are those of the
/// options times `scale`.
///
/// Between the seeds the scale is held within what it is at the seeds.
///
/// # Errors
///
/// As [`place`]; and [`TraceError::BadScale`] if the scale is not positive and
/// finite at a seed.
///
/// # Examples
///
/// ```
/// use geo_types::{coord, polygon, Rect};
/// use streamline::{arm_nearest, from_fn, lattice, place_scaled, PlacementOptions};
///
/// let land = polygon![(x: 0., y: 0.), (x: 900., y: 0.), (x: 900., y: 400.), (x: 0., y: 400.)];
/// let grid = from_fn(land, |_, heading| Some(arm_nearest(0.0, heading)));
/// let extent = Rect::new(coord! { x: 0., y: 0. }, coord! { x: 900., y: 400. });
/// let seeds = lattice(&grid, extent, 20.0)?;
/// // Twice as dense in the west as in the east.
/// let scale = |at: geo_types::Coord<f64>| if at.x < 450.0 { 0.5 } else { 1.0 };
/// let lines = place_scaled(&grid, &seeds, &PlacementOptions::default(), &scale)?;
/// let north = |from: f64, to: f64| {
///     let inside = |x: f64| from < x && x < to;
///     lines.iter().filter(|l| l.family == 1 && inside(l.seed.x)).count()
/// };
/// assert!(north(0.0, 450.0) > north(450.0, 900.0));
/// # Ok::<(), streamline::TraceError>(())
/// ```
pub fn place_scaled<F: DirectionField + ?Sized>(
    field: &F,
    seeds: &[Seed],
    options: &PlacementOptions,
    scale: &(dyn Fn(Coord<f64>) -> f64 + Sync),
) -> Result<Vec<Streamline>, TraceError> {
    options.validate()?;
    for (index, seed) in seeds.iter().enumerate() {
        let Coord { x, y } = seed.at;
        if !is_finite(seed.at) {
            return Err(TraceError::SeedNotFinite { index, x, y });
        }
        if let Some(bad) = seed.directions.into_iter().find(|&d| unit(d).is_none()) {
            let (x, y) = (bad.x, bad.y);
            return Err(TraceError::NoHeading { index, x, y });
        }
    }
    let spacing = Spacing::new(options.separation, scale, seeds)?;
    let lines = Placer::new(field, options, &spacing, seeds).run(seeds);
    Ok(match options.ends {
        Ends::Open => lines,
        Ends::Junction => junction::cut(lines, &|line: &Streamline| {
            options.min_length * spacing.at(line.seed, line.family)
        }),
    })
}
