//! The laws of a scene, judged without the derivation.
//!
//! [`Scene::audit`] looks at nothing but the scene and the outline that it was
//! derived on, and shares neither booleans nor the record of what stands where
//! with the rules. The laws:
//!
//! - the pieces tile the outline: no gap, no overlap, nothing outside, to
//!   [`Audit::TILING`] of its area;
//! - footprints of objects lie in the park, on the ground that the object was put
//!   on and no other, and share no ground with each other nor with volumes;
//! - volumes lie in the park and share no ground with each other;
//! - paths lead out: every connected part of them borders on the park's outer
//!   boundary. Parts are connected, and lead out, over a stretch of at least half
//!   a metre; touching in a point is nothing that one could pass.

mod coverage;
mod locate;
mod network;
mod standing;

use std::fmt;

use geo_types::{Coord, LineString, Polygon};

use self::coverage::coverage;
use self::network::{networks, WAY};
use crate::plane::Area;
use crate::scene::{Ground, Object, Scene};

/// Borders and footprints are measured to this share of the park's size.
const NEAR: f64 = 1e-8;

/// What an audit found.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Audit {
    /// Area of the outline, square metres.
    pub area: f64,
    /// Land of the outline that no piece covers, square metres.
    pub gap: f64,
    /// Land that pieces cover beyond once, square metres.
    pub overlap: f64,
    /// Land of pieces outside of the outline, square metres.
    pub outside: f64,
    /// Land that volumes cover beyond once, square metres.
    pub volume_overlap: f64,
    /// Land of volumes outside of the outline, square metres.
    pub volume_outside: f64,
    /// The connected parts of all paths, the largest first.
    pub paths: Vec<PathNetwork>,
    /// Every law that is broken, and where; empty for a scene as it must be.
    pub violations: Vec<Violation>,
}

/// Paths that are connected.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PathNetwork {
    /// Which of the scene's pieces.
    pub pieces: Vec<usize>,
    /// Square metres.
    pub area: f64,
    /// How much of the park's outer boundary they border on, metres.
    pub entrance: f64,
}

/// A law that a scene breaks. Numbers of pieces, objects and volumes are those of
/// the scene's lists.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Violation {
    /// Land that no piece covers.
    Gap {
        /// Square metres.
        area: f64,
    },
    /// Land that several pieces cover.
    Overlap {
        /// Square metres.
        area: f64,
    },
    /// Pieces outside of the park.
    Outside {
        /// Square metres.
        area: f64,
    },
    /// A piece without area, or with coordinates that are not finite.
    NoPiece {
        /// Which.
        piece: usize,
    },
    /// An object or volume without a place: a coordinate or size is not finite.
    Nowhere {
        /// What it is called.
        name: String,
    },
    /// A footprint reaches out of the park.
    ObjectOutside {
        /// Which.
        object: usize,
        /// How far, metres.
        depth: f64,
    },
    /// A footprint lies on ground that the object was not put on: a tree on a
    /// path.
    WrongGround {
        /// Which object.
        object: usize,
        /// On which piece.
        piece: usize,
        /// How far it reaches into that, metres.
        depth: f64,
    },
    /// Two footprints share ground.
    Collision {
        /// Which.
        objects: [usize; 2],
        /// By how much they would have to part, metres.
        depth: f64,
    },
    /// A footprint shares ground with a volume.
    InVolume {
        /// Which object.
        object: usize,
        /// Which volume.
        volume: usize,
        /// How far it reaches into that, metres.
        depth: f64,
    },
    /// Volumes share ground.
    VolumesOverlap {
        /// Square metres.
        area: f64,
    },
    /// Volumes reach out of the park.
    VolumesOutside {
        /// Square metres.
        area: f64,
    },
    /// Paths that do not lead out of the park.
    NoEntrance {
        /// Which pieces.
        pieces: Vec<usize>,
        /// Square metres.
        area: f64,
        /// Over how many metres they border on the park's boundary.
        entrance: f64,
    },
}

impl Audit {
    /// Most of a park's area that may be gap, overlap or outside.
    pub const TILING: f64 = 1e-9;

    /// Whether the scene keeps all laws.
    #[must_use]
    pub fn is_lawful(&self) -> bool {
        self.violations.is_empty()
    }

    /// Gap, overlap and what lies outside, as a share of the park's area.
    #[must_use]
    pub fn tiling_error(&self) -> f64 {
        (self.gap + self.overlap + self.outside) / self.area
    }
}

impl Scene {
    /// Judges the scene by its laws.
    ///
    /// # Examples
    ///
    /// ```
    /// use park_grammar::geo_types::polygon;
    /// use park_grammar::{DeriveOptions, Grammar};
    ///
    /// let square = polygon![(x: 0., y: 0.), (x: 40., y: 0.), (x: 40., y: 40.), (x: 0., y: 40.)];
    /// let grammar = Grammar::new("grammar 1\nRegion -> Grid(2, 2) { Lawn Place(CENTRE) { Tree } }")?;
    /// let mut park = grammar.derive(&square, &DeriveOptions::default())?;
    /// let audit = park.audit(&square);
    /// assert!(audit.is_lawful() && audit.tiling_error() < 1e-12);
    /// // Four paths of 2 m lead out.
    /// assert!((audit.paths[0].entrance - 8.0).abs() < 1e-6);
    ///
    /// park.pieces.pop();
    /// assert!(!park.audit(&square).is_lawful());
    /// # Ok::<(), park_grammar::ParkError>(())
    /// ```
    #[must_use]
    pub fn audit(&self, outline: &Polygon<f64>) -> Audit {
        let mut audit = Audit::default();
        let origin = middle(outline);
        let park = area_from(outline, origin).unwrap_or_default();
        audit.area = park.size();
        let (low, high) = park.extent();
        let near = NEAR * (high.x - low.x).max(high.y - low.y);

        let mut pieces: Vec<(usize, Area)> = Vec::new();
        for (k, piece) in self.pieces.iter().enumerate() {
            match area_from(&piece.polygon, origin) {
                Some(area) => pieces.push((k, area)),
                None => audit.violations.push(Violation::NoPiece { piece: k }),
            }
        }
        let mut volumes: Vec<(usize, Area)> = Vec::new();
        for (k, volume) in self.volumes.iter().enumerate() {
            match area_from(&volume.polygon, origin).filter(|_| volume.height.is_finite()) {
                Some(area) => volumes.push((k, area)),
                None => audit.nowhere(&volume.name),
            }
        }
        let mut objects: Vec<(usize, Object)> = Vec::new();
        for (k, object) in self.objects.iter().enumerate() {
            let numbers = [object.at.x, object.at.y, object.radius, object.facing];
            if numbers.iter().all(|x| x.is_finite()) && object.radius >= 0.0 {
                let at = object.at - origin;
                objects.push((
                    k,
                    Object {
                        at,
                        ..object.clone()
                    },
                ));
            } else {
                audit.nowhere(&object.name);
            }
        }

        audit.tiling(&park, &areas(&pieces));
        audit.built(&park, &areas(&volumes));
        let grounds: Vec<Ground> = self.pieces.iter().map(|piece| piece.ground).collect();
        let (pieces, volumes) = (borrowed(&pieces), borrowed(&volumes));
        let judge = standing::Judge {
            outline: &park,
            pieces: &pieces,
            grounds: &grounds,
            volumes: &volumes,
            rounding: near,
        };
        audit.violations.extend(standing::objects(&judge, &objects));
        let paths: Vec<(usize, &Area)> = pieces
            .into_iter()
            .filter(|(k, _)| grounds[*k] == Ground::Path)
            .collect();
        audit.paths = networks(&park, &paths, near);
        let closed = audit.paths.iter().filter(|paths| paths.entrance < WAY);
        let closed = closed.map(|paths| Violation::NoEntrance {
            pieces: paths.pieces.clone(),
            area: paths.area,
            entrance: paths.entrance,
        });
        audit.violations.extend(closed.collect::<Vec<_>>());
        audit
    }
}

impl Audit {
    fn nowhere(&mut self, name: &str) {
        self.violations.push(Violation::Nowhere {
            name: name.to_owned(),
        });
    }

    fn tiling(&mut self, park: &Area, pieces: &[Area]) {
        let found = coverage(park, pieces);
        (self.gap, self.overlap, self.outside) = (found.gap, found.overlap, found.outside);
        let most = Self::TILING * self.area;
        if found.gap > most {
            self.violations.push(Violation::Gap { area: found.gap });
        }
        if found.overlap > most {
            self.violations.push(Violation::Overlap {
                area: found.overlap,
            });
        }
        if found.outside > most {
            self.violations.push(Violation::Outside {
                area: found.outside,
            });
        }
    }

    fn built(&mut self, park: &Area, volumes: &[Area]) {
        let found = coverage(park, volumes);
        (self.volume_overlap, self.volume_outside) = (found.overlap, found.outside);
        let most = Self::TILING * self.area;
        if found.overlap > most {
            self.violations.push(Violation::VolumesOverlap {
                area: found.overlap,
            });
        }
        if found.outside > most {
            self.violations.push(Violation::VolumesOutside {
                area: found.outside,
            });
        }
    }
}

fn borrowed(all: &[(usize, Area)]) -> Vec<(usize, &Area)> {
    all.iter().map(|(k, area)| (*k, area)).collect()
}

fn areas(all: &[(usize, Area)]) -> Vec<Area> {
    all.iter().map(|(_, area)| area.clone()).collect()
}

/// The middle of a polygon's box: far from the origin coordinates have fewer
/// digits left for the rest.
fn middle(polygon: &Polygon<f64>) -> Coord<f64> {
    let finite: Vec<Coord<f64>> = polygon
        .exterior()
        .0
        .iter()
        .copied()
        .filter(|c| c.x.is_finite() && c.y.is_finite())
        .collect();
    let (low, high) = crate::plane::extent(&finite);
    (low + high) / 2.0
}

/// The area of a polygon, if it has one.
fn area_from(polygon: &Polygon<f64>, origin: Coord<f64>) -> Option<Area> {
    let mut rings = std::iter::once(polygon.exterior()).chain(polygon.interiors());
    if !rings.all(|ring| ring.0.iter().all(|c| c.x.is_finite() && c.y.is_finite())) {
        return None;
    }
    let moved = |ring: &LineString<f64>| LineString(ring.0.iter().map(|&c| c - origin).collect());
    let polygon = Polygon::new(
        moved(polygon.exterior()),
        polygon.interiors().iter().map(moved).collect(),
    );
    let area = Area::from_polygon(&polygon);
    (area.outer.len() >= 3 && area.size() > 0.0).then_some(area)
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gap { area } => write!(f, "{area:.3e} m2 of the park are covered by no piece"),
            Self::Overlap { area } => write!(f, "{area:.3e} m2 are covered by several pieces"),
            Self::Outside { area } => write!(f, "{area:.3e} m2 of pieces lie outside of the park"),
            Self::NoPiece { piece } => write!(f, "piece {piece} has no area"),
            Self::Nowhere { name } => write!(f, "a {name} has no place"),
            Self::ObjectOutside { object, depth } => {
                write!(f, "object {object} reaches {depth:.3} m out of the park")
            }
            Self::WrongGround {
                object,
                piece,
                depth,
            } => write!(
                f,
                "object {object} reaches {depth:.3} m into piece {piece}, on which it was not put"
            ),
            Self::Collision {
                objects: [a, b],
                depth,
            } => write!(f, "objects {a} and {b} share {depth:.3} m of ground"),
            Self::InVolume {
                object,
                volume,
                depth,
            } => write!(f, "object {object} reaches {depth:.3} m into volume {volume}"),
            Self::VolumesOverlap { area } => {
                write!(f, "{area:.3e} m2 are covered by several volumes")
            }
            Self::VolumesOutside { area } => {
                write!(f, "{area:.3e} m2 of volumes lie outside of the park")
            }
            Self::NoEntrance {
                pieces,
                area,
                entrance,
            } => write!(
                f,
                "{area:.1} m2 of paths ({} pieces, among them {}) border on {entrance:.3} m of the park's boundary only",
                pieces.len(),
                pieces.first().copied().unwrap_or(0)
            ),
        }
    }
}
