//! How far particles are from the surfaces of bodies.

use std::sync::Arc;

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Moment, Own, Real, Stage, UpdateStage};

use crate::evaluation::{Piece, Update};
use crate::fields::Fields;
use crate::quantity::Quantity;
use crate::wall::Walls;

/// The update that measures the distance of every particle to the nearest surface.
#[derive(Clone, Debug)]
pub(crate) struct SurfaceDistance<T, P> {
    fields: Fields<T, P>,
    walls: Arc<Walls>,
}

impl<T: Real, P: Real> SurfaceDistance<T, P> {
    /// For the surfaces of `walls`.
    pub fn piece(walls: &Arc<Walls>) -> Piece<T, P> {
        let walls = Arc::clone(walls);
        Piece::Update(Update {
            reads: Vec::new(),
            writes: vec![Quantity::SurfaceDistance],
            amends: false,
            stage: Box::new(move |fields| Stage::update(Self { fields: fields.clone(), walls })),
        })
    }
}

impl<T: Real, P: Real> UpdateStage<Cells<P>> for SurfaceDistance<T, P> {
    type Scratch = ();

    fn name(&self) -> &str {
        "distance to surfaces"
    }

    fn update(&self, own: &mut Own<'_, Cells<P>>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let Some(distance) = self.fields.surface_distance else { return Ok(()) };
        let distance = own.state_mut(distance).whole();
        let mut x = [[].as_slice(); 3];
        for (x, &position) in x.iter_mut().zip(&self.fields.position) {
            *x = own.state(position).whole();
        }
        for (i, distance) in distance.iter_mut().enumerate() {
            let position = x.map(|x| x.get(i).map_or(0.0, |x: &P| x.as_f64()));
            *distance = T::of(self.walls.signed_distance(position));
        }
        Ok(())
    }
}
