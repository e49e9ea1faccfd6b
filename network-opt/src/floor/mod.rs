//! Floorplans: rooms that tile a floor and corridors between them (section 5.2
//! of Peng et al. 2016).
//!
//! - [`Shape`]: the shape of a room, squares joined side to side;
//! - [`placements`]: all places of a shape on a mesh;
//! - [`FloorSpecification`]: rooms, entrances, shafts, obstacles and wishes of
//!   one storey; [`FloorSpecification::on`] says what they mean on a mesh;
//! - [`design_storeys`]: a building of several storeys around the same shafts.

mod candidates;
mod entrances;
mod measure;
mod on;
mod place;
mod shafts;
mod spec;
mod storeys;
mod template;

pub use on::Floor;
pub use place::placements;
pub use shafts::ShaftPlace;
pub use spec::{Beside, FloorSpecification, Near, Obstacle, Place, Room, Shaft, ShaftRole, Wish};
pub use storeys::{design_storeys, spread_shafts, Storey};
pub use template::Shape;
