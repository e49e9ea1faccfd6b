//! H-fields: announced here, so that a caller can name all three designs.

use crate::domain::Domain;
use crate::field::{Field, FieldDesign};
use crate::FieldError;

/// The harmonic field (H-field) of a domain: principal directions of the
/// graph of a harmonic function (supplement of Yang et al. 2013, section 4.2).
///
/// Not available in this version: designing one is an error. A
/// [`DistanceField`](crate::DistanceField) or a
/// [`BoundaryField`](crate::BoundaryField) takes its place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HarmonicField;

impl FieldDesign for HarmonicField {
    /// Always [`FieldError::NotAvailable`].
    fn design(&self, _: &Domain) -> Result<Field, FieldError> {
        Err(FieldError::NotAvailable {
            what: "harmonic fields (H-fields) are not available in this version; \
                   use a distance field (D-field) or a boundary field (B-field)"
                .into(),
        })
    }
}
