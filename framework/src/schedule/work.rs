//! What a schedule runs.

use std::ops::Range;

use crate::domain::Partition;
use crate::pack::Fence;

/// Work cut into parts and sub-domains: all that a schedule knows.
pub(crate) trait Work: Sync {
    /// Number of parts of a step.
    fn parts(&self) -> usize;
    /// Ownership and neighbourhood.
    fn partition(&self) -> &Partition;
    /// Numbers of the steps to run.
    fn steps(&self) -> Range<u64>;
    /// What is run may be written past the caches until this goes out of scope: on the thread that runs it, and before
    /// anybody else is told that it has been run.
    fn fence(&self) -> Fence;
    /// Runs one part of one step of one sub-domain; never unwinds.
    fn run(&self, worker: usize, fence: &Fence, step: u64, part: usize, sub_domain: usize);
    /// Whether something failed, so that the rest need not be run.
    fn failed(&self) -> bool;
}
