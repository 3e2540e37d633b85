//! Every interleaving of a few workers, by loom: no wake-up is lost, nobody leaves a meeting early,
//! every part runs once and after what it depends on, and no two workers touch the same memory
//! without one having happened before the other.
//!
//! ```text
//! RUSTFLAGS="--cfg loom" cargo test -p finegrain-framework --release --lib model_checks
//! ```
//!
//! About a minute on two cores. Use a target directory of its own (`--target-dir`): the flag
//! rebuilds everything. Where all interleavings would take too long, those with at most so many
//! preemptions are checked; loom's authors report that two or three find nearly all errors.
//!
//! What loom is not shown, the columns themselves under real schedules, a race detector sees (nightly Rust with
//! `rust-src`; no reports in `same_bits`, `in_place`, `run_restart`, `neighbours_in_step` and `stage_failures`):
//!
//! ```text
//! RUSTFLAGS=-Zsanitizer=thread cargo +nightly test -Zbuild-std \
//!     --target x86_64-unknown-linux-gnu -p finegrain-framework --test same_bits
//! ```

mod bell;
mod deque;
mod meeting;
mod ready;
mod row;
mod schedules;
mod sequence;
mod team;

/// Checks `model` for all interleavings with at most `preemptions` preemptions; `None` for all.
fn check(preemptions: Option<usize>, model: impl Fn() + Sync + Send + 'static) {
    let mut builder = loom::model::Builder::new();
    if builder.preemption_bound.is_none() {
        builder.preemption_bound = preemptions;
    }
    builder.check(model);
}
