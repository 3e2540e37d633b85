//! Acceleration of the fluid that varies in space and time.

use std::fmt;
use std::sync::Arc;

/// Acceleration of the fluid, m/s^2, as a function of the position, m, and the time, s.
///
/// It must give the same for the same arguments whoever asks, and should be cheap: it is asked
/// once a site and step.
#[derive(Clone)]
pub struct AccelerationField(Arc<dyn Fn([f64; 3], f64) -> [f64; 3] + Send + Sync>);

impl AccelerationField {
    /// From a function of position and time.
    pub fn new(field: impl Fn([f64; 3], f64) -> [f64; 3] + Send + Sync + 'static) -> Self {
        Self(Arc::new(field))
    }

    /// The acceleration at a point and time.
    pub(crate) fn at(&self, position: [f64; 3], time: f64) -> [f64; 3] {
        self.0(position, time)
    }
}

impl fmt::Debug for AccelerationField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("AccelerationField")
    }
}

/// All body forces together, in lattice units.
#[derive(Clone, Debug)]
pub(crate) struct Acceleration {
    /// The part that is the same everywhere and always.
    pub uniform: [f64; 3],
    pub field: Option<AccelerationField>,
    pub mesh: crate::mesh::Mesh,
}

impl Acceleration {
    /// At a site, at `time` in s.
    pub fn at(&self, [x, y, z]: [usize; 3], time: f64) -> [f64; 3] {
        let Some(field) = &self.field else { return self.uniform };
        let position = self.mesh.position([x, y, z].map(|i| i as isize));
        let given = field.at(position, time);
        let unit = self.mesh.unit_acceleration();
        [0, 1, 2].map(|a| self.uniform[a] + given[a] / unit)
    }
}
