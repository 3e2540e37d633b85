//! Columns that a stage owns with an offset.

use crate::columns::ColumnId;

/// Which columns these are, and by which shift of the partition each is owned. Looked up for every
/// column that a stage touches, so by number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shifts(Vec<Option<usize>>);

impl Shifts {
    /// None.
    pub const NONE: &Self = &Self(Vec::new());

    /// The shift of a column.
    #[inline]
    pub fn of(&self, column: ColumnId) -> Option<usize> {
        self.0.get(usize::from(column.0)).copied().flatten()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All, by column.
    pub fn iter(&self) -> impl Iterator<Item = (ColumnId, usize)> {
        (0..).map(ColumnId).zip(&self.0).filter_map(|(column, &shift)| Some((column, shift?)))
    }
}

/// # Panics
/// If a column has two shifts.
impl FromIterator<(ColumnId, usize)> for Shifts {
    fn from_iter<I: IntoIterator<Item = (ColumnId, usize)>>(shifts: I) -> Self {
        let mut all = Self::default();
        for (column, shift) in shifts {
            let number = usize::from(column.0);
            if all.0.len() <= number {
                all.0.resize(number + 1, None);
            }
            let known = all.0[number].replace(shift);
            assert!(
                known.is_none_or(|known| known == shift),
                "column {number} is owned with two offsets"
            );
        }
        all
    }
}
