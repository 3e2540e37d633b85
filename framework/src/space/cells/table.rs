//! Hash table of existing cells: empty space costs nothing (Holmes et al. 2011, section 4.4).

/// From a cell's key to its index; open addressing with linear probing, at most half full.
#[derive(Debug, Default)]
pub(super) struct KeyTable {
    entries: Vec<(u64, u32)>,
    mask: usize,
}

/// No cell has this key: there are fewer cells than that.
const EMPTY: u64 = u64::MAX;

impl KeyTable {
    /// Forgets everything and makes the keys' positions in `keys` their values.
    pub fn fill(&mut self, keys: impl ExactSizeIterator<Item = u64>) {
        let size = (2 * keys.len()).next_power_of_two().max(2);
        self.entries.clear();
        self.entries.resize(size, (EMPTY, 0));
        self.mask = size - 1;
        for (index, key) in keys.enumerate() {
            let mut at = self.home(key);
            while self.entries[at].0 != EMPTY {
                at = (at + 1) & self.mask;
            }
            self.entries[at] = (key, index as u32);
        }
    }

    /// Index of the cell with this key, if it exists.
    #[inline]
    pub fn get(&self, key: u64) -> Option<usize> {
        let mut at = self.home(key);
        loop {
            match self.entries[at] {
                (found, index) if found == key => return Some(index as usize),
                (EMPTY, _) => return None,
                _ => at = (at + 1) & self.mask,
            }
        }
    }

    fn home(&self, key: u64) -> usize {
        // Fibonacci hashing (Knuth, TAOCP 6.4): neighbouring keys spread over the table.
        (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize & self.mask
    }

    pub fn memory(&self) -> usize {
        self.entries.capacity() * size_of::<(u64, u32)>()
    }
}
