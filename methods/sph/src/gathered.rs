//! What a sweep gathers of every particle, and where it lies in the records.

use finegrain_framework::lanes::{RECORD, Record};
use finegrain_framework::{Real, State};

use crate::fields::{Column, Fields};
use crate::quantity::Quantity;

/// What a place of the records holds.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source<T> {
    /// A coordinate, which depends on from where it is seen.
    Position(usize),
    Column(Column<T>),
    /// The place is not used.
    Nothing,
}

/// Where the quantities that a sweep gathers lie in the records of a particle: its position first,
/// then the quantities in order.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// Place of each quantity in the records; `ABSENT` if the sweep does not gather it.
    pub places: [usize; Quantity::COUNT],
    /// The quantities that have a place.
    pub present: Vec<Quantity>,
    /// Number of places in use of every record that a particle has.
    pub pages: Vec<usize>,
    /// What of the kernel is wanted besides its gradient factor.
    pub wanted: Wanted,
}

/// What of the kernel may be wanted besides its gradient factor.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wanted {
    /// Its values.
    pub kernel: bool,
    /// Its gradient.
    pub gradient: bool,
}

/// No place.
pub(crate) const ABSENT: usize = usize::MAX;

/// The quantities that a sweep gathers, with their columns.
///
/// A particle's values lie next to each other in records of a cache line.
#[derive(Clone, Debug)]
pub(crate) struct Gathered<T, P> {
    pub position: Vec<State<P>>,
    wall_depth: Option<State<T>>,
    /// A column that is there, for places that hold none.
    pub any: State<T>,
    /// What the places of all records hold.
    pub pages: Vec<Record<Source<T>>>,
    /// The same for what does not know the columns.
    pub layout: Layout,
}

impl<T: Real, P: Real> Gathered<T, P> {
    /// The columns of `quantities`, each once.
    pub fn new(fields: &Fields<T, P>, mut quantities: Vec<Quantity>, wanted: Wanted) -> Self {
        quantities.sort_unstable();
        quantities.dedup();
        let mut sources: Vec<_> = (0..fields.position.len()).map(Source::Position).collect();
        let mut places = [ABSENT; Quantity::COUNT];
        let mut present = Vec::new();
        for quantity in quantities {
            let Some(column) = fields.column(quantity) else { continue };
            places[quantity.index()] = sources.len();
            sources.push(Source::Column(column));
            present.push(quantity);
        }
        let used = sources.chunks(RECORD).map(|page| page.len()).collect();
        sources.resize(sources.len().next_multiple_of(RECORD), Source::Nothing);
        let pages = sources.as_chunks().0.to_vec();
        let (position, wall_depth) = (fields.position.clone(), fields.wall_depth);
        let layout = Layout { places, present, pages: used, wanted };
        Self { position, wall_depth, any: fields.density, pages, layout }
    }

    /// The column of the depth in bodies, if there are bodies.
    pub fn wall_depth(&self) -> Option<State<T>> {
        self.wall_depth
    }
}
