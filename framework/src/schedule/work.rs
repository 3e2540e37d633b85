//! What a schedule runs.

use std::ops::Range;

use crate::domain::Partition;

/// Work cut into parts and sub-domains: all that a schedule knows.
pub(crate) trait Work: Sync {
    /// Number of parts of a step.
    fn parts(&self) -> usize;
    /// Ownership and neighbourhood.
    fn partition(&self) -> &Partition;
    /// Numbers of the steps to run.
    fn steps(&self) -> Range<u64>;
    /// Runs one part of one step of one sub-domain; never unwinds.
    fn run(&self, worker: usize, step: u64, part: usize, sub_domain: usize);
    /// Whether something failed, so that the rest need not be run.
    fn failed(&self) -> bool;
}
