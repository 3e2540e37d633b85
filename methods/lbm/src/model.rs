//! Builds a framework model.

use std::marker::PhantomData;
use std::sync::Arc;

use finegrain_framework::space::Grid;
use finegrain_framework::{Columns, Model, Plan, Real, RigidPace, Step, check_memory};

use crate::acceleration::Acceleration;
use crate::collision::{Central, Collide, Collision, Cumulant, Mrt, Regularised, Trt};
use crate::derived::Derived;
use crate::error::LbmError;
use crate::fields::Fields;
use crate::in_place::{InPlace, TurnBack, Turns};
use crate::kernel::{Collider, Kernel};
use crate::lattice::{D2Q9, D3Q19, D3Q27, Lattice, LatticeKind};
use crate::mesh::Mesh;
use crate::opening::Openings;
use crate::physics::{Fluid, Physics, Scheme, Streaming};
use crate::relaxation::Relaxation;
use crate::row::Local;
use crate::sites::{self, Sites};
use crate::start::{Setting, Start};
use crate::stream::Stream;
use crate::tiles;

/// A lattice Boltzmann model, ready to run.
pub struct Lbm<T: Real> {
    /// For a [`finegrain_framework::Simulation`].
    pub model: Model<Grid>,
    /// Its columns.
    pub fields: Fields<T>,
    /// The sites, and the units.
    pub mesh: Mesh,
    /// What it is made of, for measuring.
    pub parts: Parts<T>,
}

/// What measuring needs besides the fields.
#[derive(Clone, Debug)]
pub struct Parts<T> {
    pub(crate) fields: Fields<T>,
    pub(crate) mesh: Mesh,
    pub(crate) lattice: LatticeKind,
    pub(crate) streaming: Streaming,
    pub(crate) density: f64,
    pub(crate) sites: Arc<Sites<T>>,
}

/// A scalar that kernels are compiled for: once, in this crate, and not anew in every crate that uses
/// it, because there are many of them.
pub trait Compiled: Real {
    /// As [`Lbm::new`].
    ///
    /// # Errors
    /// As [`Lbm::new`].
    fn model(
        mesh: &Mesh,
        fluid: &Fluid,
        physics: &Physics,
        scheme: &Scheme,
        start: &Start,
    ) -> Result<Lbm<Self>, LbmError>;
}

macro_rules! compiled {
    ($($scalar:ident),*) => {
        $(
            impl Compiled for $scalar {
                fn model(
                    mesh: &Mesh,
                    fluid: &Fluid,
                    physics: &Physics,
                    scheme: &Scheme,
                    start: &Start,
                ) -> Result<Lbm<Self>, LbmError> {
                    Lbm::build(mesh, fluid, physics, scheme, start)
                }
            }
        )*
    };
}
compiled!(f32, f64);

impl<T: Compiled> Lbm<T> {
    /// Builds a model.
    ///
    /// # Errors
    /// If a number is outside its valid range, the mesh has an open end, or nothing is fluid.
    pub fn new(
        mesh: &Mesh,
        fluid: &Fluid,
        physics: &Physics,
        scheme: &Scheme,
        start: &Start,
    ) -> Result<Self, LbmError> {
        T::model(mesh, fluid, physics, scheme, start)
    }
}

impl<T: Real> Lbm<T> {
    fn build(
        mesh: &Mesh,
        fluid: &Fluid,
        physics: &Physics,
        scheme: &Scheme,
        start: &Start,
    ) -> Result<Self, LbmError> {
        mesh.check(scheme.lattice)?;
        physics.check(mesh)?;
        scheme.check()?;
        fluid.check(mesh)?;
        match scheme.lattice {
            LatticeKind::D2Q9 => Self::on(D2Q9, mesh, fluid, physics, scheme, start),
            LatticeKind::D3Q19 => Self::on(D3Q19, mesh, fluid, physics, scheme, start),
            LatticeKind::D3Q27 => Self::on(D3Q27, mesh, fluid, physics, scheme, start),
        }
    }

    fn on<L: Lattice<Q>, const Q: usize>(
        lattice: L,
        mesh: &Mesh,
        fluid: &Fluid,
        physics: &Physics,
        scheme: &Scheme,
        start: &Start,
    ) -> Result<Self, LbmError> {
        let builder = Builder { mesh, fluid, physics, scheme, start };
        match scheme.collision {
            Collision::Bgk => builder.build(lattice, Trt { magic: None }),
            Collision::Trt { magic } => builder.build(lattice, Trt { magic: Some(magic) }),
            Collision::Mrt { magic } => builder.build(lattice, Mrt { magic }),
            Collision::CentralMoments => builder.build(lattice, Central),
            Collision::Cumulant => builder.build(lattice, Cumulant),
            Collision::Regularised => builder.build(lattice, Regularised),
        }
    }
}

struct Builder<'a> {
    mesh: &'a Mesh,
    fluid: &'a Fluid,
    physics: &'a Physics,
    scheme: &'a Scheme,
    start: &'a Start,
}

impl Builder<'_> {
    fn build<T: Real, L: Lattice<Q>, C: Collide<T>, const Q: usize>(
        &self,
        lattice: L,
        collision: C,
    ) -> Result<Lbm<T>, LbmError> {
        let &Self { mesh, fluid, physics, scheme, .. } = self;
        let relaxation = Relaxation {
            time: mesh.relaxation_time(fluid.kinematic_viscosity),
            smagorinsky: scheme.smagorinsky,
        };
        let unit = mesh.unit_acceleration();
        let uniform = physics.body_acceleration.map(|a| a / unit);
        let collider =
            Box::new(Kernel { lattice: PhantomData::<L>, collision, relaxation, uniform });
        self.with(lattice, collider, &relaxation, uniform)
    }

    /// All that is the same for every collision.
    fn with<T: Real, L: Lattice<Q>, const Q: usize>(
        &self,
        _: L,
        collider: Box<dyn Collider<T, Q>>,
        relaxation: &Relaxation,
        uniform: [f64; 3],
    ) -> Result<Lbm<T>, LbmError> {
        let &Self { mesh, fluid, physics, scheme, start } = self;
        let (streaming, velocities) = (scheme.streaming(physics)?, scheme.lattice.velocities());
        let sites = mesh.sites();
        let grids = if streaming == Streaming::TwoGrids { 2 } else { 1 };
        check_memory(sites, grids * Q * size_of::<T>())
            .map_err(|cause| LbmError::Memory { sites, cause })?;
        let domain = tiles::grid(mesh, scheme.lattice, streaming);
        let mut columns = Columns::new(domain.points());
        let fields = Fields::<T>::declare(&mut columns, scheme.lattice, streaming);
        let solid = sites::solid(mesh, physics)?;
        let sites = Arc::new(Sites::new(mesh, physics, scheme, &solid)?);
        let acceleration =
            Acceleration { uniform, field: physics.acceleration_field.clone(), mesh: *mesh };
        let unit_pressure = fluid.density * mesh.unit_velocity().powi(2);
        let openings = Openings { all: physics.openings.clone(), mesh: *mesh, unit_pressure };
        let derived = Derived {
            populations: fields.populations.clone(),
            velocities,
            streaming,
            solid: fields.solid,
            pressure: fields.pressure,
            velocity: fields.velocity.clone(),
            acceleration: acceleration.clone(),
            unit_velocity: mesh.unit_velocity(),
            unit_pressure,
        };
        let local =
            Local { collider, acceleration, sites: Arc::clone(&sites), openings, velocities };
        let setting = Setting { relaxation, fluid, local: &local, streaming };
        start.fill::<L, T, Q>(&setting, &solid, &mut columns, &fields.populations)?;
        columns.values_mut(fields.solid).copy_from_slice(&solid);
        let plan = Plan {
            prologue: None,
            step: step::<T, L, Q>(mesh, &fields, local),
            derived: Some(Step::builder().rate(derived).build()),
        };
        let mut model = Model::with_fixed_dt("lbm", domain, columns, plan, mesh.time_step);
        model.pacing = Box::new(RigidPace(mesh.time_step));
        let (lattice, density) = (scheme.lattice, fluid.density);
        let parts =
            Parts { fields: fields.clone(), mesh: *mesh, lattice, streaming, density, sites };
        Ok(Lbm { model, fields, mesh: *mesh, parts })
    }
}

/// A step: in place, unless there is a second set of columns.
fn step<T: Real, L: Lattice<Q>, const Q: usize>(
    mesh: &Mesh,
    fields: &Fields<T>,
    local: Local<T, Q>,
) -> Step<Grid> {
    let (lattice, now) = (PhantomData::<L>, std::array::from_fn(|q| fields.populations[q]));
    if fields.next.is_empty() {
        let turns = Turns::new(mesh, local.velocities, &local.sites);
        let mut step = Step::builder();
        if !turns.is_empty() {
            step = step.update(TurnBack { slots: now, turns });
        }
        step = step.update(InPlace { lattice, slots: now, local });
        return (1..Q)
            .step_by(2)
            .fold(step, |step, q| step.swap_states(now[q], now[q + 1]))
            .build();
    }
    let next: [_; Q] = std::array::from_fn(|q| fields.next[q]);
    let step = Step::builder().rate(Stream { lattice, now, next, local });
    (0..Q).fold(step, |step, q| step.swap(now[q], next[q])).build()
}
