//! Builds a framework model.

use std::marker::PhantomData;
use std::sync::Arc;

use finegrain_framework::space::Grid;
use finegrain_framework::{Columns, Model, Plan, Real, RigidPace, Step};

use crate::acceleration::Acceleration;
use crate::collision::{Central, Collide, Collision, Cumulant, Mrt, Regularised, Trt};
use crate::derived::Derived;
use crate::error::LbmError;
use crate::fields::Fields;
use crate::kernel::Kernel;
use crate::lattice::{D2Q9, D3Q19, D3Q27, Lattice, LatticeKind};
use crate::mesh::Mesh;
use crate::opening::Openings;
use crate::physics::{Fluid, Physics, Scheme};
use crate::relaxation::Relaxation;
use crate::sites::{self, Sites};
use crate::start::Start;
use crate::stream::Stream;

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
        _: L,
        collision: C,
    ) -> Result<Lbm<T>, LbmError> {
        let &Self { mesh, fluid, physics, scheme, start } = self;
        let domain = Grid::builder(mesh.shape)
            .periodic(mesh.periodic)
            .origin(mesh.position([0; 3]))
            .spacing([mesh.spacing; 3])
            .build();
        let mut columns = Columns::new(domain.points());
        let fields = Fields::<T>::declare(&mut columns, scheme.lattice);
        let solid = sites::solid(mesh, physics)?;
        let sites = Arc::new(Sites::new(mesh, physics, scheme, &solid)?);
        let unit = mesh.unit_acceleration();
        let relaxation = Relaxation {
            time: mesh.relaxation_time(fluid.kinematic_viscosity),
            smagorinsky: scheme.smagorinsky,
        };
        let acceleration = Acceleration {
            uniform: physics.body_acceleration.map(|a| a / unit),
            field: physics.acceleration_field.clone(),
            mesh: *mesh,
        };
        for (point, _) in solid.iter().enumerate().filter(|(_, body)| **body == 0) {
            let [nx, ny, _] = mesh.shape;
            let site = [point % nx, point / nx % ny, point / (nx * ny)];
            let f = start.populations::<L, C, T, Q>(
                &collision,
                &relaxation,
                fluid,
                &acceleration,
                site,
            )?;
            for (&column, f) in fields.populations.iter().zip(f) {
                columns.values_mut(column)[point] = f;
            }
        }
        columns.values_mut(fields.solid).copy_from_slice(&solid);
        let velocities = scheme.lattice.velocities();
        let unit_pressure = fluid.density * mesh.unit_velocity().powi(2);
        let openings = Openings { all: physics.openings.clone(), mesh: *mesh, unit_pressure };
        let derived = Derived {
            populations: fields.populations.clone(),
            velocities,
            solid: fields.solid,
            pressure: fields.pressure,
            velocity: fields.velocity.clone(),
            acceleration: acceleration.clone(),
            unit_velocity: mesh.unit_velocity(),
            unit_pressure,
        };
        let stream = Stream::<T, L, C, Q> {
            now: std::array::from_fn(|q| fields.populations[q]),
            next: std::array::from_fn(|q| fields.next[q]),
            lattice: PhantomData,
            kernel: Kernel { collision, relaxation, acceleration },
            sites: Arc::clone(&sites),
            openings,
            velocities,
        };
        let mut step = Step::builder().rate(stream);
        for (&now, &next) in fields.populations.iter().zip(&fields.next) {
            step = step.swap(now, next);
        }
        let plan = Plan {
            prologue: None,
            step: step.build(),
            derived: Some(Step::builder().rate(derived).build()),
        };
        let mut model = Model::with_fixed_dt("lbm", domain, columns, plan, mesh.time_step);
        model.pacing = Box::new(RigidPace(mesh.time_step));
        let (lattice, density) = (scheme.lattice, fluid.density);
        let parts = Parts { fields: fields.clone(), mesh: *mesh, lattice, density, sites };
        Ok(Lbm { model, fields, mesh: *mesh, parts })
    }
}
