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

/// A permutation of the sub-domains, in memory that is kept from leg to leg.
#[derive(Default)]
pub(crate) struct Order {
    /// Empty for the natural order.
    ids: Vec<u32>,
}

impl Order {
    /// Becomes the order for a leg beginning at `step`.
    pub fn arrange(&mut self, hand_out: &HandOut, sub_domains: usize, step: u64) {
        self.ids.clear();
        if let HandOut::Shuffled { seed } = hand_out {
            let mut random = SplitMix(seed.wrapping_add(step.wrapping_mul(0x9e37_79b9)));
            self.ids.extend(0..sub_domains as u32);
            for i in (1..sub_domains).rev() {
                self.ids.swap(i, (random.next() % (i as u64 + 1)) as usize);
            }
        }
    }

    /// The sub-domain at place `place`.
    #[inline]
    pub fn at(&self, place: usize) -> usize {
        if self.ids.is_empty() { place } else { self.ids[place] as usize }
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
