//! Windows that slide over the mesh.

use std::time::Duration;

use super::super::record::Record;
use super::super::{Ended, Limits};
use super::places::{far_apart, window};
use super::Windows;
use crate::design::{Cost, Network};
use crate::dice::Dice;
use crate::error::DesignError;
use crate::formulate::{longest_ways, prepare, Cuts, Fate, Formulated, Formulation};
use crate::mip::{MipOutcome, MipReply, MipSolver, MipStatus, Program};

/// What windows are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Goal {
    /// The best there is in a window.
    Cheaper,
    /// A network that costs less by a step, or a ten-thousandth, without travel: in
    /// length, patterns, routes and wishes; or a proof that there is none.
    Shorter,
}

impl Goal {
    /// How much larger the first windows are than [`Windows::size`].
    fn factor(self) -> f64 {
        match self {
            Self::Cheaper => 1.0,
            Self::Shorter => 1.75,
        }
    }

    /// Windows without success after which larger ones are tried, for each that would
    /// lie side by side with others. Four times as many overlap well; of those for
    /// length one in forty may find something where all others find nothing.
    fn tries(self) -> usize {
        match self {
            Self::Cheaper => 4,
            Self::Shorter => 16,
        }
    }

    /// The most edges of a window, of so many in all. Of half of 544 edges it takes HiGHS
    /// four seconds and more to tell whether a network can be shorter.
    fn most(self, all: usize) -> usize {
        match self {
            Self::Cheaper => all.max(1),
            Self::Shorter => all / 2,
        }
    }
}

/// Networks that were shorter and, with what they travel, no better, after which
/// there are no more windows for length.
const REFUSED: usize = 3;

/// Windows of one kind.
pub(super) struct Slide<'s, 'p, M> {
    windows: &'s Windows<M>,
    goal: Goal,
    formulated: Formulated<'p>,
    /// Whether each edge is to be decided.
    open: Vec<bool>,
    /// How many are.
    all: usize,
    /// Of the first windows.
    size: usize,
    /// Where windows lie.
    centres: Vec<usize>,
}

impl<'s, 'p, M: MipSolver> Slide<'s, 'p, M> {
    /// The program of windows; none if the first would be too large.
    pub(super) fn new(
        windows: &'s Windows<M>,
        goal: Goal,
        limits: &Limits,
        record: &Record<'p, '_>,
    ) -> Result<Option<Self>, DesignError> {
        let problem = record.problem;
        let open: Vec<bool> = prepare(problem).iter().map(|f| *f == Fate::Open).collect();
        let all = open.iter().filter(|&&open| open).count();
        let size = (windows.size as f64 * goal.factor()).ceil() as usize;
        let size = size.clamp(1, all.max(1));
        if size > goal.most(all) {
            return Ok(None);
        }
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
        let first = Dice::new(limits.seed).below(problem.vertices.max(1));
        Ok(Some(Self {
            windows,
            goal,
            formulated: Formulated::with_cuts(problem, formulation, longest, cuts)?,
            open,
            all,
            size,
            centres: far_apart(problem, first),
        }))
    }

    /// Slides windows until the time is over, the watch says no, or a window
    /// holds all edges; those for length alone until they would hold more than half
    /// of them, shorter networks are no better, or it is known that there are none.
    pub(super) fn run(
        &self,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<Ended, DesignError> {
        let mut size = self.size;
        // Windows since the last improvement, at this size.
        let mut idle = 0;
        let mut refused = 0;
        for &centre in self.centres.iter().cycle() {
            let Some((network, before)) = record.best.clone() else {
                break;
            };
            let is_done = self.goal == Goal::Shorter && (refused > REFUSED || record.is_shortest());
            if record.is_late(limits) || is_done || size > self.goal.most(self.all) {
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
            let found = self.look(&program, &network, &limits, record)?;
            if record.cancelled {
                return Ok(Ended::Cancelled);
            }
            let best = record.best.as_ref();
            let is_better = best.is_some_and(|(_, cost)| cost.objective < before.objective - 1e-9);
            refused += usize::from(found.solution.is_some() && !is_better);
            idle = if is_better { 0 } else { idle + 1 };
            if idle > self.goal.tries() * self.all.div_ceil(size) {
                size = (size + (size / 2).max(1)).min(self.all);
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
            program.refute(length - program.step().max(1e-4 * length.abs()));
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
        let found = self.look(program, network, &limits, record)?;
        // A flow does not price travel, so it proves nothing of it.
        let prices = self.formulated.formulation() != Formulation::Flow
            || record.problem.travel_weight == 0.0;
        if prices && found.status == MipStatus::Optimal {
            record.raise(program.rounded(found.bound));
            return Ok(Ended::Proven);
        }
        Ok(match record.cancelled {
            true => Ended::Cancelled,
            false => Ended::Deadline,
        })
    }

    /// Solves the program of a window. What is found is offered to the record, and the
    /// watch is asked once at least.
    fn look(
        &self,
        program: &Program,
        network: &Network,
        limits: &Limits,
        record: &mut Record<'_, '_>,
    ) -> Result<MipOutcome, DesignError> {
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
        let received = record.receive();
        let offered = (found.solution.as_ref())
            .is_some_and(|values| record.offer(formulated.network(values)));
        // Solvers that are soon through ask no watch.
        record.report(received || offered);
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;
    use crate::design::{EdgeState, Problem};
    use crate::mip::{Microlp, MipWatch, Row};
    use crate::solve::pool::Pool;
    use crate::solve::window::tests::ladder;
    use crate::solve::{NetworkSolver, Progress, Watch};

    /// Keeps what it is asked, and answers what Microlp does, or what it is told to.
    #[derive(Default)]
    struct Spy<'a> {
        told: Option<Option<&'a [f64]>>,
        asked: Mutex<Vec<Asked>>,
    }

    /// Whether a program is to be refuted and has a start, and its last row.
    struct Asked {
        refuted: bool,
        started: bool,
        last: Option<Row>,
    }

    impl Spy<'_> {
        fn asked(&self) -> Vec<Asked> {
            std::mem::take(&mut *self.asked.lock().expect("whole"))
        }
    }

    impl MipSolver for &Spy<'_> {
        fn name(&self) -> &'static str {
            "spy"
        }

        fn solve(
            &self,
            program: &Program,
            start: Option<&[f64]>,
            limits: &Limits,
            watch: &mut MipWatch<'_>,
        ) -> Result<MipOutcome, DesignError> {
            self.asked.lock().expect("whole").push(Asked {
                refuted: program.is_refuted(),
                started: start.is_some(),
                last: program.rows().last().cloned(),
            });
            let Some(solution) = self.told else {
                return Microlp.solve(program, start, limits, watch);
            };
            let status = match solution {
                Some(_) => MipStatus::Optimal,
                None => MipStatus::Infeasible,
            };
            Ok(MipOutcome {
                status,
                solution: solution.map(<[f64]>::to_vec),
                objective: f64::INFINITY,
                bound: f64::INFINITY,
            })
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
            let slide = Slide::new(&windows, Goal::Shorter, &limits, &record)
                .expect("a program")
                .expect("small");
            let ended = slide.run(&limits, &mut record).expect("no failure");
            assert_eq!(ended, Ended::Deadline, "half of the edges prove nothing");
            let (_, cost) = record.best.expect("still there");
            (windows, cost.without_travel(&problem))
        };
        // Of seven edges side by side a few can go, whatever the others are.
        assert!(best < 25.0 && lengths.last() == Some(&best), "{lengths:?}");
        let steps = [25.0].into_iter().chain(lengths.iter().copied());
        let falls: Vec<f64> = steps.zip(&lengths).map(|(a, b)| a - b).collect();
        assert!(falls.iter().all(|&fall| fall > 1.0 - 1e-9), "{lengths:?}");
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
        let spy = Spy::default();
        let windows = windows(&spy);
        let slide = || {
            let mut watch = |_: &Progress<'_>| true;
            let mut record =
                Record::begin(&problem, Some(&one_side), &mut watch, Some(&pool)).expect("whole");
            let limits = Limits::default();
            let slide = Slide::new(&windows, Goal::Shorter, &limits, &record)
                .expect("a program")
                .expect("small");
            assert_eq!(slide.run(&limits, &mut record), Ok(Ended::Deadline));
            spy.asked().len()
        };
        assert!(slide() > 0);
        pool.settle(7.0);
        assert!(slide() > 0);
        pool.settle(8.0);
        assert_eq!(slide(), 0);
    }

    /// How windows for length end from a network, and what they ask.
    fn answered(
        problem: &Problem,
        start: &Network,
        solution: Option<&[f64]>,
        watch: &mut Watch<'_>,
    ) -> (Ended, Vec<Asked>) {
        let spy = Spy {
            told: Some(solution),
            ..Spy::default()
        };
        let windows = windows(&spy);
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        let mut record = Record::begin(problem, Some(start), watch, None).expect("whole");
        let slide = Slide::new(&windows, Goal::Shorter, &limits, &record)
            .expect("a program")
            .expect("small");
        let ended = slide.run(&limits, &mut record).expect("no failure");
        (ended, spy.asked())
    }

    #[test]
    fn windows_for_length_end_where_shorter_is_no_better() {
        // The same network again and again is no better than itself.
        let (problem, all) = all_of_a_ladder(0.001);
        let formulated = Formulated::with_cuts(&problem, Formulation::Flow, None, Cuts::none())
            .expect("a program");
        let solution = formulated.solution(&all);
        let (ended, asked) = answered(&problem, &all, Some(&solution), &mut |_| true);
        assert_eq!((ended, asked.len()), (Ended::Deadline, REFUSED + 1));
    }

    #[test]
    fn the_watch_is_asked_after_each_window() {
        let (problem, all) = all_of_a_ladder(0.001);
        let mut left = 3;
        let mut watch = |_: &Progress<'_>| {
            left -= 1;
            left > 0
        };
        let (ended, asked) = answered(&problem, &all, None, &mut watch);
        assert_eq!((ended, asked.len()), (Ended::Cancelled, 3));
    }

    #[test]
    fn without_steps_shorter_is_a_ten_thousandth() {
        let (problem, all) = all_of_a_ladder(0.001);
        let lengths: Vec<f64> = (0..problem.edges())
            .map(|e| (e as f64 + 2.0).sqrt())
            .collect();
        let sum: f64 = lengths.iter().sum();
        let less = sum * (1.0 - 1e-4);
        // A level lets pass a hundredth of a step, or a millionth.
        for (lengths, high) in [
            (vec![1.0; problem.edges()], 24.01),
            (lengths, less * (1.0 + 1e-6)),
        ] {
            let problem = Problem {
                lengths,
                ..problem.clone()
            };
            let (_, asked) = answered(&problem, &all, None, &mut |_| true);
            let level = asked[0].last.as_ref().expect("a level");
            assert!(
                (level.high - high).abs() < 1e-9,
                "{} for {high}",
                level.high
            );
        }
    }

    #[test]
    fn windows_grow_from_any_size_and_close_what_has_nothing_open() {
        let (problem, all) = all_of_a_ladder(0.001);
        let solved = |problem: &Problem, size: usize| {
            let windows = Windows {
                size,
                ..Windows::new(Microlp)
            };
            let limits = Limits {
                deadline: None,
                ..Limits::default()
            };
            let found = windows.solve(problem, Some(&all), &limits, &mut |_| true);
            let found = found.expect("solved");
            (found.ended, found.cost.without_travel(problem))
        };
        assert_eq!(solved(&problem, 0), (Ended::Proven, 8.0));
        let given = Problem {
            states: vec![EdgeState::Required; problem.edges()],
            ..problem.clone()
        };
        assert_eq!(solved(&given, 4), (Ended::Proven, 25.0));
    }

    #[test]
    fn only_where_travel_breaks_ties_windows_are_for_length_first() {
        let asked_with = |weight: f64, formulation: Formulation| {
            let (problem, all) = all_of_a_ladder(weight);
            let spy = Spy::default();
            let windows = Windows {
                formulation,
                ..windows(&spy)
            };
            windows
                .solve(&problem, Some(&all), &Limits::default(), &mut |_| true)
                .expect("solved");
            let asked = spy.asked().into_iter();
            asked
                .map(|ask| (ask.refuted, ask.started))
                .collect::<Vec<_>>()
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
