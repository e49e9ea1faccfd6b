//! H-fields: crosses from the graphs of harmonic functions.
//!
//! Supplement of Yang et al. 2013, section 4.2. A harmonic function z with a
//! constant flux through each straight piece of the boundary (equation 2) has
//! a Hessian whose eigenvectors follow the boundary (equation 1); they are
//! the cross. The constants are free but for Gauss's law, and are searched
//! for low divergence of one arm; the local minima are a gallery to choose
//! from.
//!
//! Differs from the paper, by default: quadratic elements with a recovery
//! that knows z to be harmonic, since the paper's Hessians do not converge;
//! all Hessians are linear in the constants, so that the search solves no
//! system; its gradient has a closed form; linear functions, which have no
//! Hessian, are kept out of it; opposite constants give the same crosses and
//! are one entry; and fixed discs around singularities are left out of the
//! energy, which would otherwise grow without end under refinement.

mod basis;
mod discs;
mod elements;
mod family;
mod gallery;
mod gradient;
mod misfit;
mod objective;
mod pieces;
mod recovery;
mod search;
mod sides;

pub use basis::HarmonicBasis;
pub use elements::Elements;
pub use family::Alignment;
pub use gallery::GalleryEntry;
pub use gradient::GradientField;
pub use pieces::BoundaryPiece;

use crate::domain::Domain;
use crate::field::{Field, FieldDesign};
use crate::FieldError;
use gallery::Wanted;

/// The harmonic fields (H-fields) of a domain.
///
/// As a [`FieldDesign`] it gives one entry of the gallery, by default the one
/// of least energy. More than D- and B-fields these are inventions: they
/// follow the boundary, and inside have singularities of index -1/2 where the
/// search puts them.
///
/// ```
/// use crossfield::{geo_types::polygon, Domain, DomainOptions, HarmonicField};
///
/// let site = polygon![(x: 0., y: 0.), (x: 90., y: 10.), (x: 80., y: 60.), (x: 40., y: 85.),
///     (x: -5., y: 50.)];
/// let domain = Domain::new(&site, &DomainOptions::default())?;
/// let gallery = HarmonicField::default().gallery(&domain)?;
/// for entry in &gallery {
///     println!("{:.2} {:?}", entry.energy, entry.field.singularities());
/// }
/// assert!(gallery[0].energy <= gallery[gallery.len() - 1].energy);
/// # Ok::<(), crossfield::FieldError>(())
/// ```
///
#[doc = include_str!("../../images/h-field.svg")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HarmonicField {
    /// Which entry of the gallery [`FieldDesign::design`] gives; 0 is the one
    /// of least energy.
    ///
    /// Default value: 0.
    pub entry: usize,
    /// Entries of the gallery at most.
    ///
    /// Default value: 8.
    pub entries: usize,
    /// Starts of the search, a third of them smooth functions, the others
    /// random.
    ///
    /// Default value: 24.
    pub starts: usize,
    /// Seed of the random starts (generator PCG32).
    ///
    /// Default value: 0.
    pub seed: u64,
    /// Weight of being different from earlier entries against that of low
    /// energy in the order of the gallery, between 0 and 1; 0 orders by
    /// energy alone.
    ///
    /// Default value: 0.3.
    pub diversity: f64,
    /// Most by which the directions of the edges of one boundary piece may
    /// differ, degrees. Less follows bent boundaries more closely, with more
    /// constants to search.
    ///
    /// Default value: 15.
    pub max_turn_deg: f64,
    /// Most boundary pieces; each costs a solve, two numbers at each vertex,
    /// and eight more while the basis is made.
    ///
    /// Default value: 200.
    pub max_pieces: usize,
    /// Radius of the discs around singularities and singular corners that the
    /// energy leaves out, metres; 0 for a twenty-fifth of the square root of
    /// the area.
    ///
    /// Default value: 0.
    pub disc_radius: f64,
    /// What the search is charged for leaving bent boundaries, against the
    /// divergence energy: the mean of sin^2 of twice the angle between field
    /// and boundary counts so much. Straight sides are followed in any case.
    ///
    /// Default value: 10.
    pub alignment: f64,
    /// The finite elements.
    ///
    /// Default value: [`Elements::Quadratic`].
    pub elements: Elements,
}

impl Default for HarmonicField {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl HarmonicField {
    /// All options at their default values, for constants.
    pub const DEFAULT: Self = Self {
        entry: 0,
        entries: 8,
        starts: 24,
        seed: 0,
        diversity: 0.3,
        max_turn_deg: 15.0,
        max_pieces: 200,
        disc_radius: 0.0,
        alignment: 10.0,
        elements: Elements::Quadratic,
    };

    /// All H-fields of `domain` as linear combinations.
    ///
    /// The domain is one problem: if a hole that touches the exterior twice
    /// cuts it in two, fluxes are balanced over both parts together, and what
    /// one lacks passes through the point where they touch. Make two domains
    /// of it.
    ///
    /// # Errors
    ///
    /// [`FieldError::NoHarmonicField`] for a triangle, and for any boundary
    /// of up to three pieces; [`FieldError::BadOption`] for an option out of
    /// its range, or a boundary of more than
    /// [`max_pieces`](Self::max_pieces) pieces;
    /// [`FieldError::SingularSystem`] if the solution does not satisfy the
    /// system.
    ///
    /// # Complexity
    ///
    /// One sparse Cholesky factorisation in four times the number of vertices
    /// (about O(n^1.5)), and one solve for each piece.
    pub fn basis(&self, domain: &Domain) -> Result<HarmonicBasis, FieldError> {
        HarmonicBasis::new(self, domain)
    }

    /// Distinct local minima of the divergence energy: first the one of least
    /// energy, then always the one that is best by energy and by its
    /// difference from those before it ([`diversity`](Self::diversity)).
    ///
    /// Never empty. One entry where there is only one field, as for a
    /// rectangle. The same input and options give the same gallery.
    ///
    /// # Errors
    ///
    /// As [`HarmonicField::basis`].
    pub fn gallery(&self, domain: &Domain) -> Result<Vec<GalleryEntry>, FieldError> {
        self.gallery_of(&self.basis(domain)?)
    }

    /// The gallery of a basis that has been made already, for another seed or
    /// another number of entries.
    ///
    /// # Errors
    ///
    /// [`FieldError::BadOption`] for an option out of its range. Options of
    /// the basis itself have no effect.
    pub fn gallery_of(&self, basis: &HarmonicBasis) -> Result<Vec<GalleryEntry>, FieldError> {
        self.check()?;
        let wanted = Wanted {
            starts: self.starts,
            seed: self.seed,
            entries: self.entries,
            diversity: self.diversity,
        };
        gallery::gallery(&basis.family, &wanted)
    }

    pub(crate) fn check(&self) -> Result<(), FieldError> {
        check_counts(self.starts, self.entries, self.diversity, self.disc_radius)?;
        if !(self.max_turn_deg > 0.0 && self.max_turn_deg <= 90.0) {
            return Err(FieldError::option(
                "max_turn_deg",
                format!("is {}; give more than 0 and at most 90", self.max_turn_deg),
            ));
        }
        if !(self.alignment >= 0.0 && self.alignment.is_finite()) {
            return Err(FieldError::option(
                "alignment",
                format!("is {}; give 0 or more", self.alignment),
            ));
        }
        Ok(())
    }
}

/// Checks the options that both galleries have.
fn check_counts(
    starts: usize,
    entries: usize,
    diversity: f64,
    disc_radius: f64,
) -> Result<(), FieldError> {
    if starts == 0 || starts > 100_000 {
        return Err(FieldError::option(
            "starts",
            format!("is {starts}; give 1 to 100 000"),
        ));
    }
    if entries == 0 {
        return Err(FieldError::option("entries", "is 0; give 1 or more"));
    }
    if !(0.0..=1.0).contains(&diversity) {
        return Err(FieldError::option(
            "diversity",
            format!("is {diversity}; give 0 to 1"),
        ));
    }
    if !(disc_radius >= 0.0 && disc_radius.is_finite()) {
        return Err(FieldError::option(
            "disc_radius",
            format!("is {disc_radius}; give metres, or 0 for automatic"),
        ));
    }
    Ok(())
}

/// The entry of a gallery that was asked for.
fn pick(mut gallery: Vec<GalleryEntry>, entry: usize) -> Result<Field, FieldError> {
    if entry >= gallery.len() {
        return Err(FieldError::option(
            "entry",
            format!(
                "is {entry}; the gallery of this domain has {} entries, counted from 0",
                gallery.len()
            ),
        ));
    }
    Ok(gallery.swap_remove(entry).field)
}

impl FieldDesign for HarmonicField {
    /// The chosen entry of the gallery.
    ///
    /// # Errors
    ///
    /// As [`HarmonicField::basis`]; and [`FieldError::BadOption`] if the
    /// gallery has fewer entries than [`entry`](Self::entry) asks for.
    fn design(&self, domain: &Domain) -> Result<Field, FieldError> {
        self.check()?;
        if self.entry >= self.entries {
            return Err(FieldError::option(
                "entry",
                format!("is {}; it must be below `entries`", self.entry),
            ));
        }
        pick(self.gallery(domain)?, self.entry)
    }
}
