//! The one place that is not checked by the compiler: HiGHS calls back through
//! a C function pointer.

use std::ffi::{c_char, c_int, c_void};
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use highs::{HighsStatus, Model, SolvedModel};
use highs_sys::{
    kHighsCallbackCallbackMipUserSolution, kHighsCallbackIpmInterrupt,
    kHighsCallbackMipImprovingSolution, kHighsCallbackMipInterrupt, kHighsCallbackSimplexInterrupt,
    HighsCallbackDataIn, HighsCallbackDataOut, Highs_setCallback, Highs_setCallbackSolution,
    Highs_startCallback, STATUS_OK,
};

/// What HiGHS's thread tells the one that waits for it, and is told by it.
#[derive(Debug)]
pub(super) struct Shared {
    stop: AtomicBool,
    told: Mutex<Told>,
    ended: Condvar,
}

#[derive(Debug)]
struct Told {
    best: Option<Vec<f64>>,
    objective: f64,
    version: u64,
    bound: f64,
    done: bool,
    /// A solution from elsewhere that HiGHS has not seen yet.
    suggested: Option<Vec<f64>>,
}

/// What HiGHS has told so far.
#[derive(Debug)]
pub(super) struct News {
    pub(super) best: Option<Vec<f64>>,
    pub(super) objective: f64,
    pub(super) improved: bool,
    pub(super) version: u64,
    pub(super) bound: f64,
}

impl Default for Shared {
    fn default() -> Self {
        Self {
            stop: AtomicBool::new(false),
            told: Mutex::new(Told {
                best: None,
                objective: f64::INFINITY,
                version: 0,
                bound: f64::NEG_INFINITY,
                done: false,
                suggested: None,
            }),
            ended: Condvar::new(),
        }
    }
}

impl Shared {
    /// Asks HiGHS to stop.
    pub(super) fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// Hands HiGHS a solution that was found elsewhere.
    pub(super) fn suggest(&self, values: Vec<f64>) {
        self.told().suggested = Some(values);
    }

    /// HiGHS has answered.
    pub(super) fn done(&self) {
        self.told().done = true;
        self.ended.notify_all();
    }

    /// Waits for that, but no longer than `most`.
    pub(super) fn wait(&self, most: Duration) -> bool {
        let waited = self
            .ended
            .wait_timeout_while(self.told(), most, |told| !told.done);
        let (told, _) = waited.unwrap_or_else(PoisonError::into_inner);
        told.done
    }

    /// The best solution and bound so far; `seen` is the version of the last
    /// news.
    pub(super) fn news(&self, seen: u64) -> News {
        let told = self.told();
        News {
            best: told.best.clone(),
            objective: told.objective,
            improved: told.version > seen,
            version: told.version,
            bound: told.bound,
        }
    }

    /// The best bound so far.
    pub(super) fn bound(&self) -> f64 {
        self.told().bound
    }

    /// Nothing in here panics while it holds the lock, and all states are sound.
    fn told(&self) -> MutexGuard<'_, Told> {
        self.told.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Runs HiGHS, which tells `shared` of solutions and bounds and asks it whether
/// to stop.
///
/// # Errors
///
/// What HiGHS answers instead of [`HighsStatus::OK`].
#[allow(
    unsafe_code,
    reason = "HiGHS takes its callback as a C function pointer with a pointer to what it may use"
)]
pub(super) fn run_shared(mut model: Model, shared: &Shared) -> Result<SolvedModel, HighsStatus> {
    let highs = model.as_mut_ptr();
    let data = std::ptr::from_ref(shared).cast_mut().cast::<c_void>();
    // SAFETY: `highs` is the live solver that `model` owns: it is freed only
    // when `model`, or the `SolvedModel` that it becomes, is dropped.
    // `on_event` has the type that HiGHS declares. HiGHS keeps `data` and hands
    // it to `on_event` during `Highs_run` only, that is within `try_solve`
    // below, while `shared` is borrowed: where that fails the solver is dropped
    // in there, and where it succeeds the callback is taken away again before
    // the borrow ends. `on_event` only reads through `data`, and `Shared` is
    // `Sync` (checked below), so any thread of HiGHS may call it.
    let set = unsafe { Highs_setCallback(highs, Some(on_event), data) };
    if set != STATUS_OK {
        return Err(HighsStatus::Error);
    }
    for event in [
        kHighsCallbackMipImprovingSolution,
        kHighsCallbackMipInterrupt,
        kHighsCallbackSimplexInterrupt,
        kHighsCallbackIpmInterrupt,
        kHighsCallbackCallbackMipUserSolution,
    ] {
        // SAFETY: the same live solver, which owns no reference to Rust's data
        // but the one above; `event` is one of HiGHS's own constants.
        if unsafe { Highs_startCallback(highs, event) } != STATUS_OK {
            return Err(HighsStatus::Error);
        }
    }
    let mut solved = model.try_solve()?;
    // SAFETY: the same solver, live as long as `solved`. Without a function it
    // calls nothing, and keeps no pointer to `shared`.
    let cleared = unsafe { Highs_setCallback(solved.as_mut_ptr(), None, std::ptr::null_mut()) };
    debug_assert_eq!(cleared, STATUS_OK, "a callback can be taken away");
    Ok(solved)
}

const _: () = {
    const fn is_sync<T: Sync>() {}
    is_sync::<Shared>();
};

/// Called by HiGHS on its events.
#[allow(
    unsafe_code,
    reason = "what HiGHS hands over are raw pointers into its own memory"
)]
unsafe extern "C" fn on_event(
    event: c_int,
    _message: *const c_char,
    out: *const HighsCallbackDataOut,
    back: *mut HighsCallbackDataIn,
    data: *mut c_void,
) {
    // No panic may cross into C++; a solver that fails to report goes on.
    let _: Result<(), _> = catch_unwind(AssertUnwindSafe(|| {
        // SAFETY: `data` is what `run_shared` gave, a `Shared` that is borrowed
        // until HiGHS has returned; `out` is null or points to what HiGHS holds
        // for the time of this call, and nobody writes to it meanwhile.
        let (shared, out) = unsafe { (data.cast::<Shared>().as_ref(), out.as_ref()) };
        let (Some(shared), Some(out)) = (shared, out) else {
            return;
        };
        if event == kHighsCallbackMipImprovingSolution {
            let len = usize::try_from(out.mip_solution_size).unwrap_or(0);
            if !out.mip_solution.is_null() && len > 0 {
                // SAFETY: HiGHS says that `mip_solution` points to that many
                // numbers, its own for the time of this call.
                let values = unsafe { std::slice::from_raw_parts(out.mip_solution, len) };
                let mut told = shared.told();
                if out.objective_function_value < told.objective {
                    told.best = Some(values.to_vec());
                    told.objective = out.objective_function_value;
                    told.version += 1;
                }
            }
        }
        if event == kHighsCallbackMipInterrupt || event == kHighsCallbackMipImprovingSolution {
            let mut told = shared.told();
            if out.mip_dual_bound > told.bound && out.mip_dual_bound.is_finite() {
                told.bound = out.mip_dual_bound;
            }
        }
        if event == kHighsCallbackCallbackMipUserSolution {
            // Here HiGHS asks for solutions, and does not expect to be stopped.
            let suggested = shared.told().suggested.take();
            if let (Some(values), false) = (suggested, back.is_null()) {
                if let Ok(len) = i32::try_from(values.len()) {
                    // SAFETY: `back` is not null, so what HiGHS holds for this
                    // call; it checks and copies `len` numbers, which `values`
                    // has, before it returns, and refuses another length.
                    unsafe { Highs_setCallbackSolution(back, len, values.as_ptr()) };
                }
            }
            return;
        }
        // SAFETY: `back` is null or points to what HiGHS holds for this call,
        // and only this function writes to it.
        if let (Some(back), true) = (
            unsafe { back.as_mut() },
            shared.stop.load(Ordering::Relaxed),
        ) {
            back.user_interrupt = 1;
        }
    }));
}
