//! Lists of lists in one piece of memory, and subsets.

/// A list of lists that no longer change.
#[derive(Clone, Debug)]
pub(super) struct Lists<T> {
    starts: Vec<usize>,
    items: Vec<T>,
}

impl<T> Lists<T> {
    pub(super) fn new(lists: Vec<Vec<T>>) -> Self {
        let mut starts = Vec::with_capacity(lists.len() + 1);
        let mut items = Vec::new();
        starts.push(0);
        for list in lists {
            items.extend(list);
            starts.push(items.len());
        }
        Self { starts, items }
    }

    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    pub(super) fn of(&self, k: usize) -> &[T] {
        &self.items[self.starts[k]..self.starts[k + 1]]
    }
}

/// For each of `count` things the lists that name it.
pub(super) fn inverse(lists: &Lists<usize>, count: usize) -> Lists<usize> {
    let mut found = vec![Vec::new(); count];
    for k in 0..lists.len() {
        for &thing in lists.of(k) {
            found[thing].push(k);
        }
    }
    Lists::new(found)
}

/// A subset of the numbers below some count, from which one can be drawn.
#[derive(Clone, Debug)]
pub(super) struct Subset {
    items: Vec<usize>,
    /// Where each number stands among the items.
    places: Vec<usize>,
}

const ABSENT: usize = usize::MAX;

impl Subset {
    pub(super) fn new(count: usize) -> Self {
        Self {
            items: Vec::new(),
            places: vec![ABSENT; count],
        }
    }

    pub(super) fn insert(&mut self, k: usize) {
        if self.places[k] == ABSENT {
            self.places[k] = self.items.len();
            self.items.push(k);
        }
    }

    pub(super) fn remove(&mut self, k: usize) {
        let place = std::mem::replace(&mut self.places[k], ABSENT);
        if place == ABSENT {
            return;
        }
        self.items.swap_remove(place);
        if let Some(&moved) = self.items.get(place) {
            self.places[moved] = place;
        }
    }

    pub(super) fn set(&mut self, k: usize, inside: bool) {
        if inside {
            self.insert(k);
        } else {
            self.remove(k);
        }
    }

    pub(super) fn contains(&self, k: usize) -> bool {
        self.places[k] != ABSENT
    }

    pub(super) fn items(&self) -> &[usize] {
        &self.items
    }

    pub(super) fn len(&self) -> usize {
        self.items.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.items.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dice::Dice;

    #[test]
    fn subsets_keep_what_they_are_told() {
        let mut dice = Dice::new(3);
        let mut subset = Subset::new(20);
        let mut known = std::collections::BTreeSet::new();
        for _ in 0..1000 {
            let (k, inside) = (dice.below(20), dice.chance(0.5));
            subset.set(k, inside);
            if inside {
                known.insert(k);
            } else {
                known.remove(&k);
            }
            let mut items = subset.items().to_vec();
            items.sort_unstable();
            assert!(items.iter().eq(&known));
            assert_eq!(subset.contains(k), inside);
            assert_eq!(
                (subset.len(), subset.is_empty()),
                (known.len(), known.is_empty())
            );
        }
    }

    #[test]
    fn lists_are_turned_around() {
        let lists = Lists::new(vec![vec![0, 2], vec![], vec![2]]);
        assert_eq!(
            (lists.len(), lists.of(0), lists.of(1)),
            (3, &[0, 2][..], &[][..])
        );
        let turned = inverse(&lists, 3);
        assert_eq!(
            (turned.of(0), turned.of(1), turned.of(2)),
            (&[0][..], &[][..], &[0, 2][..])
        );
    }
}
