//! Vectors that vary in space and time.

use std::fmt;
use std::sync::Arc;

/// A vector as a function of the position, m, and the time, s: an acceleration, or a velocity that is
/// asked for.
///
/// It must give the same for the same arguments whoever asks, and should be cheap: methods ask once a
/// point and evaluation.
#[derive(Clone)]
pub struct VectorField(Arc<dyn Fn([f64; 3], f64) -> [f64; 3] + Send + Sync>);

impl VectorField {
    /// From a function of position and time.
    pub fn new(field: impl Fn([f64; 3], f64) -> [f64; 3] + Send + Sync + 'static) -> Self {
        Self(Arc::new(field))
    }

    /// The vector at a point and time.
    #[inline]
    pub fn at(&self, position: [f64; 3], time: f64) -> [f64; 3] {
        self.0(position, time)
    }
}

impl PartialEq for VectorField {
    /// Whether they are one and the same.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for VectorField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("VectorField")
    }
}
