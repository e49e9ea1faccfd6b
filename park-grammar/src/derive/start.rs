//! Where a derivation begins and ends: an outline in, a scene out.

use std::cell::RefCell;
use std::collections::BTreeMap;

use geo_types::Polygon;

use super::limits::Limits;
use super::{DeriveOptions, Node, Run, Stream};
use crate::error::ParkError;
use crate::grammar::Grammar;
use crate::index;
use crate::plane::Area;
use crate::scene::Scene;
use crate::shape::Region;

impl Grammar {
    /// Derives a park on a polygon.
    ///
    /// # Errors
    ///
    /// [`ParkError::Outline`] for a polygon without area, or with coordinates
    /// that are not finite; [`ParkError::Rule`] where an operation cannot be done
    /// and names no alternative; [`ParkError::Limit`] for a derivation without
    /// end.
    ///
    /// # Examples
    ///
    /// ```
    /// use park_grammar::geo_types::polygon;
    /// use park_grammar::{DeriveOptions, Grammar};
    ///
    /// let grammar = Grammar::new("grammar 1\nRegion -> Lawn Place(CENTRE) { Circle(3) Gravel Fountain }")?;
    /// let square = polygon![(x: 0., y: 0.), (x: 80., y: 0.), (x: 80., y: 50.), (x: 0., y: 50.)];
    /// let park = grammar.derive(&square, &DeriveOptions::default())?;
    /// assert_eq!((park.pieces.len(), park.objects.len()), (2, 1));
    /// # Ok::<(), park_grammar::ParkError>(())
    /// ```
    pub fn derive(&self, park: &Polygon<f64>, options: &DeriveOptions) -> Result<Scene, ParkError> {
        self.derive_watched(park, options, &mut |_| true)
    }

    /// [`Grammar::derive`] that tells how many operations have been done, and
    /// stops where it is answered false.
    ///
    /// # Errors
    ///
    /// As [`Grammar::derive`]; [`ParkError::Cancelled`].
    pub fn derive_watched(
        &self,
        park: &Polygon<f64>,
        options: &DeriveOptions,
        watch: &mut dyn FnMut(usize) -> bool,
    ) -> Result<Scene, ParkError> {
        let area = outline(park)?;
        // Far from the origin coordinates have fewer digits left for the rest.
        let origin = crate::plane::lerp(area.extent().0, area.extent().1, 0.5);
        let moved = |ring: &crate::plane::Ring| ring.iter().map(|&c| c - origin).collect();
        let area = Area {
            outer: moved(&area.outer),
            holes: area.holes.iter().map(moved).collect(),
        };
        let mut region = Region::bare(area);
        index::park(&mut region);
        let watch = RefCell::new(watch);
        let ask = |operations: usize| (watch.borrow_mut())(operations);
        let limits = Limits::new(options, &ask);
        let mut run = Run {
            grammar: self,
            params: BTreeMap::new(),
            scene: Scene::default(),
            options,
            limits: &limits,
        };
        let mut node = Node::new(region, self.start().into(), Stream::new(options.seed));
        let done = run
            .set_params(&mut node)
            .and_then(|()| run.start(&mut node));
        done.map_err(|failure| failure.into_error(self.sources()))?;
        Ok(run.scene.moved(origin))
    }
}

fn outline(park: &Polygon<f64>) -> Result<Area, ParkError> {
    let bad = |what: &str| ParkError::Outline {
        what: what.to_owned(),
    };
    let rings = std::iter::once(park.exterior()).chain(park.interiors());
    if rings
        .flat_map(|ring| &ring.0)
        .any(|c| !(c.x.is_finite() && c.y.is_finite()))
    {
        return Err(bad("a coordinate is not finite"));
    }
    let far = |x: f64| x.abs() > crate::plane::FARTHEST;
    let rings = std::iter::once(park.exterior()).chain(park.interiors());
    if rings.flat_map(|ring| &ring.0).any(|c| far(c.x) || far(c.y)) {
        return Err(bad("it lies a million kilometres away or more"));
    }
    // Whatever the order of its rings, and without what overlaps.
    let mut areas = crate::plane::union(&[Area::from_polygon(park)]);
    areas.sort_by(|a, b| b.size().total_cmp(&a.size()));
    if areas.len() > 1 {
        return Err(bad("it falls into several parts; derive a park for each"));
    }
    areas.pop().ok_or_else(|| bad("it has no area"))
}

impl Scene {
    fn moved(mut self, by: geo_types::Coord<f64>) -> Self {
        let ring = |line: &mut geo_types::LineString<f64>| {
            line.0.iter_mut().for_each(|c| *c = *c + by);
        };
        let shift = |polygon: &mut Polygon<f64>| {
            polygon.exterior_mut(ring);
            polygon.interiors_mut(|rings| rings.iter_mut().for_each(ring));
        };
        self.pieces.iter_mut().for_each(|p| shift(&mut p.polygon));
        self.volumes.iter_mut().for_each(|v| shift(&mut v.polygon));
        self.objects.iter_mut().for_each(|o| o.at = o.at + by);
        self
    }
}
