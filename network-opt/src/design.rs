//! Network and floorplan design by integer programs: not in this version.
//!
//! The formulation (Peng et al., *Computational Network Design from Functional
//! Specifications*, 2016) will live here. Until then a caller that offers it
//! as one of several ways to split a region asks [`available`] first and
//! passes the error on.

use crate::error::NetworkError;

/// Can this version design networks by integer programs?
///
/// # Errors
///
/// [`NetworkError::NotAvailable`], always, in this version.
///
/// # Examples
///
/// ```
/// let error = network_opt::design::available().unwrap_err();
/// assert!(error.to_string().contains("not available"));
/// ```
pub fn available() -> Result<(), NetworkError> {
    Err(NetworkError::NotAvailable {
        version: env!("CARGO_PKG_VERSION"),
    })
}
