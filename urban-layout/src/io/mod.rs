//! Files in and out.
pub mod frame;
pub mod geojson;
pub mod layout_geojson;
pub mod write;
