//! Room cuts: what rooms, their doors and connectivity say together.
//!
//! The border of a room that is placed has an active edge. For a placement R let
//! B_R be the ends of its border's edges. For a face f and a set B of vertices,
//! none a sink, let R(f, B) be the sum of the columns R of the placements that
//! hold f and have B_R within B. One of the placements that hold f is placed,
//! and no two are, so R(f, B) is 0 or 1; and if it is 1, there is an active edge
//! with both ends in B. So, with delta(B) the edges with one end in B, E(B)
//! those with both, and p the parents of [`parents`](super::parents),
//!
//! p(out of B) >= R(f, B),   (24)
//!
//! and, where dead ends are forbidden and every cycle that may be active
//! throughout has g edges at least,
//!
//! (g - 1) x(delta(B)) + x(E(B)) >= (2 g - 1) R(f, B).   (25)
//!
//! *Proof of (25).* Let R(f, B) be 1, and C the component of that active edge in
//! the graph of the active edges within B. C reaches a sink, which is outside B,
//! so one active edge at least leaves C, and it is in delta(B), else it were in
//! C. If C contains a cycle, that has g edges in E(B): (g - 1) + g. Else C is a
//! tree with an edge, so with two leaves at least; each has two active edges at
//! least, one of them in C, so one in delta(B), and these are two, because an
//! edge of delta(B) has one end in B: 2 (g - 1) + 1. []
//!
//! Without cycles g is as large as one likes: x(delta(B)) >= 2 R(f, B).
//!
//! **Face balls** are the case that B holds the borders of all placements that
//! hold f: R(f, B) is 1, whatever the fractions of rooms are. On a grid with
//! rooms of up to 3 by 3 squares that is a square of 6 by 6 vertices, which
//! parallel corridors as far apart as the rooms allow do not miss; so they are
//! to floorplans what ball cuts are to streets. They are written down for the
//! sets that hold no other. For the rest [`RoomBalls::separate`] takes, for each
//! face, the rooms of a fractional solution one after the other, the largest
//! fraction first, and cuts with the union of their B_R that is violated most.
//!
//! Bounds of the relaxation, before / with face balls / with all of them, and
//! the best that is known: floor of 10 x 10 squares 11.8 / 20.0 / 22.4 of 26, of
//! 16 x 15 squares 24.8 / 45.3 / 49.8 of 62 and 23.8 / 41.5 / 45.7 of 54; with
//! dead ends allowed 11.8 / 17.7 / 19.7 of 20 and 24.8 / 41.1 / 44.1 of 54.

use std::collections::BTreeSet;

use super::cycles::least_cycle;
use super::draft::{Draft, Term};
use super::parents::Parents;
use crate::mip::Row;

/// What room cuts are made of.
#[derive(Clone, Debug)]
pub(super) struct RoomBalls {
    /// B_R of each placement, ascending; none if that holds a sink or cannot be
    /// placed.
    balls: Vec<Option<Vec<usize>>>,
    /// The placements of each face that may be placed.
    holding: Vec<Vec<usize>>,
    /// Each placement, and each edge.
    r: Vec<Term>,
    x: Vec<Term>,
    ends: Vec<[usize; 2]>,
    around: Vec<Vec<(usize, usize)>>,
    /// The factors of (25) of edges that leave, of those within, and of rooms;
    /// none where dead ends are allowed.
    factors: Option<[f64; 3]>,
    parents: Parents,
}

/// Which of the two rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    /// (24).
    Parents,
    /// (25).
    Edges,
}

impl RoomBalls {
    /// Adds the face balls to a program whose rooms are `r`; `holding` has the
    /// placements of each face.
    pub(super) fn add(
        draft: &mut Draft<'_>,
        r: &[Term],
        holding: &[Vec<usize>],
        parents: Parents,
    ) -> Self {
        let problem = draft.problem;
        let placements = problem.rooms.iter().flat_map(|rooms| &rooms.placements);
        let balls = placements.zip(r).map(|(placement, &r)| {
            let border = placement.border.iter().filter(|&&e| draft.possible(e));
            let ball: BTreeSet<usize> = border.flat_map(|&e| problem.ends[e]).collect();
            let free = r != Term::Off && ball.iter().all(|&v| !problem.sinks[v]);
            free.then(|| ball.into_iter().collect())
        });
        let factors = (!problem.dead_ends).then(|| match least_cycle(draft) {
            Some(g) => [g as f64 - 1.0, 1.0, 2.0 * g as f64 - 1.0],
            None => [1.0, 0.0, 2.0],
        });
        let this = Self {
            balls: balls.collect(),
            holding: holding.to_vec(),
            r: r.to_vec(),
            x: draft.x.clone(),
            ends: problem.ends.clone(),
            around: draft.around.clone(),
            factors,
            parents,
        };
        for (f, ball) in this.face_balls() {
            for kind in this.kinds() {
                let (terms, low) = this.terms(kind, f, &ball);
                draft.row(low, f64::INFINITY, terms);
            }
        }
        this
    }

    /// The sets of the face balls, each with a face, without sets that hold
    /// another and those of faces that may have a room at a sink.
    fn face_balls(&self) -> Vec<(usize, BTreeSet<usize>)> {
        let mut sets: Vec<(usize, BTreeSet<usize>)> = Vec::new();
        for (f, placements) in self.holding.iter().enumerate() {
            let balls = placements.iter().map(|&k| self.balls[k].as_ref());
            let union: Option<Vec<&Vec<usize>>> = balls.collect();
            if let Some(balls) = union.filter(|balls| !balls.is_empty()) {
                sets.push((f, balls.into_iter().flatten().copied().collect()));
            }
        }
        sets.sort_by_key(|(f, set)| (set.len(), *f));
        let mut kept: Vec<(usize, BTreeSet<usize>)> = Vec::new();
        for (f, set) in sets {
            if !kept.iter().any(|(_, smaller)| smaller.is_subset(&set)) {
                kept.push((f, set));
            }
        }
        kept
    }

    fn kinds(&self) -> impl Iterator<Item = Kind> {
        let edges = self.factors.map(|_| Kind::Edges);
        [Kind::Parents].into_iter().chain(edges)
    }

    /// The left hand side of a row, and what multiplies the rooms.
    fn left(&self, kind: Kind, ball: &BTreeSet<usize>) -> (Vec<(Term, f64)>, f64) {
        let [leaving, within, rooms] = match (kind, self.factors) {
            (Kind::Edges, Some(factors)) => factors,
            _ => [1.0, 0.0, 1.0],
        };
        let mut terms = Vec::new();
        for &v in ball {
            for &(e, w) in &self.around[v] {
                let inside = ball.contains(&w);
                match kind {
                    Kind::Parents if !inside => {
                        let end = usize::from(self.ends[e][1] == v);
                        let column = self.parents.column(e, end).map(Term::Column);
                        terms.push((column.unwrap_or(Term::Off), leaving));
                    }
                    Kind::Edges if !inside => terms.push((self.x[e], leaving)),
                    // Seen from both ends, counted once.
                    Kind::Edges if v < w => terms.push((self.x[e], within)),
                    _ => {}
                }
            }
        }
        (terms, rooms)
    }

    /// A row, with its rooms on the left hand side and what is left on the
    /// right: where the set holds all that hold the face, their sum is 1.
    fn terms(&self, kind: Kind, face: usize, ball: &BTreeSet<usize>) -> (Vec<(Term, f64)>, f64) {
        let (mut terms, rooms) = self.left(kind, ball);
        let inside = self.inside(face, ball);
        if inside.len() == self.holding[face].len() {
            return (terms, rooms);
        }
        terms.extend(inside.iter().map(|&k| (self.r[k], -rooms)));
        (terms, 0.0)
    }

    /// The placements that hold a face and have their border in a set.
    fn inside(&self, face: usize, ball: &BTreeSet<usize>) -> Vec<usize> {
        let placements = self.holding[face].iter().copied();
        let inside = placements.filter(|&k| {
            let own = self.balls[k].as_ref();
            own.is_some_and(|own| own.iter().all(|v| ball.contains(v)))
        });
        inside.collect()
    }

    /// Rows (24) and (25) that a fractional solution violates by over
    /// `tolerance` rooms, at most one of each for each face.
    pub(super) fn separate(&self, values: &[f64], tolerance: f64) -> Vec<Row> {
        let value = |term: Term| match term {
            Term::Off => 0.0,
            Term::On => 1.0,
            Term::Column(column) => values[column],
        };
        let mut rows: Vec<Row> = Vec::new();
        for (f, placements) in self.holding.iter().enumerate() {
            let used = placements.iter().copied();
            let mut used: Vec<usize> = used
                .filter(|&k| value(self.r[k]) > 1e-6 && self.balls[k].is_some())
                .collect();
            used.sort_by(|&a, &b| {
                let parts = value(self.r[b]).total_cmp(&value(self.r[a]));
                parts.then(a.cmp(&b))
            });
            let mut ball = BTreeSet::new();
            let mut best: Vec<(f64, Kind, BTreeSet<usize>)> = Vec::new();
            for &k in &used {
                let before = ball.len();
                ball.extend(self.balls[k].iter().flatten().copied());
                if ball.len() == before && k != used[0] {
                    continue;
                }
                let inside = self.inside(f, &ball);
                let part: f64 = if inside.len() == placements.len() {
                    1.0
                } else {
                    inside.iter().map(|&k| value(self.r[k])).sum()
                };
                for kind in self.kinds() {
                    let (terms, rooms) = self.left(kind, &ball);
                    let sum: f64 = terms.iter().map(|&(t, factor)| factor * value(t)).sum();
                    let lacks = part - sum / rooms;
                    let known = best.iter_mut().find(|(_, other, _)| *other == kind);
                    match known {
                        Some(known) if lacks > known.0 => *known = (lacks, kind, ball.clone()),
                        None if lacks > tolerance => best.push((lacks, kind, ball.clone())),
                        _ => {}
                    }
                }
            }
            for (_, kind, ball) in best {
                let row = plain(self.terms(kind, f, &ball));
                if !rows.contains(&row) {
                    rows.push(row);
                }
            }
        }
        rows
    }
}

/// A row of columns.
fn plain((terms, mut low): (Vec<(Term, f64)>, f64)) -> Row {
    let mut columns = Vec::new();
    for (term, factor) in terms {
        match term {
            Term::Off => {}
            Term::On => low -= factor,
            Term::Column(column) => columns.push((column, factor)),
        }
    }
    columns.sort_unstable_by_key(|&(column, _)| column);
    Row {
        terms: columns,
        low,
        high: f64::INFINITY,
    }
}
