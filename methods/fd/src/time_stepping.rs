//! How time is stepped: explicitly or, where diffusion is stiff, implicitly.

use std::fmt;
use std::str::FromStr;

use finegrain_framework::Integrator;

/// An implicit scheme for `u' = f(u, t)`, with `f_n = f(u_n, t_n)`. Where everything decays all are stable with any
/// time step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Implicit {
    /// `u_{n+1} = u_n + dt f_{n+1}`: first order. What is stiff is gone after a step.
    BackwardEuler,
    /// `u_{n+1} = u_n + dt/2 (f_n + f_{n+1})` (Crank & Nicolson 1947, Proc. Camb. Phil. Soc. 43): second order. What is
    /// stiff is *not* damped but changes its sign in every step, so that it rings after a start that is not smooth.
    CrankNicolson,
    /// `u_{n+1} = 4/3 u_n - 1/3 u_{n-1} + 2/3 dt f_{n+1}` (Curtiss & Hirschfelder 1952, Proc. Natl. Acad. Sci. 38):
    /// second order, and what is stiff is gone after two steps. The first step is one of backward Euler, whose error
    /// of `dt^2` is made only once. Its time steps are all alike: they are not shortened to hit an end.
    Bdf2,
}

impl Implicit {
    /// All implicit schemes.
    pub const ALL: [Self; 3] = [Self::BackwardEuler, Self::CrankNicolson, Self::Bdf2];

    /// The name used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::BackwardEuler => "backward-euler",
            Self::CrankNicolson => "crank-nicolson",
            Self::Bdf2 => "bdf2",
        }
    }

    /// Order of accuracy for smooth solutions.
    pub fn order(self) -> u32 {
        if self == Self::BackwardEuler { 1 } else { 2 }
    }
}

/// How an equation that may be stiff is stepped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TimeStepping {
    /// With a longest stable time step.
    Explicit(Integrator),
    /// With any time step, by solving a linear system; needs the cargo feature `implicit`.
    Implicit(Implicit),
}

impl TimeStepping {
    /// The name used in scenes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Explicit(integrator) => integrator.name(),
            Self::Implicit(scheme) => scheme.name(),
        }
    }
}

impl From<Integrator> for TimeStepping {
    fn from(integrator: Integrator) -> Self {
        Self::Explicit(integrator)
    }
}

impl From<Implicit> for TimeStepping {
    fn from(scheme: Implicit) -> Self {
        Self::Implicit(scheme)
    }
}

impl FromStr for TimeStepping {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let implicit = Implicit::ALL.into_iter().map(Self::Implicit);
        let mut all = Integrator::ALL.into_iter().map(Self::Explicit).chain(implicit);
        all.clone().find(|stepping| stepping.name() == name).ok_or_else(|| {
            let names: Vec<_> = all.by_ref().map(Self::name).collect();
            format!("no time stepping {name:?}; there are {}", names.join(", "))
        })
    }
}

impl fmt::Display for TimeStepping {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
