//! What a domain's points look like to a viewer.

use crate::columns::ColumnId;
use crate::domain::Domain;

/// Where the points of a domain are, as files for viewing need it.
#[derive(Clone, Debug, PartialEq)]
pub enum Geometry {
    /// Points anywhere: one column of coordinates for each of 1 to 3 directions, of one float
    /// type.
    Points(Vec<ColumnId>),
    /// A regular grid: its points are not stored.
    Image {
        /// Points in x, y and z, at least 1 each; x runs fastest.
        shape: [usize; 3],
        /// Position of the first point.
        origin: [f64; 3],
        /// Distance of points in each direction, positive.
        spacing: [f64; 3],
    },
}

/// A domain whose points can be dumped for viewing.
pub trait Viewable: Domain {
    /// Where its points are. Must not change during a run: moving points are columns.
    fn geometry(&self) -> Geometry;
}
