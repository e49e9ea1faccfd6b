//! Where windows lie.

use std::cmp::Reverse;
use std::collections::VecDeque;

use crate::design::Problem;

/// The edges nearest to a vertex, about `size` of them open.
pub(super) fn window(problem: &Problem, centre: usize, size: usize, open: &[bool]) -> Vec<bool> {
    let around = problem.around();
    let mut free = vec![false; problem.edges()];
    let mut seen = vec![false; problem.vertices];
    let mut queue = VecDeque::from([centre]);
    seen[centre] = true;
    let mut count = 0;
    while let Some(v) = queue.pop_front() {
        if count >= size {
            break;
        }
        for &(e, w) in &around[v] {
            if !free[e] {
                free[e] = true;
                count += usize::from(open[e]);
            }
            if !seen[w] {
                seen[w] = true;
                queue.push_back(w);
            }
        }
    }
    if size >= open.iter().filter(|&&open| open).count() {
        free.fill(true);
    }
    free
}

/// All vertices, `first` and then each far from those before it, so that consecutive
/// windows lie apart and the first few cover all.
pub(super) fn far_apart(problem: &Problem, first: usize) -> Vec<usize> {
    let around = problem.around();
    let mut nearest = vec![usize::MAX; problem.vertices];
    let mut order = Vec::with_capacity(problem.vertices);
    let mut chosen = vec![false; problem.vertices];
    let mut next = (first < problem.vertices).then_some(first);
    while let Some(v) = next {
        chosen[v] = true;
        order.push(v);
        let mut queue = VecDeque::from([v]);
        nearest[v] = 0;
        while let Some(v) = queue.pop_front() {
            for &(_, w) in &around[v] {
                if nearest[v] + 1 < nearest[w] {
                    nearest[w] = nearest[v] + 1;
                    queue.push_back(w);
                }
            }
        }
        let left = (0..problem.vertices).filter(|&v| !chosen[v]);
        next = left.max_by_key(|&v| (nearest[v], Reverse(v)));
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::window::tests::ladder;

    #[test]
    fn windows_are_local_and_centres_far_apart() {
        let problem = ladder(8);
        let open = vec![true; problem.edges()];
        let free = window(&problem, 0, 5, &open);
        let far: Vec<usize> = (0..problem.edges()).filter(|&e| free[e]).collect();
        assert!(far.iter().all(|&e| problem.ends[e].iter().all(|&v| v < 8)));
        assert_eq!(far_apart(&problem, 0)[..2], [0, 17]);
        assert_eq!(window(&problem, 3, 25, &open), vec![true; 25]);
    }
}
