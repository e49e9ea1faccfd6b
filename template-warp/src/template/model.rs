//! A template with its numbers put in and its contradictions found.

use super::format::{AlignKind, ClassSpec, CornerSpec, SideUse, Spec};
use super::length::Sizes;
use crate::error::WarpError;
use crate::geometry::{exceeds, self_contact, signed_area, turn, P};
use crate::registration::{AreaAffine, Deformation, PrincipalAffine, Rigid, Similarity};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Turn of the outline, degrees, from which a point of it is a corner.
const CORNER_DEG: f64 = 30.0;

/// A polygonal region split into faces, with everything that says how it may
/// deform (paper, section 4, "Templates").
#[derive(Clone, Debug)]
pub struct Template {
    pub(crate) name: String,
    pub(crate) label: String,
    pub(crate) probability: f64,
    pub(crate) mirror: bool,
    pub(crate) symmetry: usize,
    pub(crate) depth: Option<[f64; 2]>,
    pub(crate) points: Vec<P>,
    pub(crate) sides: Vec<Side>,
    /// Turn of the outline at the start of each side, radians.
    pub(crate) turns: Vec<f64>,
    pub(crate) divides: Vec<Divide>,
    /// Edges of the outline that take up slack without being divided.
    pub(crate) elastic: Vec<[usize; 2]>,
    pub(crate) arcs: Vec<ArcRun>,
    pub(crate) faces: Vec<Face>,
    pub(crate) alignments: Vec<Alignment>,
    pub(crate) centrelines: Vec<Centreline>,
}

/// The outline between two corners.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    /// Points from corner to corner, both included.
    pub(crate) nodes: Vec<usize>,
    pub(crate) across: SideUse,
}

/// Edges that are divided into the same number of parts.
#[derive(Clone, Debug)]
pub(crate) struct Divide {
    pub(crate) edges: Vec<[usize; 2]>,
    pub(crate) length: f64,
    pub(crate) min: usize,
    /// How much of the triangle at a slanted end is added to the end part's
    /// width: 0 keeps all parts equal, 1 adds half of the triangle's base.
    pub(crate) wide_ends: f64,
    /// Range of the factor by which all ideal parts together may follow the
    /// length that there is.
    pub(crate) adapt: [f64; 2],
}

/// Points on a circle; edges between successive ones are arcs of it.
#[derive(Clone, Debug)]
pub(crate) struct ArcRun {
    pub(crate) points: Vec<usize>,
    pub(crate) centre: P,
}

/// A polygonal subregion.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub(crate) label: String,
    /// Ring, counter-clockwise.
    pub(crate) points: Vec<usize>,
    /// Templates that may replace the face.
    pub(crate) child: Vec<String>,
    /// The points that go to the corners of the child, its first side first.
    pub(crate) corners: Vec<usize>,
    pub(crate) class: Arc<dyn Deformation>,
    pub(crate) tolerance: f64,
    pub(crate) access_exempt: bool,
}

impl Face {
    /// Faces with children are cut along dividing lines only for the warp.
    pub(crate) fn is_area(&self) -> bool {
        !self.child.is_empty()
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Alignment {
    pub(crate) kind: AlignKind,
    pub(crate) points: Vec<usize>,
}

#[derive(Clone, Debug)]
pub(crate) struct Centreline {
    pub(crate) points: Vec<usize>,
    pub(crate) face: usize,
}

impl Template {
    /// Name, unique in its library.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Region label: the template fits regions with the same one.
    #[must_use]
    pub fn label(&self) -> &str {
        &self.label
    }

    /// The designer's weight among templates that fit equally well.
    #[must_use]
    pub fn probability(&self) -> f64 {
        self.probability
    }

    /// Whether the mirror image may be used too.
    #[must_use]
    pub fn mirrors(&self) -> bool {
        self.mirror
    }

    /// Number of corners of the outline.
    #[must_use]
    pub fn corner_count(&self) -> usize {
        self.sides.len()
    }

    /// What must lie across each side, from the first corner on.
    pub fn sides(&self) -> impl Iterator<Item = SideUse> + '_ {
        self.sides.iter().map(|s| s.across)
    }

    /// Area of the drawing, square metres.
    #[must_use]
    pub fn area(&self) -> f64 {
        signed_area(&self.outline())
    }

    /// The outline as drawn, counter-clockwise, from its first corner.
    #[must_use]
    pub fn outline(&self) -> Vec<P> {
        self.sides
            .iter()
            .flat_map(|s| s.nodes[..s.nodes.len() - 1].iter())
            .map(|&i| self.points[i])
            .collect()
    }

    /// The rings of the faces as drawn, with their labels.
    pub fn faces(&self) -> impl Iterator<Item = (&str, Vec<P>)> + '_ {
        self.faces.iter().map(|f| {
            (
                f.label.as_str(),
                f.points.iter().map(|&i| self.points[i]).collect(),
            )
        })
    }

    /// Reads, checks and sizes a template.
    pub(crate) fn build(spec: &Spec, sizes: &Sizes) -> Result<Self, WarpError> {
        let bad = |problem: String| WarpError::BadTemplate {
            template: spec.name.clone(),
            problem,
        };
        let names: BTreeMap<&str, usize> = spec
            .points
            .keys()
            .enumerate()
            .map(|(i, k)| (k.as_str(), i))
            .collect();
        let points: Vec<P> = spec
            .points
            .values()
            .map(|c| P {
                x: c[0].metres(sizes),
                y: c[1].metres(sizes),
            })
            .collect();
        let find = |name: &String| {
            names
                .get(name.as_str())
                .copied()
                .ok_or_else(|| bad(format!("there is no point `{name}`; add it to `points`")))
        };
        let list = |names: &[String]| names.iter().map(find).collect::<Result<Vec<usize>, _>>();

        if !(spec.probability > 0.0 && spec.probability.is_finite()) {
            return Err(bad(format!(
                "the probability is {}; give a positive number",
                spec.probability
            )));
        }
        let mut outline = list(&spec.outline)?;
        let ring: Vec<P> = outline.iter().map(|&i| points[i]).collect();
        if outline.len() < 3 || !exceeds(signed_area(&ring), 0.0) {
            return Err(bad(
                "the outline must be counter-clockwise with at least 3 points".into(),
            ));
        }
        if let Some((i, j)) = self_contact(&ring) {
            return Err(bad(format!("edges {i} and {j} of the outline cross")));
        }
        let n = ring.len();
        let turn_at = |i: usize| turn(ring[i] - ring[(i + n - 1) % n], ring[(i + 1) % n] - ring[i]);
        let mut is_corner: Vec<bool> = (0..n)
            .map(|i| turn_at(i).abs() >= CORNER_DEG.to_radians())
            .collect();
        for (name, &kind) in &spec.corners {
            let at = find(name)?;
            let i = outline
                .iter()
                .position(|&o| o == at)
                .ok_or_else(|| bad(format!("corner `{name}` is not on the outline")))?;
            is_corner[i] = kind != CornerSpec::Regular;
            let wrong = (kind == CornerSpec::Convex && turn_at(i) <= 0.0)
                || (kind == CornerSpec::Concave && turn_at(i) >= 0.0);
            if wrong {
                return Err(bad(format!(
                    "`{name}` turns the other way than `corners` says"
                )));
            }
        }
        let first = is_corner
            .iter()
            .position(|&c| c)
            .ok_or_else(|| bad("the outline has no corner".into()))?;
        outline.rotate_left(first);
        is_corner.rotate_left(first);
        let mut sides: Vec<Side> = Vec::new();
        let mut turns = Vec::new();
        for i in 0..n {
            if is_corner[i] {
                turns.push(turn_at((i + first) % n));
                let across = spec.sides.get(sides.len()).copied().unwrap_or(SideUse::Any);
                sides.push(Side {
                    nodes: vec![outline[i]],
                    across,
                });
            }
            if let Some(side) = sides.last_mut() {
                side.nodes.push(outline[(i + 1) % n]);
            }
        }
        if sides.len() != spec.sides.len() {
            return Err(bad(format!(
                "the outline has {} corners but `sides` has {} uses",
                sides.len(),
                spec.sides.len()
            )));
        }
        if sides.len() < 3 || spec.symmetry == 0 || !sides.len().is_multiple_of(spec.symmetry) {
            return Err(bad(
                "at least 3 corners are needed, and `symmetry` must divide their number".into(),
            ));
        }

        let mut faces = Vec::new();
        for (k, f) in spec.face.iter().enumerate() {
            let ring = list(&f.points)?;
            let corners: Vec<P> = ring.iter().map(|&i| points[i]).collect();
            if ring.len() < 3 || !exceeds(signed_area(&corners), 0.0) {
                return Err(bad(format!(
                    "face {k} must be counter-clockwise with at least 3 points"
                )));
            }
            if !(f.tolerance > 0.0 && f.tolerance.is_finite()) {
                return Err(bad(format!(
                    "face {k} has tolerance {}; give a positive number",
                    f.tolerance
                )));
            }
            let child_corners = if f.corners.is_empty() {
                ring.clone()
            } else {
                list(&f.corners)?
            };
            if child_corners.len() < 3 {
                return Err(bad(format!("face {k}: `corners` needs at least 3 points")));
            }
            if child_corners.iter().any(|c| !ring.contains(c)) {
                return Err(bad(format!(
                    "face {k}: `corners` must be points of the face"
                )));
            }
            faces.push(Face {
                label: f.label.clone(),
                points: ring,
                child: f.child.clone(),
                corners: child_corners,
                class: class(&f.class).map_err(|p| bad(format!("face {k}: {p}")))?,
                tolerance: f.tolerance,
                access_exempt: f.access_exempt,
            });
        }
        let covered: f64 = faces
            .iter()
            .map(|f: &Face| signed_area(&f.points.iter().map(|&i| points[i]).collect::<Vec<_>>()))
            .sum();
        let whole = signed_area(&ring);
        // Arcs bulge across chords, equally much on both sides; chords tile.
        if (covered - whole).abs() > 1e-6 * whole {
            return Err(bad(format!(
                "the faces cover {covered:.2} m2 of the outline's {whole:.2} m2"
            )));
        }

        let mut divides = Vec::new();
        for d in &spec.divide {
            let length = d.length.metres(sizes);
            if !exceeds(length, 0.0) || d.edges.is_empty() {
                return Err(bad("a `divide` needs edges and a positive length".into()));
            }
            let edges = d
                .edges
                .iter()
                .map(|e| Ok([find(&e[0])?, find(&e[1])?]))
                .collect::<Result<Vec<_>, WarpError>>()?;
            let is_edge = |e: &[usize; 2]| {
                faces.iter().any(|f: &Face| {
                    let n = f.points.len();
                    (0..n).any(|i| {
                        let (a, b) = (f.points[i], f.points[(i + 1) % n]);
                        [a, b] == *e || [b, a] == *e
                    })
                })
            };
            if !edges.iter().all(is_edge) {
                return Err(bad("a `divide` names an edge that no face has".into()));
            }
            if !(0.0..=4.0).contains(&d.wide_ends) {
                return Err(bad(format!("`wide_ends` is {}; give 0 to 4", d.wide_ends)));
            }
            divides.push(Divide {
                edges,
                length,
                min: d.min.max(1),
                wide_ends: d.wide_ends,
                adapt: range(d.adapt).map_err(|p| bad(format!("`adapt`: {p}")))?,
            });
        }
        let elastic = spec
            .elastic
            .iter()
            .map(|e| Ok([find(&e[0])?, find(&e[1])?]))
            .collect::<Result<Vec<_>, WarpError>>()?;
        let arcs = spec
            .arc
            .iter()
            .map(|a| {
                let centre = P {
                    x: a.centre[0].metres(sizes),
                    y: a.centre[1].metres(sizes),
                };
                Ok(ArcRun {
                    points: list(&a.points)?,
                    centre,
                })
            })
            .collect::<Result<Vec<_>, WarpError>>()?;
        let alignments = spec
            .align
            .iter()
            .map(|a| {
                Ok(Alignment {
                    kind: a.kind,
                    points: list(&a.points)?,
                })
            })
            .collect::<Result<Vec<_>, WarpError>>()?;
        let mut centrelines = Vec::new();
        for c in &spec.centreline {
            if c.face >= faces.len() || c.points.len() < 2 {
                return Err(bad(
                    "a `centreline` needs two points and the number of a face".into(),
                ));
            }
            centrelines.push(Centreline {
                points: list(&c.points)?,
                face: c.face,
            });
        }
        Ok(Self {
            name: spec.name.clone(),
            label: spec.label.clone(),
            probability: spec.probability,
            mirror: spec.mirror,
            symmetry: spec.symmetry,
            depth: spec.depth.map(|d| [d[0].metres(sizes), d[1].metres(sizes)]),
            points,
            sides,
            turns,
            divides,
            elastic,
            arcs,
            faces,
            alignments,
            centrelines,
        })
    }

    /// The mirror image, x to -x; the first side stays first.
    pub(crate) fn mirrored(&self) -> Self {
        let mut m = self.clone();
        let flip = |q: &mut P| q.x = -q.x;
        m.points.iter_mut().for_each(flip);
        m.arcs.iter_mut().for_each(|a| flip(&mut a.centre));
        m.sides.reverse();
        for side in &mut m.sides {
            side.nodes.reverse();
        }
        m.sides.rotate_right(1);
        // Side 0 keeps its place, so the corners at its ends change roles.
        m.turns.reverse();
        let k = m.turns.len().saturating_sub(2);
        m.turns.rotate_left(k);
        for face in &mut m.faces {
            face.points.reverse();
            face.corners.reverse();
            let k = 2 % face.corners.len();
            face.corners.rotate_right(k);
        }
        m
    }
}

/// A range of scales, checked.
fn range(r: [f64; 2]) -> Result<[f64; 2], String> {
    if r[0] > 0.0 && r[0] <= r[1] && r[1].is_finite() {
        Ok(r)
    } else {
        Err(format!(
            "[{}, {}] is no range of scales; give two positive numbers in order",
            r[0], r[1]
        ))
    }
}

fn class(spec: &ClassSpec) -> Result<Arc<dyn Deformation>, String> {
    Ok(match *spec {
        ClassSpec::Rigid => Arc::new(Rigid),
        ClassSpec::Similarity(r) => {
            let [min_scale, max_scale] = range(r)?;
            Arc::new(Similarity {
                min_scale,
                max_scale,
            })
        }
        ClassSpec::Principal { x, y } => Arc::new(PrincipalAffine {
            x: range(x)?,
            y: range(y)?,
        }),
        ClassSpec::Area(max_area_ratio) if max_area_ratio >= 1.0 => {
            Arc::new(AreaAffine { max_area_ratio })
        }
        ClassSpec::Area(r) => return Err(format!("area ratio {r} is below 1")),
    })
}
