//! The order in which sub-domains are handed out.

/// Order of hand-out. It never changes a result; a random one lets tests show that.
#[derive(Clone, Debug, Default)]
pub enum HandOut {
    /// By number: neighbours in space are handed out near each other in time.
    #[default]
    Natural,
    /// Shuffled anew for every leg, from this seed.
    Shuffled {
        /// Seed of the shuffle.
        seed: u64,
    },
}

impl HandOut {
    /// The order for a leg beginning at `step`.
    pub(crate) fn order(&self, sub_domains: usize, step: u64) -> Order {
        match self {
            Self::Natural => Order(None),
            Self::Shuffled { seed } => {
                let mut random = SplitMix(seed.wrapping_add(step.wrapping_mul(0x9e37_79b9)));
                let mut ids: Vec<u32> = (0..sub_domains as u32).collect();
                for i in (1..ids.len()).rev() {
                    ids.swap(i, (random.next() % (i as u64 + 1)) as usize);
                }
                Order(Some(ids))
            }
        }
    }
}

/// A permutation of the sub-domains, or none.
pub(crate) struct Order(Option<Vec<u32>>);

impl Order {
    /// The sub-domain at place `place`.
    #[inline]
    pub fn at(&self, place: usize) -> usize {
        self.0.as_ref().map_or(place, |ids| ids[place] as usize)
    }
}

/// Steele, Lea & Flood (2014): enough randomness for an order, without a dependency.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}
