//! Files in and out: sites from GeoJSON, plans to GeoJSON, SVG, PNG and HTML.
//!
//! Reading and drawing know nothing of files: they take and give text or bytes, and
//! [`write`](mod@write) puts all outputs of a run in place at once. The way in is
//! [`Site::read`](crate::site::Site::read); [`frame`] leads between the file's coordinates and
//! the local metres in which all else works.

mod coordinates;
pub mod floorplan_geojson;
pub mod frame;
pub(crate) mod geojson;
pub mod html;
pub mod layout_geojson;
pub mod network_geojson;
pub mod park_geojson;
#[cfg(feature = "png")]
pub mod png;
pub mod streamlines_geojson;
pub mod svg;
pub mod write;
