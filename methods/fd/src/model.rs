//! Builds framework models.

use finegrain_framework::space::Grid;
use finegrain_framework::{
    Columns, Evolution, Handle, Integrator, Model, Pacing, Plan, Rate, Real, RigidPace, Stage,
    State, Step,
};
use realfft::FftNum;

use crate::around::Coefficients;
use crate::boundary::{Boundary, Condition};
use crate::equation::Equation;
use crate::equation::advection::Transport;
use crate::equation::burgers::Steepening;
use crate::equation::drift::Drifting;
use crate::equation::gas::Conservation;
use crate::equation::heat::Diffusion;
use crate::equation::wave::Waves;
use crate::error::FdError;
use crate::line::{Ends, Line};
use crate::mesh::{AXES, Mesh, Side, Spread};
use crate::navier_stokes::{Fields, Immersed, Stages};
use crate::operator::face::{Face, Upwind1, Upwind3, Weno5, Weno5Z};
use crate::operator::sbp::Closure;
use crate::operator::staggered::StaggeredOrder;
use crate::operator::{Order, value};
use crate::stability;
use crate::sweep::{Form, Sweep};

/// A function of the position, m.
pub type Given<'a> = &'a dyn Fn([f64; 3]) -> f64;

/// A finite-difference model, ready to run.
pub struct Fd<T: Real> {
    /// For a [`finegrain_framework::Simulation`].
    pub model: Model<Grid>,
    /// Its points and fields, for measuring.
    pub parts: Parts<T>,
}

/// What measuring needs.
#[derive(Clone, Debug)]
pub struct Parts<T: Real> {
    /// The points.
    pub mesh: Mesh,
    /// The unknowns.
    pub unknowns: Vec<State<T>>,
    /// Their rates; or, with a step that computes the next state at once, the states before.
    pub rates: Vec<Rate<T>>,
    /// Fields for those who look: of an equation of second order the second derivative in time, of
    /// incompressible flow those of [`crate::NavierStokes::DERIVED`].
    pub derived: Vec<Rate<T>>,
    /// Weights of the points along x, y and z in integrals: those of the norm of the difference operators.
    pub weights: [Vec<f64>; 3],
    /// Bodies in the flow.
    pub(crate) immersed: Option<Immersed<T>>,
}

/// Brings the parts of a model together.
pub struct Builder<'m, T: Real, const F: usize, const G: usize> {
    pub(crate) mesh: &'m Mesh,
    pub(crate) boundaries: [&'m Boundary; F],
    pub(crate) order: Order,
    pub(crate) domain: Grid,
    pub(crate) columns: Columns,
    pub(crate) unknowns: Vec<State<T>>,
    given: Vec<State<T>>,
    pub(crate) out: Vec<Rate<T>>,
}

impl<'m, T: Compiled, const F: usize, const G: usize> Builder<'m, T, F, G> {
    /// Begins a model; `order` is that of central differences.
    pub(crate) fn new(
        mesh: &'m Mesh,
        boundaries: [&'m Boundary; F],
        order: Order,
    ) -> Result<Self, FdError> {
        stability::check_mesh(mesh, order)?;
        let mut reach = order.reach();
        for boundary in boundaries {
            boundary.check(mesh)?;
            for (side, conditions) in mesh.sides().iter().zip(&boundary.0) {
                if let Ends::Closed([rows, _]) = Line::<T>::new(side, order, conditions)?.ends {
                    reach = rows.iter().fold(reach, |reach, row| {
                        reach.max(row.from.unsigned_abs()).max(row.to() as usize - 1)
                    });
                }
            }
        }
        mesh.check_memory::<T>(2 * F + G)?;
        let domain = Grid::builder(mesh.shape())
            .periodic(mesh.is_periodic())
            .reach(reach)
            .bytes(size_of::<T>())
            .origin(mesh.position([0; 3]))
            .spacing(mesh.spacing())
            .build();
        let columns = Columns::new(domain.points());
        let (unknowns, given, out) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { mesh, boundaries, order, domain, columns, unknowns, given, out })
    }

    /// Declares the unknowns, and their state at the beginning.
    pub(crate) fn start(&mut self, fields: [(&'static str, Given<'_>); F]) -> Result<(), FdError> {
        for (name, start) in fields {
            let column = self.declare(name, start)?;
            self.unknowns.push(column);
            self.out.push(self.columns.rate(&format!("rate_{name}")));
        }
        Ok(())
    }

    /// The unknowns that have been declared.
    pub(crate) fn unknowns(&self) -> &[State<T>] {
        &self.unknowns
    }

    /// Declares the fields that are given.
    pub(crate) fn given(&mut self, fields: [(&'static str, Given<'_>); G]) -> Result<(), FdError> {
        for (name, given) in fields {
            let column = self.declare(name, given)?;
            self.given.push(column);
        }
        Ok(())
    }

    fn declare(&mut self, name: &'static str, values: Given<'_>) -> Result<State<T>, FdError> {
        let column = self.columns.state(name);
        let targets = self.columns.values_mut(column);
        for (target, position) in targets.iter_mut().zip(self.mesh.positions()) {
            let value = values(position);
            if !value.is_finite() {
                let range = "finite";
                return Err(FdError::Start { field: name, position, value, range });
            }
            *target = T::of(value);
        }
        Ok(column)
    }

    /// A model of first order in time.
    pub(crate) fn first_order(
        mut self,
        name: &str,
        integrator: Integrator,
        pacing: Box<dyn Pacing<Grid>>,
        stage: impl Fn(&Self, Form) -> Result<Stage<Grid>, FdError>,
    ) -> Result<Fd<T>, FdError> {
        let pairs: Vec<_> = self.unknowns.iter().copied().zip(self.out.iter().copied()).collect();
        let plan = if integrator == Integrator::Euler {
            // One pass over memory: what the stage writes is the next state.
            let step = Step::builder().stage_at(0.0, &stage(&self, Form::Euler)?);
            pairs.iter().fold(step, |step, &(u, next)| step.swap(u, next)).build().into()
        } else {
            let evaluation = [stage(&self, Form::Rate)?];
            let evolution =
                pairs.iter().fold(Evolution::new(), |all, &(u, rate)| all.with(u, rate));
            integrator.plan(&mut self.columns, &evolution, &evaluation)
        };
        self.finish(name, plan, pacing)
    }

    /// A model of second order in time, by leapfrog, of one unknown whose rate of change at the beginning
    /// is `velocity`.
    pub(crate) fn two_step(
        mut self,
        name: &str,
        time_step: f64,
        velocity: Given<'_>,
        stage: impl Fn(&Self, Form) -> Result<Stage<Grid>, FdError>,
    ) -> Result<Fd<T>, FdError> {
        let (u, before) = (self.unknowns[0], self.out[0]);
        self.columns.keep(before.id());
        for (point, position) in self.mesh.positions().enumerate() {
            let value = velocity(position);
            if !value.is_finite() {
                let (field, range) = ("velocity", "finite");
                return Err(FdError::Start { field, position, value, range });
            }
            let start = self.columns.values(u)[point];
            self.columns.values_mut(before)[point] = start + T::of(time_step * value);
        }
        // For those who look.
        let acceleration = self.columns.rate("acceleration");
        let before_and_now = std::mem::replace(&mut self.out, vec![acceleration]);
        let derived = Step::builder().stage_at(0.0, &stage(&self, Form::Rate)?).build();
        self.out = before_and_now;
        let prologue = Step::builder().stage_at(0.0, &stage(&self, Form::Before)?).build();
        let step = Step::builder().stage_at(0.0, &stage(&self, Form::TwoStep)?);
        let step = step.swap(u, before).build();
        let plan = Plan { prologue: Some(prologue), step, derived: Some(derived) };
        let mut fd = self.finish(name, plan, Box::new(RigidPace(time_step)))?;
        fd.parts.derived = vec![acceleration];
        Ok(fd)
    }

    pub(crate) fn finish(
        self,
        name: &str,
        plan: Plan<Grid>,
        pacing: Box<dyn Pacing<Grid>>,
    ) -> Result<Fd<T>, FdError> {
        let Self { mesh, order, domain, columns, unknowns, out, .. } = self;
        let mut model = Model::with_fixed_dt(&format!("fd {name}"), domain, columns, plan, 1.0);
        model.pacing = pacing;
        let mut weights = [vec![1.0], vec![1.0], vec![1.0]];
        for (weights, side) in weights.iter_mut().zip(mesh.sides()) {
            *weights = norm(side, order);
        }
        let mesh = mesh.clone();
        let (derived, immersed) = (Vec::new(), None);
        let parts = Parts { mesh, unknowns, rates: out, derived, weights, immersed };
        Ok(Fd { model, parts })
    }

    /// The stage of an equation with central differences.
    fn central<E: Equation<T, F, G>>(
        &self,
        equation: E,
        form: Form,
    ) -> Result<Stage<Grid>, FdError> {
        match self.order {
            Order::Second => self.sweep::<E, 1, 3, 5>(equation, form),
            Order::Fourth => self.sweep::<E, 2, 5, 7>(equation, form),
            Order::Sixth => self.sweep::<E, 3, 7, 11>(equation, form),
            Order::Eighth => self.sweep::<E, 4, 9, 9>(equation, form),
        }
    }

    /// The stage of an equation with values on faces, in which central differences are of order 6.
    fn faces<E: Equation<T, F, G>>(&self, equation: E, form: Form) -> Result<Stage<Grid>, FdError> {
        for (side, axis) in self.mesh.sides().iter().zip(AXES) {
            if side.spread == Spread::Ends {
                return Err(FdError::Ends(axis));
            }
        }
        self.sweep::<E, 3, 7, 7>(equation, form)
    }

    fn sweep<E: Equation<T, F, G>, const R: usize, const N: usize, const M: usize>(
        &self,
        equation: E,
        form: Form,
    ) -> Result<Stage<Grid>, FdError> {
        let sides = self.mesh.sides();
        let lines = |boundary: &Boundary| -> Result<[Option<Line<T>>; 3], FdError> {
            let mut lines = [None, None, None];
            for (a, side) in sides.iter().enumerate() {
                lines[a] = Some(Line::new(side, self.order, &boundary.0[a])?);
            }
            Ok(lines)
        };
        let mut all = [const { [None, None, None] }; F];
        for (to, boundary) in all.iter_mut().zip(self.boundaries) {
            *to = lines(boundary)?;
        }
        let shape = self.mesh.shape();
        let along = |a: usize, i: usize| {
            let mut point = [0; 3];
            point[a] = i;
            self.mesh.position(point)[a]
        };
        Ok(Stage::rate(Sweep::<T, E, F, G, R, N, M> {
            equation,
            unknowns: std::array::from_fn(|f| self.unknowns[f]),
            given: std::array::from_fn(|g| self.given[g]),
            out: std::array::from_fn(|f| self.out[f]),
            form,
            lines: all,
            given_lines: lines(&Boundary::all(Condition::Outflow))?,
            coefficients: Coefficients::new(self.order, self.mesh.spacing()),
            positions: [0, 1, 2].map(|a| (0..shape[a]).map(|i| along(a, i)).collect()),
        }))
    }
}

/// Weights of the points along a side in the norm of the difference operators, m.
pub(crate) fn norm(side: &Side, order: Order) -> Vec<f64> {
    let closure = Closure::of(order).filter(|_| side.spread == Spread::Ends);
    let weight = |i: usize| {
        let from_end = i.min(side.points - 1 - i);
        side.spacing() * closure.map_or(1.0, |closure| value(closure.norm(from_end)))
    };
    (0..side.points).map(weight).collect()
}

/// A scalar that kernels are compiled for: once, in this crate, and not anew in every crate that uses
/// it, because there are many of them.
pub trait Compiled: Real + FftNum {
    /// The stages of incompressible flow.
    #[doc(hidden)]
    fn navier_stokes(fields: &Fields<Self>) -> Result<Stages, FdError>;

    /// The stage of the heat equation.
    #[doc(hidden)]
    fn heat(
        builder: &Builder<'_, Self, 1, 0>,
        diffusivity: f64,
        form: Form,
    ) -> Result<Stage<Grid>, FdError>;

    /// The stage of the wave equation.
    #[doc(hidden)]
    fn wave(
        builder: &Builder<'_, Self, 1, 0>,
        speed: f64,
        form: Form,
    ) -> Result<Stage<Grid>, FdError>;

    /// The stage of advection by central differences.
    #[doc(hidden)]
    fn drift(
        builder: &Builder<'_, Self, 1, 0>,
        velocity: [f64; 3],
        form: Form,
    ) -> Result<Stage<Grid>, FdError>;

    /// The stage of advection.
    #[doc(hidden)]
    fn advection(
        builder: &Builder<'_, Self, 1, 3>,
        face: Face,
        form: Form,
    ) -> Result<Stage<Grid>, FdError>;

    /// The stage of Burgers' equation.
    #[doc(hidden)]
    fn burgers(
        builder: &Builder<'_, Self, 1, 0>,
        viscosity: f64,
        face: Face,
        form: Form,
    ) -> Result<Stage<Grid>, FdError>;

    /// The stage of a gas in one direction.
    #[doc(hidden)]
    fn gas_in_line(
        builder: &Builder<'_, Self, 3, 0>,
        heat_ratio: f64,
        form: Form,
    ) -> Result<Stage<Grid>, FdError>;

    /// The stage of a gas in two directions.
    #[doc(hidden)]
    fn gas_in_plane(
        builder: &Builder<'_, Self, 4, 0>,
        heat_ratio: f64,
        form: Form,
    ) -> Result<Stage<Grid>, FdError>;
}

macro_rules! compiled {
    ($($scalar:ident),*) => {
        $(
            impl Compiled for $scalar {
                fn navier_stokes(fields: &Fields<Self>) -> Result<Stages, FdError> {
                    let all = fields;
                    match (all.dims(), all.order, all.has_ends()) {
                        (2, StaggeredOrder::Second, _) => all.stages::<2, 1>(all.momentum::<2, 1>()),
                        (2, StaggeredOrder::Fourth, false) => {
                            all.stages::<2, 2>(all.momentum::<2, 2>())
                        }
                        (2, StaggeredOrder::Fourth, true) => {
                            all.stages::<2, 1>(all.momentum_between_walls::<2>())
                        }
                        (_, StaggeredOrder::Second, _) => all.stages::<3, 1>(all.momentum::<3, 1>()),
                        (_, StaggeredOrder::Fourth, false) => {
                            all.stages::<3, 2>(all.momentum::<3, 2>())
                        }
                        (_, StaggeredOrder::Fourth, true) => {
                            all.stages::<3, 1>(all.momentum_between_walls::<3>())
                        }
                    }
                }

                fn heat(
                    builder: &Builder<'_, Self, 1, 0>,
                    diffusivity: f64,
                    form: Form,
                ) -> Result<Stage<Grid>, FdError> {
                    builder.central(Diffusion { diffusivity: Self::of(diffusivity) }, form)
                }

                fn wave(
                    builder: &Builder<'_, Self, 1, 0>,
                    speed: f64,
                    form: Form,
                ) -> Result<Stage<Grid>, FdError> {
                    builder.central(Waves { speed_squared: Self::of(speed * speed) }, form)
                }

                fn drift(
                    builder: &Builder<'_, Self, 1, 0>,
                    velocity: [f64; 3],
                    form: Form,
                ) -> Result<Stage<Grid>, FdError> {
                    builder.central(Drifting { velocity: velocity.map(Self::of) }, form)
                }

                fn advection(
                    builder: &Builder<'_, Self, 1, 3>,
                    face: Face,
                    form: Form,
                ) -> Result<Stage<Grid>, FdError> {
                    match face {
                        Face::Upwind1 => builder.faces(Transport::new(Upwind1), form),
                        Face::Upwind3 => builder.faces(Transport::new(Upwind3), form),
                        Face::Weno5 => builder.faces(Transport::new(Weno5), form),
                        Face::Weno5Z => builder.faces(Transport::new(Weno5Z), form),
                    }
                }

                fn burgers(
                    builder: &Builder<'_, Self, 1, 0>,
                    viscosity: f64,
                    face: Face,
                    form: Form,
                ) -> Result<Stage<Grid>, FdError> {
                    let viscosity = Self::of(viscosity);
                    match face {
                        Face::Upwind1 => builder.faces(Steepening::new(viscosity, Upwind1), form),
                        Face::Upwind3 => builder.faces(Steepening::new(viscosity, Upwind3), form),
                        Face::Weno5 => builder.faces(Steepening::new(viscosity, Weno5), form),
                        Face::Weno5Z => builder.faces(Steepening::new(viscosity, Weno5Z), form),
                    }
                }

                fn gas_in_line(
                    builder: &Builder<'_, Self, 3, 0>,
                    heat_ratio: f64,
                    form: Form,
                ) -> Result<Stage<Grid>, FdError> {
                    builder.faces(Conservation { heat_ratio: Self::of(heat_ratio) }, form)
                }

                fn gas_in_plane(
                    builder: &Builder<'_, Self, 4, 0>,
                    heat_ratio: f64,
                    form: Form,
                ) -> Result<Stage<Grid>, FdError> {
                    builder.faces(Conservation { heat_ratio: Self::of(heat_ratio) }, form)
                }
            }
        )*
    };
}
compiled!(f32, f64);
