//! From a grammar and an outline to a park.
//!
//! A node of the derivation is a region with the operations to be done on it. An
//! operation divides the region into others, which become nodes with the
//! operations of its blocks; or cuts a shape out of it; or puts things on it. A
//! region that nothing divides is left as a piece of ground.

mod content;
mod eval;
mod object;
mod random;
mod standing;
mod value;

use std::collections::BTreeMap;
use std::slice::from_ref;
use std::time::{Duration, Instant};

use geo_types::Polygon;

pub(crate) use content::Size;
pub(crate) use eval::{Places, Scope, ATTRIBUTES};
pub(crate) use object::{mesh_file, OBJECT};
pub(crate) use random::Stream;
pub(crate) use standing::{clear, inside, Disc, Standing};
pub(crate) use value::{Number, SizeRange, Sizing, Spot, Value};

use crate::error::{Failure, ParkError};
use crate::grammar::Grammar;
use crate::index;
use crate::library;
use crate::plane::{difference, intersection, middle, Area};
use crate::rule::{self, control, holes, operator_named, Ask, Deed, Partition, Primitive};
use crate::scene::{Ground, Piece, Scene};
use crate::shape::{Heritage, Region, Role};
use crate::syntax::ast::{Body, Branch, Operation, Span};

/// How a park is derived.
#[derive(Clone, Debug, PartialEq)]
pub struct DeriveOptions {
    /// Seed of all chance; the same seed gives the same park.
    ///
    /// Default value: 0.
    pub seed: u64,
    /// Values for parameters of the grammar, in the place of its own.
    ///
    /// Default value: none.
    pub params: BTreeMap<String, f64>,
    /// Deepest nesting of rules.
    ///
    /// Default value: 64.
    pub depth: usize,
    /// Most operations in all.
    ///
    /// Default value: 1,000,000.
    pub operations: usize,
    /// Time, by the clock; `None` for as long as it takes.
    ///
    /// Default value: 60 s.
    pub time: Option<Duration>,
}

impl Default for DeriveOptions {
    fn default() -> Self {
        Self {
            seed: 0,
            params: BTreeMap::new(),
            depth: 64,
            operations: 1_000_000,
            time: Some(Duration::from_secs(60)),
        }
    }
}

/// A region in the making.
pub(crate) struct Node {
    pub(crate) region: Region,
    pub(crate) ground: Ground,
    pub(crate) material: String,
    /// The rule that it follows.
    pub(crate) rule: String,
    pub(crate) chance: Stream,
    /// What has been cut out of it.
    pub(crate) carved: Vec<Area>,
    /// What stands on it.
    pub(crate) standing: Standing,
    /// Whether other regions have taken its place.
    divided: bool,
    /// Whether its first shape has been cut already: the centre of a crossing.
    shaped: bool,
    /// How deep in rules.
    level: usize,
}

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
        let mut run = Run {
            grammar: self,
            params: BTreeMap::new(),
            scene: Scene::default(),
            options,
            began: Instant::now(),
            operations: 0,
            steps: std::cell::Cell::new(0),
            watch,
        };
        let mut node = Node {
            region,
            ground: Ground::Region,
            material: "Lawn".to_owned(),
            rule: self.start().to_owned(),
            chance: Stream::new(options.seed),
            carved: Vec::new(),
            standing: Standing::default(),
            divided: false,
            shaped: false,
            level: 0,
        };
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
    // Whatever the order of its rings, and without what overlaps.
    let mut areas = crate::plane::union(&[Area::from_polygon(park)]);
    areas.sort_by(|a, b| b.size().total_cmp(&a.size()));
    if areas.len() > 1 {
        return Err(bad("it falls into several parts; derive a park for each"));
    }
    areas.pop().ok_or_else(|| bad("it has no area"))
}

/// A derivation under way.
pub(crate) struct Run<'g> {
    grammar: &'g Grammar,
    params: BTreeMap<String, Value>,
    pub(crate) scene: Scene,
    options: &'g DeriveOptions,
    began: Instant,
    operations: usize,
    steps: std::cell::Cell<usize>,
    watch: &'g mut dyn FnMut(usize) -> bool,
}

/// How far the scene was, to go back to.
struct Before {
    pieces: usize,
    objects: usize,
    volumes: usize,
    kinds: usize,
    skipped: usize,
}

impl Run<'_> {
    fn set_params(&mut self, node: &mut Node) -> Result<(), Failure> {
        let known: Vec<&str> = self.grammar.params().collect();
        if let Some(name) = self
            .options
            .params
            .keys()
            .find(|k| !known.contains(&k.as_str()))
        {
            return Err(Failure::Stopped(ParkError::Limit {
                what: format!(
                    "the grammar has no parameter {name}, it has {}",
                    known.join(", ")
                ),
            }));
        }
        for (name, expr) in self.grammar.param_values() {
            let mut value = match self.options.params.get(&name.text) {
                Some(&value) => Value::Number(Number::plain(value)),
                None => self.scope(node, &Places::new()).lasting(expr)?,
            };
            if let Value::Kind(kind) = &mut value {
                std::sync::Arc::make_mut(kind).name.clone_from(&name.text);
            }
            self.params.insert(name.text.clone(), value);
        }
        Ok(())
    }

    fn start(&mut self, node: &mut Node) -> Result<(), Failure> {
        let grammar = self.grammar;
        if let Some(rule) = grammar.rule(&node.rule) {
            self.body(node, &rule.body.operations, &Places::new())?;
        }
        self.finish(node)
    }

    /// What expressions of a node are evaluated in.
    pub(crate) fn scope<'s>(&'s self, node: &'s mut Node, places: &'s Places) -> Scope<'s> {
        Scope {
            grammar: self.grammar,
            params: &self.params,
            places,
            region: &node.region,
            chance: &mut node.chance,
            depth: 0,
            steps: &self.steps,
        }
    }

    /// Counts an operation, and sees that there are not too many.
    pub(crate) fn count(&mut self) -> Result<(), Failure> {
        let stopped = |error| Err(Failure::Stopped(error));
        self.operations += 1;
        if self.operations > self.options.operations {
            return stopped(ParkError::Limit {
                what: format!("it came to {} operations", self.options.operations),
            });
        }
        if self
            .options
            .time
            .is_some_and(|time| self.began.elapsed() > time)
        {
            return stopped(ParkError::Limit {
                what: "it took too long".to_owned(),
            });
        }
        if !(self.watch)(self.operations) {
            return stopped(ParkError::Cancelled);
        }
        Ok(())
    }

    fn body(
        &mut self,
        node: &mut Node,
        body: &[Operation],
        places: &Places,
    ) -> Result<(), Failure> {
        for (k, operation) in body.iter().enumerate() {
            self.count()?;
            let shape =
                operator_named(&operation.name.text).is_some_and(|o| matches!(o.deed, Deed::Shape));
            if shape && std::mem::take(&mut node.shaped) {
                continue;
            }
            if shape {
                let primitive = Primitive::read(operation, &mut self.scope(node, places))?;
                let spot = Spot {
                    at: middle(&node.region.area),
                    radius: 0.0,
                    facing: 0.0,
                };
                return self.carve(
                    node,
                    operation.span,
                    primitive,
                    spot,
                    &body[k + 1..],
                    places,
                );
            }
            self.attempt(node, operation, places)?;
        }
        Ok(())
    }

    /// An operation, or what it names in case it fails.
    fn attempt(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
    ) -> Result<(), Failure> {
        let Some(otherwise) = &operation.otherwise else {
            return self.operation(node, operation, places);
        };
        let before = Before {
            pieces: self.scene.pieces.len(),
            objects: self.scene.objects.len(),
            volumes: self.scene.volumes.len(),
            kinds: self.scene.kinds.len(),
            skipped: self.scene.skipped,
        };
        let (material, carved) = (node.material.clone(), node.carved.len());
        let standing = node.standing.clone();
        match self.operation(node, operation, places) {
            Err(Failure::Unfit(_)) => {
                self.scene.pieces.truncate(before.pieces);
                self.scene.objects.truncate(before.objects);
                self.scene.volumes.truncate(before.volumes);
                self.scene.kinds.truncate(before.kinds);
                self.scene.skipped = before.skipped;
                node.standing = standing;
                node.material = material;
                node.carved.truncate(carved);
                node.divided = false;
                for branch in &otherwise.branches {
                    self.body(node, &branch.body.operations, places)?;
                }
                Ok(())
            }
            other => other,
        }
    }

    fn operation(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
    ) -> Result<(), Failure> {
        let name = operation.name.text.as_str();
        let span = operation.span;
        let grammar = self.grammar;
        if let Some(rule) = grammar.rule(name) {
            let bound = self.bound(node, operation, &rule.places, places)?;
            let before = std::mem::replace(&mut node.rule, name.to_owned());
            self.deeper(node, |run, node| {
                run.body(node, &rule.body.operations, &bound)
            })?;
            // What follows in the rule above stands on the same ground.
            if !node.divided {
                node.rule = before;
            }
            return Ok(());
        }
        if let Some(function) = grammar.function(name) {
            let bound = self.bound(node, operation, &function.places, places)?;
            let crate::syntax::ast::Meaning::Body(body) = &function.meaning else {
                return Err(Failure::fault(
                    span,
                    format!("{name} is a value and no operation"),
                ));
            };
            return self.deeper(node, |run, node| run.body(node, &body.operations, &bound));
        }
        if let Some(operator) = operator_named(name) {
            return match operator.deed {
                Deed::Divide(divide) => self.divide(node, operation, places, divide, true),
                Deed::Part(divide) => self.divide(node, operation, places, divide, false),
                Deed::Act(act) => act(self, node, operation, places),
                Deed::Branch => {
                    let chosen = control::branch(operation, &mut self.scope(node, places))?;
                    match chosen {
                        Some(branch) => self.body(node, &branch.body.operations, places),
                        None => Ok(()),
                    }
                }
                Deed::Points => rule::points::act(self, node, operation, places),
                // Taken care of by `body`.
                Deed::Shape => Ok(()),
            };
        }
        if let Some(material) = library::material_named(name) {
            node.material = material.name.to_owned();
            return Ok(());
        }
        let spot = Spot {
            at: middle(&node.region.area),
            radius: 0.0,
            facing: 0.0,
        };
        let before = self.tally();
        self.thing(node, operation, places, spot)?;
        self.suited(operation, before)
    }

    pub(crate) fn bound(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        wanted: &[crate::syntax::ast::Name],
        places: &Places,
    ) -> Result<Places, Failure> {
        let arguments = operation.arguments.as_deref().unwrap_or(&[]);
        self.scope(node, places)
            .bind(operation.span, wanted, arguments)
    }

    fn deeper(
        &mut self,
        node: &mut Node,
        inner: impl FnOnce(&mut Self, &mut Node) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        if node.level >= self.options.depth {
            return Err(Failure::Stopped(ParkError::Limit {
                what: format!(
                    "rules lead to rules {} deep, at {}",
                    self.options.depth, node.rule
                ),
            }));
        }
        node.level += 1;
        let done = inner(self, node);
        node.level -= 1;
        done
    }

    /// Divides a region, and goes on with each of the parts.
    fn divide(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
        divide: fn(&mut Ask<'_, '_>) -> Result<Partition, Failure>,
        centred: bool,
    ) -> Result<(), Failure> {
        if node.divided || !node.carved.is_empty() || !node.standing.is_empty() {
            let error = "this region has been divided already";
            return Err(Failure::fault(operation.span, error)
                .hint("divide first, and put things onto the parts in their own rules"));
        }
        let outputs = outputs(operation);
        let third = outputs.get(2).copied().flatten();
        let centre = match third.filter(|_| centred) {
            Some(branch) => self.leading_shape(node, &branch.body, places, 0)?,
            None => None,
        };
        // Empty braces: the grammar wants no paths between.
        let no_paths = operation.blocks.get(1).is_some_and(|block| {
            block
                .branches
                .iter()
                .all(|branch| branch.body.operations.is_empty())
        });
        let path_width = if no_paths {
            0.0
        } else {
            match self.params.get("PathWidth") {
                Some(Value::Number(number)) => number.metres().unwrap_or(2.0),
                _ => 2.0,
            }
        };
        let mut partition = divide(&mut Ask {
            operation,
            scope: self.scope(node, places),
            path_width,
            centre,
        })?;
        if holes::everywhere(&self.params) {
            holes::split_all(&mut partition.outputs);
        }
        node.divided = true;
        for (k, output) in partition.outputs.into_iter().enumerate() {
            let branch = outputs.get(k).copied().flatten();
            for region in output.regions {
                let mut child = Node {
                    region,
                    ground: output.ground,
                    material: output.material.to_owned(),
                    rule: node.rule.clone(),
                    chance: node.chance.child(),
                    carved: Vec::new(),
                    standing: Standing::default(),
                    divided: false,
                    shaped: k == 2 && centre.is_some(),
                    level: node.level,
                };
                if let Some(branch) = branch {
                    self.deeper(&mut child, |run, child| {
                        run.body(child, &branch.body.operations, places)
                    })?;
                }
                self.finish(&mut child)?;
            }
        }
        Ok(())
    }

    /// The shape that operations begin with, through rules that do nothing
    /// before.
    fn leading_shape(
        &mut self,
        node: &mut Node,
        body: &Body,
        places: &Places,
        depth: usize,
    ) -> Result<Option<Primitive>, Failure> {
        let Some(first) = body.operations.first() else {
            return Ok(None);
        };
        let operator = operator_named(&first.name.text);
        if operator.is_some_and(|o| matches!(o.deed, Deed::Shape)) {
            return Primitive::read(first, &mut self.scope(node, places)).map(Some);
        }
        let grammar = self.grammar;
        match grammar.rule(&first.name.text) {
            Some(rule) if depth < self.options.depth => {
                let bound = self.bound(node, first, &rule.places, places)?;
                self.leading_shape(node, &rule.body, &bound, depth + 1)
            }
            _ => Ok(None),
        }
    }

    /// Cuts a shape out of a region, and does the rest on what was cut out.
    pub(crate) fn carve(
        &mut self,
        node: &mut Node,
        span: Span,
        primitive: Primitive,
        spot: Spot,
        rest: &[Operation],
        places: &Places,
    ) -> Result<(), Failure> {
        if node.divided {
            return Err(Failure::fault(span, "this region has been divided already"));
        }
        let ring = primitive.ring(spot.at, spot.facing);
        let shape = Area::new(ring, Vec::new());
        let free = difference(from_ref(&node.region.area), &node.carved);
        let mut found = intersection(from_ref(&shape), &free);
        let whole: f64 = found.iter().map(Area::size).sum();
        let taken = node.standing.discs().iter();
        let taken = taken.map(|disc| (disc.at, disc.radius));
        let taken = taken
            .into_iter()
            .any(|(at, radius)| !clear(&shape, at, radius))
            || !intersection(std::slice::from_ref(&shape), &node.standing.built).is_empty();
        if taken || (whole - shape.size()).abs() > 1e-6 * shape.size() || found.len() != 1 {
            return Err(Failure::unfit(span, "there is no room for this shape"));
        }
        let Some(area) = found.pop() else {
            return Ok(());
        };
        let local = crate::shape::Local::upright(&area.outer);
        let heritage = Heritage::new(&node.region, "Shape");
        let mut region = heritage.piece(area.clone(), local, |_, _| Some(Role::Centre));
        index::by_local(&mut region);
        node.carved.push(area);
        let mut child = Node {
            region,
            ground: node.ground,
            material: node.material.clone(),
            rule: node.rule.clone(),
            chance: node.chance.child(),
            carved: Vec::new(),
            standing: Standing::default(),
            divided: false,
            shaped: false,
            level: node.level,
        };
        self.deeper(&mut child, |run, child| run.body(child, rest, places))?;
        self.finish(&mut child)
    }

    /// Does the operations of the blocks at each of some places of a region.
    pub(crate) fn at_spots(
        &mut self,
        node: &mut Node,
        operation: &Operation,
        places: &Places,
        spots: &[Spot],
    ) -> Result<(), Failure> {
        let branches = || operation.blocks.iter().flat_map(|b| &b.branches);
        for &spot in spots {
            for branch in branches() {
                self.at_spot(node, &branch.body.operations, places, spot)?;
            }
        }
        Ok(())
    }

    pub(crate) fn at_spot(
        &mut self,
        node: &mut Node,
        body: &[Operation],
        places: &Places,
        spot: Spot,
    ) -> Result<(), Failure> {
        for (k, operation) in body.iter().enumerate() {
            self.count()?;
            let name = operation.name.text.as_str();
            let grammar = self.grammar;
            if let Some(rule) = grammar.rule(name) {
                let bound = self.bound(node, operation, &rule.places, places)?;
                self.deeper(node, |run, node| {
                    run.at_spot(node, &rule.body.operations, &bound, spot)
                })?;
                continue;
            }
            match operator_named(name).map(|o| o.deed) {
                Some(Deed::Shape) => {
                    let primitive = Primitive::read(operation, &mut self.scope(node, places))?;
                    let rest = &body[k + 1..];
                    return self.carve(node, operation.span, primitive, spot, rest, places);
                }
                Some(Deed::Branch) => {
                    let chosen = control::branch(operation, &mut self.scope(node, places))?;
                    if let Some(branch) = chosen {
                        self.at_spot(node, &branch.body.operations, places, spot)?;
                    }
                }
                Some(_) => {
                    let error = format!("{name} needs a region, and here is a place");
                    return Err(Failure::fault(operation.span, error)
                        .hint("begin with a shape, such as Circle(1)"));
                }
                None => self.thing(node, operation, places, spot)?,
            }
        }
        Ok(())
    }

    /// Leaves a region that nothing divided as ground.
    fn finish(&mut self, node: &mut Node) -> Result<(), Failure> {
        if node.divided {
            return Ok(());
        }
        let left = if node.carved.is_empty() {
            vec![node.region.area.clone()]
        } else {
            difference(from_ref(&node.region.area), &node.carved)
        };
        let walked = library::material_named(&node.material).is_some_and(|m| m.path);
        let ground = if walked { Ground::Path } else { node.ground };
        for &k in &node.standing.objects {
            self.scene.objects[k].ground = ground;
        }
        for area in left {
            self.scene.pieces.push(Piece {
                polygon: area.to_polygon(),
                ground,
                material: node.material.clone(),
                rule: node.rule.clone(),
            });
        }
        Ok(())
    }
}

/// The outputs that the blocks of an operation name: the branches of its only
/// block, or one for each block; `None` for an empty one.
pub(crate) fn outputs(operation: &Operation) -> Vec<Option<&Branch>> {
    match operation.blocks.as_slice() {
        [only] => only.branches.iter().map(Some).collect(),
        blocks => blocks.iter().map(|block| block.branches.first()).collect(),
    }
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
