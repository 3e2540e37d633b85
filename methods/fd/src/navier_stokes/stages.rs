//! The stages of a step: which terms are evaluated in which order, from which columns.

use finegrain_framework::space::Grid;
use finegrain_framework::{Fault, Moment, Own, Rate, Real, Stage, State, UpdateStage};

use super::NavierStokes;
use super::around::Coefficients;
use super::body::{Forces, Immersed, NoSlip, Still, When};
use super::equation::{Divergence, InTheMiddle, Momentum, PressureGradient};
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

    /// In `D` directions with operators of order `2 K`.
    pub(crate) fn stages<const D: usize, const K: usize>(&self) -> Result<Stages, FdError> {
        let coefficients = Coefficients::<T, D, K>::new(self.mesh.spacing());
        let equation = &self.equation;
        let faces = |source: fn(&Self, usize) -> Source<T>| -> [Field<T>; D] {
            std::array::from_fn(|a| {
                let beyond = equation.beyond(&self.mesh, Some(a));
                Field { source: source(self, a), beyond }
            })
        };
        let velocity = faces(|all, a| Source::State(all.velocity[a]));
        let momentum = Stage::rate(Stencil {
            term: Momentum {
                viscosity: T::of(equation.viscosity),
                acceleration: equation.acceleration.map(T::of),
            },
            fields: velocity,
            out: self.rates.clone(),
            adds: false,
            zero: (0..D).map(|a| equation.steady_faces(&self.mesh, a)).collect(),
            coefficients: coefficients.clone(),
        });
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
        let of_rates = faces(|all, a| Source::Rate(all.rates[a]));
        let of_next = faces(|all, a| Source::Both(all.rates[a], all.velocity[a]));
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
        let weights: Vec<f64> = staggered::derivative(self.order).into_iter().map(value).collect();
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
