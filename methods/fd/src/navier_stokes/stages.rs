//! The stages of a step: which terms are evaluated in which order, from which columns.

use finegrain_framework::space::Grid;
use finegrain_framework::{Fault, Moment, Own, Rate, Real, Stage, State, UpdateStage};

use super::NavierStokes;
use super::around::Coefficients;
use super::between_walls::BetweenWalls;
use super::body::{Forces, Immersed, NoSlip, Still, When};
use super::equation::{Divergence, InTheMiddle, Momentum, PressureGradient, Term};
use super::stencil::{Field, Source, Stencil};
use crate::error::FdError;
use crate::mesh::Mesh;
use crate::model::Compiled;
use crate::operator::staggered::{self, StaggeredOrder};
use crate::operator::value;
use crate::poisson::axis::Axis;
use crate::poisson::{Poisson, Solver};

/// The stages of a model.
pub struct Stages {
    /// From the velocity, its rate of change.
    pub(super) evaluation: Vec<Stage<Grid>>,
    /// Takes what has a divergence from the velocity at the beginning.
    pub(super) start: Vec<Stage<Grid>>,
    /// Fields for those who look.
    pub(super) looking: Vec<Stage<Grid>>,
}

/// All that stages are made from.
pub struct Fields<T: Real> {
    pub(super) equation: NavierStokes,
    pub(super) mesh: Mesh,
    pub(crate) order: StaggeredOrder,
    pub(super) velocity: Vec<State<T>>,
    pub(super) rates: Vec<Rate<T>>,
    pub(super) pressure: Rate<T>,
    pub(super) middle: Vec<Rate<T>>,
    pub(super) immersed: Option<Immersed<T>>,
}

impl<T: Compiled> Fields<T> {
    pub(crate) fn dims(&self) -> usize {
        self.mesh.dims()
    }

    /// Whether there are walls or openings.
    pub(crate) fn has_ends(&self) -> bool {
        self.mesh.is_periodic().contains(&false)
    }

    /// Advection and diffusion, with operators of order `2 K`.
    pub(crate) fn momentum<const D: usize, const K: usize>(&self) -> Stage<Grid> {
        self.momentum_by::<D, K, _>(self.momentum_term())
    }

    /// The same of fourth order, next to walls of second.
    pub(crate) fn momentum_between_walls<const D: usize>(&self) -> Stage<Grid> {
        self.momentum_by::<D, 2, _>(BetweenWalls {
            momentum: self.momentum_term(),
            coefficients: Coefficients::new(self.mesh.spacing()),
            walls: self.mesh.is_periodic().map(|is_periodic| !is_periodic),
        })
    }

    fn momentum_term(&self) -> Momentum<T> {
        Momentum {
            viscosity: T::of(self.equation.viscosity),
            acceleration: self.equation.acceleration.map(T::of),
        }
    }

    fn momentum_by<const D: usize, const K: usize, E: Term<T, D, D, K>>(
        &self,
        term: E,
    ) -> Stage<Grid> {
        Stage::rate(Stencil {
            term,
            fields: self.faces(|all, a| Source::State(all.velocity[a])),
            out: self.rates.clone(),
            adds: false,
            zero: (0..D).map(|a| self.equation.steady_faces(&self.mesh, a)).collect(),
            coefficients: Coefficients::<T, D, K>::new(self.mesh.spacing()),
        })
    }

    /// What lies on the faces along each of `D` axes.
    fn faces<const D: usize>(&self, source: fn(&Self, usize) -> Source<T>) -> [Field<T>; D] {
        std::array::from_fn(|a| {
            let beyond = self.equation.beyond(&self.mesh, Some(a));
            Field { source: source(self, a), beyond }
        })
    }

    /// In `D` directions, with operators of order `2 K` for what the pressure keeps.
    pub(crate) fn stages<const D: usize, const K: usize>(
        &self,
        momentum: Stage<Grid>,
    ) -> Result<Stages, FdError> {
        let coefficients = Coefficients::<T, D, K>::new(self.mesh.spacing());
        let equation = &self.equation;
        let velocity = self.faces(|all, a| Source::State(all.velocity[a]));
        let divergence = |fields| {
            Stage::rate(Stencil {
                term: Divergence,
                fields,
                out: vec![self.pressure],
                adds: false,
                zero: vec![None],
                coefficients: coefficients.clone(),
            })
        };
        let of_rates = self.faces(|all, a| Source::Rate(all.rates[a]));
        let of_next = self.faces(|all, a| Source::Both(all.rates[a], all.velocity[a]));
        // Beyond an outflow, too, it drives nothing along the end: that would give the flow energy.
        let beyond = equation.layer_beyond(&self.mesh);
        let gradient = |adds| {
            Stage::rate(Stencil {
                term: PressureGradient,
                fields: [Field {
                    source: Source::Rate(self.pressure),
                    beyond: equation.beyond(&self.mesh, None),
                }],
                out: self.rates.clone(),
                adds,
                zero: (0..D).map(|a| beyond.filter(|layer| layer.axis != a)).collect(),
                coefficients: coefficients.clone(),
            })
        };
        let correction = Correction { velocity: self.velocity.clone(), rates: self.rates.clone() };
        // The divergence there does not count.
        let middle = Stage::rate(Stencil {
            term: InTheMiddle,
            fields: velocity,
            out: self.middle.clone(),
            adds: false,
            zero: (0..=D).map(|i| beyond.filter(|_| i == D)).collect(),
            coefficients: coefficients.clone(),
        });
        let correction = Stage::update(correction);
        let Some(immersed) = &self.immersed else {
            let solve = Stage::whole(Poisson { solver: self.solver(), column: self.pressure });
            return Ok(Stages {
                start: vec![divergence(velocity), solve.clone(), gradient(false), correction],
                looking: vec![momentum.clone(), divergence(of_rates), solve.clone(), middle],
                evaluation: vec![momentum, divergence(of_next), solve, gradient(true)],
            });
        };
        let forces = Forces::new(&immersed.faces, self.solver())?;
        let still = |when| Stage::whole(Still { immersed: immersed.clone(), when });
        let solve = |when| {
            let (immersed, solver, forces) = (immersed.clone(), self.solver(), forces.clone());
            let divergence = vec![T::zero(); self.mesh.points()];
            Stage::whole(NoSlip { immersed, solver, forces, divergence, when })
        };
        let [start, step, look] =
            [When::Start, When::Step, When::Look].map(|when| (still(when), solve(when)));
        Ok(Stages {
            start: vec![start.0, divergence(velocity), start.1, gradient(true), correction],
            looking: vec![momentum.clone(), look.0, divergence(of_rates), look.1, middle],
            evaluation: vec![momentum, step.0, divergence(of_next), step.1, gradient(true)],
        })
    }

    /// Of `divergence(gradient(p)) = q`.
    fn solver<U: Compiled>(&self) -> Solver<U> {
        let order = if self.has_ends() { StaggeredOrder::Second } else { self.order };
        let weights: Vec<f64> = staggered::derivative(order).into_iter().map(value).collect();
        let spacing = self.mesh.spacing();
        let axis = |a| Axis::new(self.mesh.shape()[a], self.equation.waves(&self.mesh, a));
        Solver::new((0..self.dims()).map(axis).collect(), |a, angle| {
            let terms = weights.iter().zip([0.5, 1.5]);
            let derivative: f64 = terms.map(|(d, by)| 2.0 * d * (by * angle).sin()).sum();
            (derivative / spacing[a]).powi(2)
        })
    }
}

/// Adds rates to the velocity as they are.
struct Correction<T> {
    velocity: Vec<State<T>>,
    rates: Vec<Rate<T>>,
}

impl<T: Real> UpdateStage<Grid> for Correction<T> {
    type Scratch = ();

    fn name(&self) -> &str {
        "correction of the start"
    }

    fn update(&self, own: &mut Own<'_, Grid>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        for (&u, &rate) in self.velocity.iter().zip(&self.rates) {
            let (mut u, rate) = (own.state_mut(u), own.rate(rate));
            for k in 0..u.spans() {
                u.span(k).iter_mut().zip(rate.span(k)).for_each(|(u, &rate)| *u += rate);
            }
        }
        Ok(())
    }
}
