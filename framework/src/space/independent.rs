//! Points that do not see each other: systems of ordinary differential equations.

use crate::domain::{Domain, Partition, Piece, Span};
use crate::viewable::{Geometry, Viewable};

/// `n` points without neighbours, cut into equal sub-domains.
#[derive(Debug)]
pub struct Independent {
    partition: Partition,
}

impl Independent {
    /// `points` points, 64 of them to a sub-domain.
    pub fn new(points: usize) -> Self {
        Self::with_share(points, 64)
    }

    /// `points` points, `share` of them to a sub-domain.
    ///
    /// # Panics
    /// If `share` is 0.
    pub fn with_share(points: usize, share: usize) -> Self {
        let mut partition = Partition::new(points);
        for start in (0..points).step_by(share) {
            let end = (start + share).min(points);
            partition.push([Span { start, end }], []);
        }
        partition.seal().expect("consecutive spans are disjoint");
        Self { partition }
    }
}

impl Domain for Independent {
    type SubDomain<'a> = Piece<'a>;

    fn partition(&self) -> &Partition {
        &self.partition
    }

    fn sub_domain(&self, id: usize) -> Piece<'_> {
        self.partition.piece(id)
    }
}

/// Shown as a row of points at distance 1.
impl Viewable for Independent {
    fn geometry(&self) -> Geometry {
        let shape = [self.partition.points(), 1, 1];
        Geometry::Image { shape, origin: [0.0; 3], spacing: [1.0; 3] }
    }
}
