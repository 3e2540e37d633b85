//! What a worker does in a sweep, as a sampler may ask.

use finegrain_framework::Activity;

/// Part of a sweep over all pairs. While one is under way, a sampler
/// ([`finegrain_framework::Activities::sample`]) sees its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum SweepPart {
    /// Particles around a sub-domain are collected into records.
    Collect = 1,
    /// Those near a cell, then those near a particle, are searched for.
    Search,
    /// Records of a particle's neighbours are gathered into lanes.
    Gather,
    /// The kernel is evaluated for them.
    Kernel,
    /// Terms are summed up.
    Terms,
}

impl SweepPart {
    /// All of them, in the order in which a sweep comes to them.
    pub const ALL: [Self; 5] =
        [Self::Collect, Self::Search, Self::Gather, Self::Kernel, Self::Terms];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Collect => "collect",
            Self::Search => "search",
            Self::Gather => "gather",
            Self::Kernel => "kernel",
            Self::Terms => "terms",
        }
    }

    /// Says that it begins.
    #[inline(always)]
    pub(crate) fn begin(self, activity: &Activity) {
        activity.begin(self as u8);
    }
}
