//! Acceleration of the fluid.

use finegrain_framework::VectorField;

/// All body forces together, in lattice units.
#[derive(Clone, Debug)]
pub(crate) struct Acceleration {
    /// The part that is the same everywhere and always.
    pub uniform: [f64; 3],
    pub field: Option<VectorField>,
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
