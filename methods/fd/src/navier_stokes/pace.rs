//! Time steps that follow the flow.

use finegrain_framework::space::Grid;
use finegrain_framework::{Fault, Integrator, Pace, Pacing, Real, State, Whole};

use super::{FlowEnd, NavierStokes};
use crate::mesh::{Mesh, Spread};
use crate::model::Compiled;
use crate::operator::staggered::StaggeredOrder;
use crate::operator::{central, value};
use crate::stability::{self, Symbol};

/// The longest stable time step.
pub(super) struct Limit {
    integrator: Integrator,
    symbol: Symbol,
    /// For each axis: of the wave that is carried fastest, the rate over the speed, 1/m.
    turn: [f64; 3],
    /// For each axis: the fastest decay by viscosity, 1/s.
    decay: [f64; 3],
}

impl Limit {
    pub fn new(equation: &NavierStokes, mesh: &Mesh) -> Self {
        let (turn, order) = match equation.order {
            StaggeredOrder::Second => (1.0, central::Order::Second),
            // The largest of 9/8 sin(a) - 1/24 sin(3 a).
            StaggeredOrder::Fourth => (7.0 / 6.0, central::Order::Fourth),
        };
        let terms = central::second_derivative(order).into_iter().zip(1..);
        let second: f64 = terms.map(|(b, k)| if k % 2 == 1 { 4.0 * value(b) } else { 0.0 }).sum();
        // Next to a wall, where a ghost point lies on a parabola, `u_k = (-r)^k` decays at `2 + r + 1 / r` with
        // `r^2 / 3 + 2 r = 1`.
        let at_wall = 8.0 / 3f64.sqrt();
        let second = |a: usize| if mesh.is_periodic()[a] { second } else { at_wall.max(second) };
        let of_axis = |a: usize, rate: f64| if a < mesh.dims() { rate } else { 0.0 };
        let h = mesh.spacing();
        Self {
            integrator: equation.integrator,
            symbol: Symbol::new(equation.order),
            turn: [0, 1, 2].map(|a| of_axis(a, turn / h[a])),
            decay: [0, 1, 2].map(|a| of_axis(a, equation.viscosity * second(a) / (h[a] * h[a]))),
        }
    }

    /// With components of the velocity up to `speeds`, m/s.
    pub fn of(&self, speeds: [f64; 3]) -> f64 {
        let turns = [0, 1, 2].map(|a| self.turn[a] * speeds[a]);
        stability::advection_diffusion_limit(self.integrator, &self.symbol, turns, self.decay)
    }
}

/// Time steps that are a fraction of the longest that is stable.
pub(super) struct FlowPace<T: Real> {
    courant: f64,
    limit: Limit,
    velocity: Vec<State<T>>,
    /// What walls drag the fluid along with, so that steps are short enough from the first on.
    wall_speeds: [f64; 3],
}

impl<T: Real> FlowPace<T> {
    /// Steps between changes of the time step.
    const STEPS: u64 = 5;

    pub fn new(equation: &NavierStokes, mesh: &Mesh, velocity: &[State<T>]) -> Self {
        let sides = mesh.sides().iter().zip(&equation.ends);
        let ends = sides.filter(|(side, _)| side.spread == Spread::Cells).flat_map(|(_, end)| end);
        let wall_speeds = ends.fold([0.0f64; 3], |most, end| match end {
            FlowEnd::Wall(velocity) => std::array::from_fn(|a| most[a].max(velocity[a].abs())),
            FlowEnd::Inflow | FlowEnd::Outflow => most,
        });
        let (courant, limit) = (equation.courant, Limit::new(equation, mesh));
        Self { courant, limit, velocity: velocity.to_vec(), wall_speeds }
    }
}

impl<T: Compiled> Pacing<Grid> for FlowPace<T> {
    fn pace(&mut self, whole: &mut Whole<'_, Grid>) -> Result<Pace, Fault> {
        let speeds = whole.max(|near| {
            let mut most = self.wall_speeds;
            for (most, &u) in most.iter_mut().zip(&self.velocity) {
                let u = near.state(u).own();
                for k in 0..near.spans().len() {
                    for u in u.span(k) {
                        let speed = u.as_f64().abs();
                        *most = if speed > *most || speed.is_nan() { speed } else { *most };
                    }
                }
            }
            most
        });
        let dt = self.courant * self.limit.of(speeds);
        if dt > 0.0 && dt.is_finite() {
            return Ok(Pace { dt, steps: Self::STEPS });
        }
        Err(Fault::new(format!(
            "no time step is stable with speeds of {speeds:?} m/s: the velocity must be finite everywhere"
        )))
    }
}
