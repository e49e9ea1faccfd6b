//! A network as snakes.

use geo_types::Coord;

use crate::design::Tessellation;

/// A run of active edges, without a vertex twice but for a ring's first.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Snake {
    /// Its vertices, in order; a ring ends with its first.
    pub vertices: Vec<usize>,
    /// The edges between them.
    pub edges: Vec<usize>,
}

impl Snake {
    /// Whether it comes back to its first vertex.
    #[must_use]
    pub fn is_ring(&self) -> bool {
        self.vertices.len() > 2 && self.vertices.first() == self.vertices.last()
    }
}

/// Decomposes the active edges into snakes that run on through crossings: at
/// each vertex the two edges that go on most nearly in line belong to one
/// snake, then the next two, as long as they turn by less than `max_turn`
/// radians; where only two edges meet they do whatever they turn by. Each
/// active edge is in one snake.
///
/// A snake that would meet itself is cut there.
///
/// ```
/// use network_opt::design::Tessellation;
/// use network_opt::geo_types::coord;
/// use network_opt::snake::snakes;
///
/// // Four squares around a crossing.
/// let points = (0..9).map(|k| coord! { x: f64::from(k % 3), y: f64::from(k / 3) }).collect();
/// let faces = [0, 1, 3, 4].map(|a| vec![a, a + 1, a + 4, a + 3]).to_vec();
/// let mesh = Tessellation::new(points, faces)?;
/// let cross: Vec<bool> = mesh.edges().iter().map(|ends| ends.contains(&4)).collect();
/// let found = snakes(&mesh, &cross, 0.8);
/// assert_eq!(found.len(), 2);
/// assert!(found.iter().all(|snake| snake.vertices[1] == 4));
/// # Ok::<(), network_opt::DesignError>(())
/// ```
#[must_use]
pub fn snakes(mesh: &Tessellation, active: &[bool], max_turn: f64) -> Vec<Snake> {
    let is_active = |e: usize| active.get(e).copied().unwrap_or(false);
    let partner = partners(mesh, &is_active, max_turn);
    let mut used = vec![false; mesh.edges().len()];
    let mut found = Vec::new();
    // From the ends of snakes first, so that what is left are rings.
    let ends = (0..mesh.edges().len()).flat_map(|e| mesh.edges()[e].map(|v| (e, v)));
    let open: Vec<(usize, usize)> = ends
        .filter(|&(e, v)| is_active(e) && partner(e, v).is_none())
        .collect();
    let rings = (0..mesh.edges().len())
        .filter(|&e| is_active(e))
        .map(|e| (e, mesh.edges()[e][0]));
    for (e, v) in open.into_iter().chain(rings.collect::<Vec<_>>()) {
        if !used[e] {
            walk(mesh, (e, v), &partner, &mut used, &mut found);
        }
    }
    found
}

/// Which edge goes on from an edge at one of its ends.
fn partners(
    mesh: &Tessellation,
    is_active: &impl Fn(usize) -> bool,
    max_turn: f64,
) -> impl Fn(usize, usize) -> Option<usize> {
    let mut on: Vec<Vec<(usize, usize)>> = vec![Vec::new(); mesh.points().len()];
    for (v, on) in on.iter_mut().enumerate() {
        let here: Vec<(usize, usize)> = mesh
            .around(v)
            .iter()
            .copied()
            .filter(|&(e, _)| is_active(e))
            .collect();
        if let [(a, _), (b, _)] = here.as_slice() {
            on.push((*a, *b));
            continue;
        }
        let mut pairs = Vec::new();
        for (i, &(a, from)) in here.iter().enumerate() {
            for &(b, to) in &here[i + 1..] {
                let turn = turn(mesh.points()[from], mesh.points()[v], mesh.points()[to]);
                if turn < max_turn {
                    pairs.push((turn, a, b));
                }
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, a, b) in pairs {
            if !on
                .iter()
                .any(|&(c, d)| [c, d].contains(&a) || [c, d].contains(&b))
            {
                on.push((a, b));
            }
        }
    }
    move |e, v| {
        on[v].iter().find_map(|&(a, b)| match e {
            e if e == a => Some(b),
            e if e == b => Some(a),
            _ => None,
        })
    }
}

/// By how much a way from `a` over `b` to `c` turns, radians.
fn turn(a: Coord<f64>, b: Coord<f64>, c: Coord<f64>) -> f64 {
    let (u, v) = (b - a, c - b);
    (u.x * v.y - u.y * v.x).atan2(u.x * v.x + u.y * v.y).abs()
}

/// The snake that starts with edge `e` at its end `v`; cut where it meets
/// itself.
fn walk(
    mesh: &Tessellation,
    (first, start): (usize, usize),
    partner: &impl Fn(usize, usize) -> Option<usize>,
    used: &mut [bool],
    found: &mut Vec<Snake>,
) {
    let mut snake = Snake {
        vertices: vec![start],
        edges: Vec::new(),
    };
    let (mut edge, mut at) = (first, start);
    loop {
        used[edge] = true;
        let [a, b] = mesh.edges()[edge];
        at = if at == a { b } else { a };
        let met = snake.vertices.iter().position(|&v| v == at);
        snake.vertices.push(at);
        snake.edges.push(edge);
        if let Some(k) = met {
            // A ring of its own, and what led to it.
            let ring = Snake {
                vertices: snake.vertices.split_off(k),
                edges: snake.edges.split_off(k),
            };
            snake.vertices.push(ring.vertices[0]);
            found.push(ring);
            if !snake.edges.is_empty() {
                found.push(std::mem::replace(
                    &mut snake,
                    Snake {
                        vertices: Vec::new(),
                        edges: Vec::new(),
                    },
                ));
            }
            snake.vertices = vec![at];
            snake.edges.clear();
        }
        match partner(edge, at).filter(|&next| !used[next]) {
            Some(next) => edge = next,
            None => break,
        }
    }
    if !snake.edges.is_empty() {
        found.push(snake);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All edges of a grid: its lines, and each once.
    #[test]
    fn a_grid_is_its_lines() {
        let mesh = Tessellation::grid(3, 3);
        let found = snakes(&mesh, &vec![true; mesh.edges().len()], 0.8);
        let mut edges: Vec<usize> = found.iter().flat_map(|s| s.edges.clone()).collect();
        edges.sort_unstable();
        assert_eq!(edges, (0..24).collect::<Vec<_>>());
        // Two and two lines inside; at the four corners of the rim only two
        // edges meet, so that the rim is one ring.
        assert_eq!(found.len(), 5);
        assert_eq!(found.iter().filter(|s| s.is_ring()).count(), 1);
        for snake in &found {
            assert_eq!(snake.vertices.len(), snake.edges.len() + 1);
            for (k, &e) in snake.edges.iter().enumerate() {
                let mut ends = [snake.vertices[k], snake.vertices[k + 1]];
                ends.sort_unstable();
                assert_eq!(mesh.edges()[e], ends);
            }
        }
    }

    /// A stair is one snake, however it turns; a T ends the one that meets the
    /// other.
    #[test]
    fn stairs_go_on_and_ts_end() {
        let mesh = Tessellation::grid(3, 3);
        let on = |pairs: &[(usize, usize)]| {
            let mut active = vec![false; mesh.edges().len()];
            for &(a, b) in pairs {
                active[mesh.edge_between(a, b).expect("an edge")] = true;
            }
            active
        };
        let stair = on(&[(0, 1), (1, 5), (5, 6), (6, 10), (10, 11)]);
        assert_eq!(snakes(&mesh, &stair, 0.8).len(), 1);
        let tee = on(&[(4, 5), (5, 6), (6, 7), (5, 9)]);
        let found = snakes(&mesh, &tee, 0.8);
        assert_eq!(found.len(), 2);
        assert_eq!(found.iter().map(|s| s.edges.len()).max(), Some(3));
        assert!(snakes(&mesh, &[], 0.8).is_empty());
    }
}
