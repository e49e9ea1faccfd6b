//! The same function on many items, side by side, the results in the items'
//! order: what is asked for does not depend on who works it out.

/// `f` of each item, on `threads` threads (0: one a core).
#[cfg(feature = "rayon")]
pub(crate) fn map<T: Sync, R: Send>(
    items: &[T],
    threads: usize,
    f: impl Fn(&T) -> R + Sync + Send,
) -> Vec<R> {
    use rayon::prelude::*;
    if threads == 1 {
        return items.iter().map(f).collect();
    }
    if threads > 1 {
        // Where the system gives no threads of our own, the shared ones do.
        if let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
            return pool.install(|| items.par_iter().map(&f).collect());
        }
    }
    items.par_iter().map(f).collect()
}

/// `f` of each item.
#[cfg(not(feature = "rayon"))]
pub(crate) fn map<T: Sync, R: Send>(
    items: &[T],
    _threads: usize,
    f: impl Fn(&T) -> R + Sync + Send,
) -> Vec<R> {
    items.iter().map(f).collect()
}
