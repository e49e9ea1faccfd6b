//! Which of a number of chords is the nearest that runs alongside?

use crate::vector::{cross, dot, norm, Point};

/// Cosine of 45 degrees: below it two lines cross rather than run alongside.
const ALONGSIDE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Cosine of 60 degrees: what may come alongside before the next look.
const SOON: f64 = 0.5;
/// Cosine of 75 degrees, and of the 15 degrees by which a line may turn until
/// what came within 75 degrees of it comes within 60.
pub(super) const LATER: f64 = 0.2588;
pub(super) const TURN: f64 = 0.966;
/// Ends the list of a cell.
pub(super) const END: u32 = u32::MAX;

/// A stretch of a line, replaced by its chord.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chord {
    pub(super) middle: Point,
    /// Unit vector, or zero for a chord that is hidden.
    pub(super) along: Point,
    pub(super) half: f64,
    /// Arc length of the middle from the line's seed, negative behind it.
    pub(super) arc: f64,
    /// Which line.
    pub(super) line: u32,
    /// The chord before it in its cell.
    pub(super) next: u32,
    /// Which family that line was started in.
    family: u8,
}

impl Chord {
    /// `None` if the two points are the same.
    pub(super) fn new(a: Point, b: Point, line: u32, family: u8, arc: f64) -> Option<Self> {
        let length = norm(b - a);
        (length > 0.0).then(|| Self {
            middle: (a + b) / 2.0,
            along: (b - a) / length,
            half: 0.5 * length,
            arc,
            line,
            next: END,
            family,
        })
    }

    /// Squared distance from `p`, and the signed distance along the chord of
    /// the perpendicular's foot from its middle.
    fn offset(&self, p: Point) -> (f64, f64) {
        let off = p - self.middle;
        let foot = dot(off, self.along);
        let beyond = (foot.abs() - self.half).max(0.0);
        let aside = cross(self.along, off);
        (aside * aside + beyond * beyond, foot)
    }
}

/// What a line that is being traced needs to recognise its own chords.
#[derive(Clone, Copy, Debug)]
pub(super) struct Own {
    pub(super) line: u32,
    /// Arc length at the point in question.
    pub(super) arc: f64,
    /// Own chords nearer than this along the line are neighbours, not
    /// approaches.
    pub(super) gap: f64,
}

/// The nearest chord that runs alongside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) distance: f64,
    /// Its line is the one that asks.
    pub(super) own: bool,
    /// The family that its line was started in.
    pub(super) family: u8,
}

/// The nearest of a number of chords.
pub(super) struct Search {
    p: Point,
    along: Point,
    own: Option<Own>,
    min_cosine: f64,
    /// Square of the distance within which a chord would be the nearest so far.
    pub(super) limit: f64,
    best: Option<(bool, u8)>,
}

impl Search {
    /// Within `reach` of `p`, among those that run within 45 degrees of the unit
    /// vector `along`; between 45 and 60 degrees too if `soon`. Of an own chord
    /// only what `p` is abreast of counts, so that a closing loop may come up
    /// to its seed from behind.
    pub(super) fn new(p: Point, along: Point, reach: f64, own: Option<Own>, soon: bool) -> Self {
        Self {
            p,
            along,
            own,
            min_cosine: if soon { SOON } else { ALONGSIDE },
            limit: reach * reach,
            best: None,
        }
    }

    #[inline]
    pub(super) fn look(&mut self, chord: &Chord) {
        if dot(chord.along, self.along).abs() <= self.min_cosine {
            return;
        }
        let (square, foot) = chord.offset(self.p);
        if square >= self.limit {
            return;
        }
        let mut is_own = false;
        if let Some(own) = self.own.filter(|own| own.line == chord.line) {
            if (own.arc - chord.arc).abs() < own.gap + chord.half || foot.abs() > chord.half {
                return;
            }
            is_own = true;
        }
        self.limit = square;
        self.best = Some((is_own, chord.family));
    }

    pub(super) fn nearest(self) -> Option<Nearest> {
        self.best.map(|(own, family)| Nearest {
            distance: self.limit.sqrt(),
            own,
            family,
        })
    }
}

/// The chords near a line's head, gathered once for a stretch of it.
#[derive(Debug, Default)]
pub(super) struct Vicinity {
    pub(super) chords: Vec<Chord>,
    pub(super) centre: Point,
    pub(super) along: Point,
    /// How far from the centre looks are answered; none at first.
    pub(super) radius: f64,
}

impl Vicinity {
    /// Whether looks from `p` along the unit vector `along` are answered, for
    /// the reach and the line that it was gathered for.
    pub(super) fn serves(&self, p: Point, along: Point) -> bool {
        let off = p - self.centre;
        dot(off, off) <= self.radius * self.radius && dot(along, self.along).abs() >= TURN
    }

    /// The nearest chord within `reach` of `p`, as [`Search`] has it.
    pub(super) fn nearest(
        &self,
        p: Point,
        along: Point,
        reach: f64,
        own: Own,
        soon: bool,
    ) -> Option<Nearest> {
        let mut search = Search::new(p, along, reach, Some(own), soon);
        for chord in &self.chords {
            search.look(chord);
        }
        search.nearest()
    }
}
