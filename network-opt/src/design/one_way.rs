//! Which streets are to be one-way, in the designer's words.

use super::problem::EdgeState;
use super::tessellation::Tessellation;
use super::ways::Way;
use crate::error::DesignError;

/// Which streets are one-way, besides those that
/// [`one_way_runs`](super::Specification::one_way_runs) names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum OneWay {
    /// None: traffic runs both ways.
    #[default]
    None,
    /// All that the network adds to those that exist: narrow local streets, say.
    /// Which way each runs is chosen with the network.
    New,
    /// Existing ones too, such as a boundary that becomes a ring road, but for
    /// those whose direction is known from a level above.
    All,
}

/// The entries of [`Problem::ways`](super::Problem::ways); none if all streets
/// are two-way.
pub(super) fn ways(
    mode: OneWay,
    runs: &[Vec<usize>],
    mesh: &Tessellation,
    states: &[EdgeState],
) -> Result<Vec<Way>, DesignError> {
    let bad = |what: String| Err(DesignError::BadProblem { what });
    if mode == OneWay::None && runs.is_empty() {
        return Ok(Vec::new());
    }
    let mut ways: Vec<Way> = (states.iter())
        .map(|&state| match mode {
            OneWay::None => Way::Both,
            OneWay::New if state == EdgeState::Given => Way::Both,
            OneWay::New | OneWay::All => Way::Either,
        })
        .collect();
    let mut named = vec![false; states.len()];
    for (r, run) in runs.iter().enumerate() {
        for pair in run.windows(2) {
            let Some(e) = mesh.edge_between(pair[0], pair[1]) else {
                return bad(format!(
                    "one-way run {r} jumps from vertex {} to {}, which no edge joins",
                    pair[0], pair[1]
                ));
            };
            let way = if mesh.edges()[e][0] == pair[0] {
                Way::Forward
            } else {
                Way::Backward
            };
            if named[e] && ways[e] != way {
                return bad(format!(
                    "one-way run {r} runs from vertex {} to {}, and another run the other way; \
                     a street with traffic both ways is in none",
                    pair[0], pair[1]
                ));
            }
            named[e] = true;
            ways[e] = way;
        }
    }
    Ok(ways)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::{verify, Rim, Specification};
    use crate::solve::{Limits, NetworkSolver, Search};

    #[test]
    fn modes_and_runs_say_which_streets_are_one_way() {
        let mesh = Tessellation::grid(4, 4);
        let on = |one_way, one_way_runs| Specification {
            one_way,
            one_way_runs,
            ..Specification::default()
        };
        let plain = on(OneWay::None, vec![]).on(&mesh).expect("fits");
        assert!(plain.ways.is_empty());
        let new = on(OneWay::New, vec![vec![6, 7, 8], vec![16, 11]]);
        let problem = new.on(&mesh).expect("fits");
        for e in 0..problem.edges() {
            let expected = match problem.ends[e] {
                [6, 7] | [7, 8] => Way::Forward,
                [11, 16] => Way::Backward,
                _ if problem.is_given(e) => Way::Both,
                _ => Way::Either,
            };
            assert_eq!(problem.way(e), expected);
        }
        let all = on(OneWay::All, vec![vec![0, 1]]).on(&mesh).expect("fits");
        let both = all.ways.iter().filter(|&&way| way == Way::Both).count();
        let forward = all.ways.iter().filter(|&&way| way == Way::Forward).count();
        assert_eq!((both, forward), (0, 1));
        for (runs, word) in [
            (vec![vec![0, 6]], "jumps"),
            (vec![vec![0, 99]], "named"),
            (vec![vec![0, 1, 0]], "other way"),
        ] {
            let error = on(OneWay::None, runs).on(&mesh).expect_err("bad");
            assert!(error.to_string().contains(word), "{error}");
        }
    }

    /// On a grid with one-way streets the search has a network in a moment.
    #[test]
    fn one_way_grids_have_networks() {
        let search = Search { moves: Some(3000) };
        let limits = Limits {
            deadline: None,
            ..Limits::default()
        };
        for rim in [Rim::Given, Rim::Open] {
            let spec = Specification {
                one_way: OneWay::All,
                rim,
                travel: 0.1,
                ..Specification::default()
            };
            let problem = spec.on(&Tessellation::grid(8, 8)).expect("fits");
            let found = search.solve(&problem, None, &limits, &mut |_| true);
            let network = found.expect("solved").network.expect("found");
            assert_eq!(verify(&problem, &network), []);
        }
    }
}
