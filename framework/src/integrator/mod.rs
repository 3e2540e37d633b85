//! Time integrators, built from the two parts of a step.
//!
//! An integrator takes a method's *evaluation* (the stages that compute all rates from the state)
//! and what evolves with which rate, and lays out a step: evaluations, each at its own stage time
//! `t + c dt`, and linear updates between them.

mod euler;
mod leapfrog;
mod linear;
mod runge_kutta;

use crate::columns::{ColumnId, Columns, Element, Rate, State};
use crate::domain::Domain;
use crate::step::{Stage, Step};

/// What evolves, and how.
#[derive(Clone, Debug, Default)]
pub struct Evolution {
    /// State columns with their rates: `y' = k`.
    pub(crate) rates: Vec<(ColumnId, ColumnId)>,
    /// State columns whose rate is another state column: `x' = v`.
    pub(crate) motions: Vec<(ColumnId, ColumnId)>,
    /// State columns with rates that only add to what else moves them.
    pub(crate) drifts: Vec<(ColumnId, ColumnId)>,
}

impl Evolution {
    /// Nothing evolves yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// `state' = rate`, the rate being written by the evaluation.
    #[must_use]
    pub fn with<T: Element>(mut self, state: State<T>, rate: Rate<T>) -> Self {
        use crate::columns::Handle;
        self.rates.push((state.id(), rate.id()));
        self
    }

    /// `position' = velocity`, both being state. The two may have different precision.
    #[must_use]
    pub fn with_motion<T: Element, V: Element>(
        mut self,
        position: State<T>,
        velocity: State<V>,
    ) -> Self {
        use crate::columns::Handle;
        self.motions.push((position.id(), velocity.id()));
        self
    }

    /// `position' = velocity + drift`, besides [`Evolution::with_motion`]: a small correction of
    /// the motion, written by the evaluation. Leapfrog takes it at the beginning of the step, to
    /// first order, so that points do not move after the evaluation; the others treat it as any
    /// rate.
    #[must_use]
    pub fn with_drift<T: Element, V: Element>(
        mut self,
        position: State<T>,
        drift: Rate<V>,
    ) -> Self {
        use crate::columns::Handle;
        self.drifts.push((position.id(), drift.id()));
        self
    }

    /// All pairs of a state and what adds to its rate. Motions first: the velocity that moves a
    /// point is the one its rates were computed with.
    fn slopes(&self) -> Vec<(ColumnId, ColumnId)> {
        [&self.motions[..], &self.drifts, &self.rates].concat()
    }
}

/// How time is stepped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Integrator {
    /// Explicit Euler: first order.
    Euler,
    /// Symplectic (semi-implicit) Euler: first order, keeps the energy of oscillations bounded.
    SymplecticEuler,
    /// Leapfrog in kick-drift-kick form: second order, one evaluation a step. For motion; on pure
    /// decay, `y' = -k y`, it is stable only for `k dt` up to 1.
    Leapfrog,
    /// Runge-Kutta midpoint: second order.
    Rk2,
    /// Strong-stability-preserving Runge-Kutta: third order.
    SspRk3,
    /// Classical Runge-Kutta: fourth order.
    Rk4,
}

impl Integrator {
    /// All integrators.
    pub const ALL: [Self; 6] =
        [Self::Euler, Self::SymplecticEuler, Self::Leapfrog, Self::Rk2, Self::SspRk3, Self::Rk4];

    /// The name used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Euler => "euler",
            Self::SymplecticEuler => "symplectic-euler",
            Self::Leapfrog => "leapfrog",
            Self::Rk2 => "rk2",
            Self::SspRk3 => "ssp-rk3",
            Self::Rk4 => "rk4",
        }
    }

    /// Order of accuracy for smooth rates.
    pub fn order(self) -> u32 {
        match self {
            Self::Euler | Self::SymplecticEuler => 1,
            Self::Leapfrog | Self::Rk2 => 2,
            Self::SspRk3 => 3,
            Self::Rk4 => 4,
        }
    }

    /// Lays out a step; declares the registers it needs in `columns`.
    pub fn plan<D: Domain>(
        self,
        columns: &mut Columns,
        evolution: &Evolution,
        evaluation: &[Stage<D>],
    ) -> Plan<D> {
        match self {
            Self::Euler => euler::explicit(evolution, evaluation),
            Self::SymplecticEuler => euler::symplectic(evolution, evaluation),
            Self::Leapfrog => leapfrog::leapfrog(columns, evolution, evaluation),
            Self::Rk2 => runge_kutta::rk2(columns, evolution, evaluation),
            Self::SspRk3 => runge_kutta::ssp_rk3(columns, evolution, evaluation),
            Self::Rk4 => runge_kutta::rk4(columns, evolution, evaluation),
        }
    }
}

impl std::str::FromStr for Integrator {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|i| i.name() == name).ok_or_else(|| {
            let all: Vec<_> = Self::ALL.iter().map(|i| i.name()).collect();
            format!("no integrator {name:?}; there are {}", all.join(", "))
        })
    }
}

/// A step, what must be computed once before the first one, and what when somebody looks.
pub struct Plan<D: Domain> {
    /// Run once before the first step, without advancing time.
    pub prologue: Option<Step<D>>,
    /// The step.
    pub step: Step<D>,
    /// Rate stages that compute fields from the state for those who look at it: run before
    /// monitors, dumps and criteria ([`crate::Simulation::derive`]), and in no other step.
    pub derived: Option<Step<D>>,
}

impl<D: Domain> From<Step<D>> for Plan<D> {
    fn from(step: Step<D>) -> Self {
        Self { prologue: None, step, derived: None }
    }
}
