//! Acceleration of the fluid that varies in space and time.

use std::fmt;
use std::sync::Arc;

use finegrain_framework::Real;

/// Acceleration of the fluid, m/s^2, as a function of the position, m, and the time, s.
///
/// It must give the same for the same arguments whoever asks, and should be cheap: it is asked
/// once a particle and evaluation.
#[derive(Clone)]
pub struct AccelerationField(Arc<dyn Fn([f64; 3], f64) -> [f64; 3] + Send + Sync>);

impl AccelerationField {
    /// From a function of position and time.
    pub fn new(field: impl Fn([f64; 3], f64) -> [f64; 3] + Send + Sync + 'static) -> Self {
        Self(Arc::new(field))
    }

    /// The acceleration at a point and time.
    pub(crate) fn at<T: Real, const D: usize>(&self, position: [f64; 3], time: f64) -> [T; D] {
        let given = self.0(position, time);
        let mut acceleration = [T::zero(); D];
        for a in 0..D {
            acceleration[a] = T::of(given[a]);
        }
        acceleration
    }
}

impl PartialEq for AccelerationField {
    /// Whether they are one and the same.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl fmt::Debug for AccelerationField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("AccelerationField")
    }
}
