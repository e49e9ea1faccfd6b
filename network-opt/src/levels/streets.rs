//! The streets of finished levels, smoothed together.

use geo_types::LineString;

use super::Level;
use crate::design::{distances, distances_from, mean_way, Network, Streets, Way};
use crate::error::DesignError;
use crate::snake::{smooth_snakes, snakes, Snake, SnakeOptions};

/// A street of a finished network.
#[derive(Clone, Debug, PartialEq)]
pub struct Street {
    /// The level that it belongs to, from 0.
    pub level: usize,
    /// Where it runs; a one-way street in its direction.
    pub line: LineString<f64>,
    /// For each piece between two points of the line the way from there to a
    /// sink of its level, in metres along edges of the mesh; over streets of
    /// another speed in metres of its own that take as long. With one-way streets
    /// the mean of that and of the way from a sink.
    pub away: Vec<f64>,
    /// Whether traffic runs over it one way only.
    pub one_way: bool,
}

/// The streets of all levels, smoothed together on the finest mesh, so that
/// they meet where they met; no street runs on into one of another level, nor
/// one-way streets into others or against each other. Sinks that lie alone are
/// pinned, for a street is to end there; where a whole street is sink its ends
/// may slide.
///
/// # Errors
///
/// Those of [`smooth_snakes`].
pub fn streets(levels: &[Level], options: &SnakeOptions) -> Result<Vec<Street>, DesignError> {
    let found: Vec<&Level> = levels
        .iter()
        .filter(|level| level.outcome.network.is_some())
        .collect();
    let Some(last) = found.last() else {
        return Ok(Vec::new());
    };
    let mut all: Vec<(usize, Snake)> = Vec::new();
    let mut away = vec![0.0; last.mesh.edges().len()];
    let mut ways = vec![Way::Both; last.mesh.edges().len()];
    for (index, level) in found.iter().enumerate() {
        let mut own = level.own();
        let mut way = nearer(level);
        let mut runs = directions(level);
        for _ in index + 1..found.len() {
            (own, way, runs) = (halved(&own), halved(&way), halved(&runs));
        }
        own.resize(last.mesh.edges().len(), false);
        for (e, &on) in own.iter().enumerate() {
            if on {
                away[e] = way[e];
                ways[e] = runs[e];
            }
        }
        let snakes = snakes(&last.mesh, &own, options.through_deg.to_radians());
        all.extend(snakes.into_iter().map(|snake| (index, snake)));
    }
    // What was given from the start stays; on a finer mesh its halves.
    let mut given: Vec<bool> = (0..found[0].problem.edges())
        .map(|e| found[0].problem.is_given(e))
        .collect();
    for _ in 1..found.len() {
        given = halved(&given);
    }
    given.resize(last.mesh.edges().len(), false);
    let (of, snakes): (Vec<usize>, Vec<Snake>) = all.into_iter().unzip();
    let mut options = options.clone();
    options
        .pinned
        .extend(found.iter().flat_map(|l| lone_sinks(l)));
    let smooth = smooth_snakes(&last.mesh, snakes, &given, &options)?;
    let streets = smooth.streets.into_iter().zip(of);
    Ok(streets
        .flat_map(|((snake, line), level)| {
            let runs: Vec<Way> = (snake.edges.iter().zip(&snake.vertices))
                .map(|(&e, &v)| {
                    if last.mesh.edges()[e][0] == v {
                        ways[e]
                    } else {
                        ways[e].reversed()
                    }
                })
                .collect();
            let away: Vec<f64> = snake.edges.iter().map(|&e| away[e]).collect();
            cut(&line, &runs, &away, options.pieces, level)
        })
        .collect())
}

/// Sinks of a level without a sink beside them, those placed included; vertices
/// keep their numbers on finer meshes.
fn lone_sinks(level: &Level) -> Vec<usize> {
    let mut sinks = level.problem.sinks.clone();
    let placed = level.outcome.network.iter().flat_map(|n| &n.sinks);
    placed.for_each(|&v| sinks[v] = true);
    let lone = |&v: &usize| !level.mesh.around(v).iter().any(|&(_, w)| sinks[w]);
    (0..sinks.len())
        .filter(|&v| sinks[v])
        .filter(lone)
        .collect()
}

/// A snake's line as streets, cut where traffic begins to run another way: `runs`
/// and `away` are of its edges, of so many pieces each.
fn cut(
    line: &LineString<f64>,
    runs: &[Way],
    away: &[f64],
    pieces: usize,
    level: usize,
) -> Vec<Street> {
    let mut streets = Vec::new();
    let mut from = 0;
    while from < runs.len() {
        let way = runs[from];
        let same = runs[from..].iter().take_while(|&&w| w == way).count();
        let to = from + same;
        let mut points = line.0[from * pieces..=to * pieces].to_vec();
        let mut away: Vec<f64> = away[from..to]
            .iter()
            .flat_map(|&metres| std::iter::repeat_n(metres, pieces))
            .collect();
        if way == Way::Backward {
            points.reverse();
            away.reverse();
        }
        streets.push(Street {
            level,
            line: points.into(),
            away,
            one_way: way != Way::Both,
        });
        from = to;
    }
    streets
}

/// A list by edge, for the halves of edges on the refined mesh; its edges within
/// faces are not in it.
fn halved<T: Copy>(list: &[T]) -> Vec<T> {
    list.iter().flat_map(|&value| [value, value]).collect()
}

/// Which way traffic runs over each edge.
fn directions(level: &Level) -> Vec<Way> {
    let empty = Network::default();
    let streets = Streets::from(level.outcome.network.as_ref().unwrap_or(&empty));
    (0..level.problem.edges())
        .map(|e| streets.way(&level.problem, e))
        .collect()
}

/// The travel of each edge of a level, metres: its way to a sink of the level,
/// with one-way streets the mean of that and the way from one.
fn nearer(level: &Level) -> Vec<f64> {
    let Some(network) = &level.outcome.network else {
        return vec![f64::INFINITY; level.problem.edges()];
    };
    let unit = level.metres();
    let settled = level.problem.settled(&network.sinks);
    let to = distances(&settled, network);
    let from = distances_from(&settled, network);
    let ends = level.problem.ends.iter().zip(directions(level));
    ends.map(|(&ends, way)| unit * mean_way(ends, way, &to, &from))
        .collect()
}
