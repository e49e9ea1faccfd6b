//! What `--spec` of `floorplan` holds.

use geo_types::Coord;
use network_opt::floor::{FloorSpecification, Place, Room, Shaft};
use serde::Deserialize;

use crate::error::{Error, Result};
use crate::io::frame::Frame;

/// A building: mesh, rooms, shafts and storeys. Points are in the coordinates of
/// the building's file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, rename_all = "kebab-case", deny_unknown_fields)]
pub struct FloorplanSpec {
    /// Side of the squares that rooms are made of, metres; 0 for 2.7 m, or more
    /// on a large floor, so that it has about 400 squares. Default 0.
    pub cell: f64,
    /// Width of corridors, metres. Default 1.8.
    pub corridor_width: f64,
    /// Width of doors, metres. Default 0.9.
    pub door_width: f64,
    /// Kinds of rooms of the storeys that have none of their own. Default: those
    /// of [`FloorSpecification::default`].
    pub room: Vec<Room>,
    /// Elevators and stairs. Default none.
    pub shaft: Vec<Shaft>,
    /// So many more, placed by the program. Default 0.
    pub spread_shafts: usize,
    /// The storeys, the ground floor first. Default one.
    pub storey: Vec<FloorSpecification>,
}

/// A fault of the text in one line: its own message is a picture of several.
fn fault(text: &str, error: &toml::de::Error) -> Error {
    let before = error.span().and_then(|span| text.get(..span.start));
    let line = before.map_or(1, |before| before.matches('\n').count() + 1);
    let message: Vec<&str> = error.message().lines().map(str::trim).collect();
    Error::input(format!(
        "the specification, line {line}: {}",
        message.join("; ")
    ))
}

impl FloorplanSpec {
    /// Reads a specification in TOML.
    ///
    /// # Errors
    ///
    /// An error of input that says where the text is not what it should be, and
    /// for numbers out of their range.
    ///
    /// # Examples
    ///
    /// ```
    /// use urban_layout::floorplan::FloorplanSpec;
    ///
    /// let spec = FloorplanSpec::from_toml(
    ///     r####"
    ///     corridor-width = 2.0
    ///     spread-shafts = 2
    ///     [[room]]
    ///     name = "office"
    ///     shapes = ["##/##", "###/###"]
    ///     window = { weighted = 1.0 }
    ///     [[room]]
    ///     name = "toilet"
    ///     shapes = ["#", "##"]
    ///     least = 2
    ///     beside = [{ room = "office", wish = "required" }]
    ///     [[storey]]
    ///     name = "Ground floor"
    ///     dead-ends = "forbidden"
    ///     [[storey]]
    ///     name = "First floor"
    ///     "####,
    /// )?;
    /// assert_eq!(spec.storey[1].rooms[1].name, "toilet");
    /// # Ok::<(), urban_layout::Error>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Self> {
        let mut spec: Self = toml::from_str(text).map_err(|e| fault(text, &e))?;
        let usual = FloorSpecification::default().rooms;
        if !spec.room.is_empty() {
            for storey in spec.storey.iter_mut().filter(|s| s.rooms == usual) {
                storey.rooms.clone_from(&spec.room);
            }
        }
        spec.check()?;
        Ok(spec)
    }

    pub(super) fn check(&self) -> Result<()> {
        if self.storey.is_empty() {
            return Err(Error::input(
                "the specification has no storey; give a [[storey]]",
            ));
        }
        if !(self.cell >= 0.0 && self.cell.is_finite()) {
            return Err(Error::input(format!(
                "the cell is {} m; give metres, or 0 for automatic",
                self.cell
            )));
        }
        for (name, width) in [
            ("corridors", self.corridor_width),
            ("doors", self.door_width),
        ] {
            if !(width > 0.0 && width.is_finite()) {
                return Err(Error::input(format!(
                    "{name} are {width} m wide; give metres"
                )));
            }
        }
        Ok(())
    }

    /// With all points in the local metres of a frame.
    pub(super) fn in_metres(&self, frame: &Frame) -> Self {
        let point = |[x, y]: [f64; 2]| {
            let local = frame.to_local(Coord { x, y });
            [local.x, local.y]
        };
        let place = |place: &mut Place| {
            if let Place::Point(p) = place {
                *p = point(*p);
            }
        };
        let ring = |ring: &mut Vec<[f64; 2]>| ring.iter_mut().for_each(|p| *p = point(*p));
        let mut spec = self.clone();
        for shaft in &mut spec.shaft {
            place(&mut shaft.at);
        }
        for storey in &mut spec.storey {
            storey.entrances.iter_mut().for_each(place);
            storey
                .obstacles
                .iter_mut()
                .for_each(|o| ring(&mut o.polygon));
            storey.rooms.iter_mut().for_each(|r| ring(&mut r.within));
        }
        spec
    }
}
