//! Windows that slide over the mesh.

use std::time::Duration;

use super::super::record::Record;
use super::super::{Ended, Limits};
use super::places::{far_apart, window};
use super::Windows;
use crate::design::{Cost, Network};
use crate::dice::Dice;
use crate::error::DesignError;
use crate::formulate::{longest_ways, prepare, step, Cuts, Fate, Formulated, Formulation};
use crate::mip::{MipReply, MipSolver, MipStatus, Program};

/// What windows are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// The best there is in a window.
    Cheaper,
    /// A network that costs less without travel, in length, patterns, routes and
    /// wishes, or a proof that there is none.
    Shorter,
}

/// How much larger windows for length alone are than the first of the others.
const LARGER: f64 = 1.75;

/// Windows without success after which larger ones are tried, for each that would
/// lie side by side with others. Four times as many overlap well.
const TRIES: usize = 4;
/// Of those for length alone one in forty may find something where all others find
/// nothing.
const TRIES_FOR_LENGTH: usize = 16;

/// Windows of one kind.
pub(super) struct Slide<'s, 'p, M> {
    windows: &'s Windows<M>,
    goal: Goal,
    formulated: Formulated<'p>,
    /// Whether each edge is to be decided.
    open: Vec<bool>,
    /// How many are.
    all: usize,
    /// Where windows lie.
    centres: Vec<usize>,
}

impl<'s, 'p, M: MipSolver> Slide<'s, 'p, M> {
    /// The program of windows.
    pub(super) fn new(
        windows: &'s Windows<M>,
        goal: Goal,
        limits: &Limits,
        record: &Record<'p, '_>,
    ) -> Result<Self, DesignError> {
        let problem = record.problem;
        let cost = (record.best.as_ref()).map_or(f64::INFINITY, |(_, cost)| cost.objective);
        let longest = (goal == Goal::Cheaper).then(|| longest_ways(problem, cost));
        let formulation = match (goal, windows.formulation) {
            (Goal::Shorter, _) => Formulation::Flow,
            // Distances of vertices outside of a window move with it; flows are
            // linear and their program falls apart where edges are fixed.
            (_, Formulation::Recommended) if problem.travel_weight > 0.0 => Formulation::TravelFlow,
            (_, other) => other,
        };
        // A window is solved whatever its relaxation is worth.
        let cuts = Cuts {
            balls: true,
            ..Cuts::none()
        };
        let open: Vec<bool> = prepare(problem).iter().map(|f| *f == Fate::Open).collect();
        let first = Dice::new(limits.seed).below(problem.vertices.max(1));
        Ok(Self {
            windows,
            goal,
            formulated: Formulated::with_cuts(problem, formulation, longest, cuts)?,
            all: open.iter().filter(|&&open| open).count(),
            open,
            centres: far_apart(problem, first),
        })
    }

    /// Slides windows until the time is over, the watch says no, or a window
    /// holds all edges; those for length alone until they would hold half of them, or
    /// it is known that no network is shorter.
    pub(super) fn run(
        &self,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<Ended, DesignError> {
        let (larger, tries, most) = match self.goal {
            Goal::Cheaper => (1.0, TRIES, self.all),
            Goal::Shorter => (LARGER, TRIES_FOR_LENGTH, self.all / 2),
        };
        let mut size = (self.windows.size as f64 * larger) as usize;
        size = size.clamp(1, self.all.max(1));
        // Windows since the last improvement, at this size.
        let mut idle = 0;
        for &centre in self.centres.iter().cycle() {
            let Some((network, before)) = record.best.clone() else {
                break;
            };
            let is_late = (record.left(limits).deadline).is_some_and(|left| left.is_zero());
            let is_done = self.goal == Goal::Shorter && record.is_shortest();
            if is_late || is_done || size > most {
                break;
            }
            let free = window(record.problem, centre, size, &self.open);
            let program = self.program(&network, &before, &free, record);
            if size >= self.all {
                return self.last(&program, &network, limits, record);
            }
            let left = record.left(limits);
            let time = self.windows.time;
            let limits = Limits {
                deadline: Some(left.deadline.map_or(time, |left| left.min(time))),
                gap: 0.0,
                ..left
            };
            self.look(&program, &network, &limits, record)?;
            if record.cancelled {
                return Ok(Ended::Cancelled);
            }
            let best = record.best.as_ref();
            let is_better = best.is_some_and(|(_, cost)| cost.objective < before.objective - 1e-9);
            idle = if is_better { 0 } else { idle + 1 };
            if idle > tries * self.all.div_ceil(size) {
                size = (size + size / 2).min(self.all);
                idle = 0;
            }
        }
        Ok(Ended::Deadline)
    }

    fn program(
        &self,
        network: &Network,
        cost: &Cost,
        free: &[bool],
        record: &Record<'_, '_>,
    ) -> Program {
        let mut program = self.formulated.window(network, free);
        if self.goal == Goal::Shorter {
            let length = cost.without_travel(record.problem);
            let step = step(record.problem, Formulation::Flow);
            program.refute(length - step.max(1e-4 * length.abs()));
        }
        program
    }

    /// The window that holds all edges.
    fn last(
        &self,
        program: &Program,
        network: &Network,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<Ended, DesignError> {
        let left = record.left(limits);
        let limits = Limits {
            deadline: left.deadline.or(Some(Duration::MAX)),
            ..left
        };
        let (status, bound) = self.look(program, network, &limits, record)?;
        // A flow does not price travel, so it proves nothing of it.
        let prices = self.formulated.formulation() != Formulation::Flow
            || record.problem.travel_weight == 0.0;
        if record.cancelled {
            return Ok(Ended::Cancelled);
        }
        if prices && status == MipStatus::Optimal {
            record.raise(program.rounded(bound));
            return Ok(Ended::Proven);
        }
        Ok(Ended::Deadline)
    }

    /// Solves the program of a window. What is found is offered to the record.
    fn look(
        &self,
        program: &Program,
        network: &Network,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<(MipStatus, f64), DesignError> {
        let formulated = &self.formulated;
        let start = (self.goal == Goal::Cheaper).then(|| formulated.solution(network));
        let solver = &self.windows.solver;
        let found = solver.solve(program, start.as_deref(), limits, &mut |told| {
            let improved = match told.best {
                Some(values) if told.improved => record.offer(formulated.network(values)),
                _ => false,
            };
            match record.report(improved) {
                // That is what was asked for.
                true if improved && self.goal == Goal::Shorter => MipReply::Stop,
                go_on => go_on.into(),
            }
        })?;
        record.receive();
        if let Some(values) = &found.solution {
            if record.offer(formulated.network(values)) {
                record.report(true);
            }
        }
        Ok((found.status, found.bound))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;
    use crate::design::Problem;
    use crate::mip::{Microlp, MipOutcome, MipWatch};
    use crate::solve::pool::Pool;
    use crate::solve::window::tests::ladder;
    use crate::solve::{NetworkSolver, Progress};

    /// Keeps whether programs are to be refuted, and whether they had a start.
    struct Asked(Mutex<Vec<(bool, bool)>>);

    impl MipSolver for &Asked {
        fn name(&self) -> &'static str {
            "asked"
        }

        fn solve(
            &self,
            program: &Program,
            start: Option<&[f64]>,
            limits: &Limits,
            watch: &mut MipWatch<'_>,
        ) -> Result<MipOutcome, DesignError> {
            let asked = (program.is_refuted(), start.is_some());
            self.0.lock().expect("whole").push(asked);
            Microlp.solve(program, start, limits, watch)
        }
    }

    /// A ladder of which travel is worth so much, and all of it.
    fn all_of_a_ladder(travel_weight: f64) -> (Problem, Network) {
        let problem = Problem {
            travel_weight,
            ..ladder(8)
        };
        let network = Network {
            active: vec![true; problem.edges()],
            ..Network::default()
        };
        (problem, network)
    }

    fn windows<M>(solver: M) -> Windows<M> {
        Windows {
            size: 4,
            ..Windows::new(solver)
        }
    }

    #[test]
    fn windows_for_length_shorten_step_by_step_and_end() {
        let (problem, all) = all_of_a_ladder(0.001);
        let mut lengths = Vec::new();
        let mut watch = |progress: &Progress<'_>| {
            if let (true, Some((_, cost))) = (progress.improved, progress.best) {
                lengths.push(cost.without_travel(&problem));
            }
            true
        };
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let (windows, best) = {
            let mut record = Record::begin(&problem, Some(&all), &mut watch, None).expect("whole");
            let windows = windows(Microlp);
            let slide = Slide::new(&windows, Goal::Shorter, &limits, &record).expect("a program");
            let ended = slide.run(&limits, &mut record).expect("no failure");
            assert_eq!(ended, Ended::Deadline, "half of the edges prove nothing");
            let (_, cost) = record.best.expect("still there");
            (windows, cost.without_travel(&problem))
        };
        // Of seven edges side by side a few can go, whatever the others are.
        assert!(best < 25.0 && lengths.last() == Some(&best), "{lengths:?}");
        let steps = [25.0].into_iter().chain(lengths.iter().copied());
        let falls: Vec<f64> = steps.zip(&lengths).map(|(a, b)| a - b).collect();
        assert!(falls.iter().all(|&fall| fall >= 1.0), "{lengths:?}");
        // All of them, travel included: one side of the ladder, and each of its edges
        // but the first travels over those before it.
        let found = windows
            .solve(&problem, Some(&all), &limits, &mut |_| true)
            .expect("solved");
        assert_eq!(found.ended, Ended::Proven);
        assert!((found.cost.objective - 8.028).abs() < 1e-9);
    }

    #[test]
    fn nothing_is_asked_once_no_network_is_shorter() {
        let (problem, _) = all_of_a_ladder(0.001);
        let pool = Pool::default();
        let one_side = Network {
            // Its rungs come first.
            active: (0..problem.edges()).map(|e| e >= 9 && e % 2 == 1).collect(),
            ..Network::default()
        };
        let asked = Asked(Mutex::default());
        let windows = windows(&asked);
        let slide = || {
            let mut watch = |_: &Progress<'_>| true;
            let mut record =
                Record::begin(&problem, Some(&one_side), &mut watch, Some(&pool)).expect("whole");
            let limits = Limits::default();
            let slide = Slide::new(&windows, Goal::Shorter, &limits, &record).expect("a program");
            assert_eq!(slide.run(&limits, &mut record), Ok(Ended::Deadline));
            std::mem::take(&mut *asked.0.lock().expect("whole")).len()
        };
        assert!(slide() > 0);
        pool.settle(7.0);
        assert!(slide() > 0);
        pool.settle(8.0);
        assert_eq!(slide(), 0);
    }

    #[test]
    fn only_where_travel_breaks_ties_windows_are_for_length_first() {
        let asked_with = |weight: f64, formulation: Formulation| {
            let (problem, all) = all_of_a_ladder(weight);
            let asked = Asked(Mutex::default());
            let windows = Windows {
                formulation,
                ..windows(&asked)
            };
            windows
                .solve(&problem, Some(&all), &Limits::default(), &mut |_| true)
                .expect("solved");
            asked.0.into_inner().expect("whole")
        };
        let asked = asked_with(0.001, Formulation::Recommended);
        let first = asked.iter().filter(|&&ask| ask == (true, false)).count();
        assert!(first > 0);
        assert!(asked[first..].iter().all(|&ask| ask == (false, true)));
        for (weight, formulation) in [
            (0.0, Formulation::Recommended),
            (0.5, Formulation::Recommended),
            (0.001, Formulation::TravelFlow),
        ] {
            let asked = asked_with(weight, formulation);
            assert!(asked.iter().all(|&ask| ask == (false, true)));
        }
    }
}
