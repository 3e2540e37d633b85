//! The number of space dimensions of a scene.

/// How many space dimensions a scene has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Along x.
    One,
    /// In the plane of x and y.
    Two,
    /// In space.
    Three,
}

impl Dimension {
    /// The number of dimensions: 1, 2 or 3.
    pub const fn number(self) -> usize {
        match self {
            Dimension::One => 1,
            Dimension::Two => 2,
            Dimension::Three => 3,
        }
    }
}
