//! Lists of neighbours: found by the first sweep of an evaluation, looked up by those after it.
//!
//! Positions do not change within an evaluation, so that a list holds what a search would find again,
//! and sums over it have the same bits. Lists that outlive a step need a skin, whose pairs every sweep
//! would gather only to find them out of range: as a search takes a sixth of a step, there is nothing to
//! be won.

use finegrain_framework::Notes;

/// Whether the sweeps of an evaluation share what the first has found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pairs {
    /// Every sweep searches.
    #[default]
    Searched,
    /// They do: two bytes a pair are kept, if there is more than one sweep.
    Kept,
}

/// The neighbours of a sub-domain's particles, in the order in which sums are made: for each how many they
/// are and their places among all that the sub-domain sees. None at all if it sees more than 2^16 - 1.
pub(crate) type List = Vec<u16>;

/// As many particles as a sub-domain may see to have lists.
pub(crate) const MOST_LISTED: usize = u16::MAX as usize;

/// Keeps a list, in hardly more memory than it takes.
pub(crate) fn keep(list: &List, kept: &mut List) {
    kept.clear();
    if kept.capacity() < list.len() {
        kept.reserve_exact(list.len() + list.len() / 16);
    }
    kept.extend_from_slice(list);
}

/// What a sweep has to do with lists.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Keeping {
    #[default]
    Nothing,
    Writes(Notes<List>),
    Reads(Notes<List>),
}

impl Keeping {
    /// What the sweep after one that keeps `self` has to do.
    pub fn next(self) -> Self {
        match self {
            Self::Writes(lists) => Self::Reads(lists),
            _ => self,
        }
    }
}

/// The list of one sub-domain, in use by a sweep.
pub(crate) enum Listed<'a> {
    Not,
    Written(&'a mut List),
    /// What has not been read yet.
    Read(&'a [u16]),
}

impl Listed<'_> {
    /// The next particle is none of this sweep's.
    #[inline(always)]
    pub fn pass(&mut self) {
        match self {
            Self::Not => (),
            Self::Written(list) => list.push(0),
            Self::Read(_) => {
                self.read();
            }
        }
    }

    /// The neighbours of the next particle, if they are known.
    #[inline(always)]
    pub fn read(&mut self) -> Option<&[u16]> {
        let Self::Read(list) = self else { return None };
        let (&count, rest) = list.split_first()?;
        let (own, rest) = rest.split_at(usize::from(count));
        *list = rest;
        (!own.is_empty()).then_some(own)
    }

    /// Takes the neighbours of the next particle down, as they have been found.
    #[inline(always)]
    pub fn write(&mut self, found: &[u32]) {
        let Self::Written(list) = self else { return };
        let end = list.len();
        list.resize(end + 1 + found.len(), found.len() as u16);
        for (listed, &place) in list[end + 1..].iter_mut().zip(found) {
            *listed = place as u16;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again_particle_by_particle() {
        let mut list = List::new();
        let mut written = Listed::Written(&mut list);
        assert_eq!(written.read(), None);
        written.write(&[3, 65_534]);
        written.pass();
        written.write(&[7]);
        written.write(&[1, 2]);

        let mut read = Listed::Read(&list);
        assert_eq!(read.read(), Some(&[3, 65_534][..]));
        assert_eq!(read.read(), None, "nothing was written for this one");
        read.pass();
        assert_eq!(read.read(), Some(&[1, 2][..]));
        assert_eq!(read.read(), None, "past the end");
    }

    #[test]
    fn memory_of_a_list_that_grows_and_shrinks_a_little_stays() {
        let mut kept = List::new();
        keep(&vec![1; 1600], &mut kept);
        let capacity = kept.capacity();
        assert!((1600..=1700).contains(&capacity));
        for length in [1500, 1690, 1] {
            keep(&vec![2; length], &mut kept);
            assert_eq!((kept.len(), kept.capacity()), (length, capacity));
        }
    }
}
