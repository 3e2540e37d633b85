//! Pressure and velocity, for those who look.

use finegrain_framework::space::Grid;
use finegrain_framework::{
    ColumnId, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real, State,
};

use crate::acceleration::Acceleration;
use crate::around::Around;
use crate::lattice::SOUND_SPEED_SQUARED;
use crate::physics::Streaming;

/// From the populations after the collision: `p = c_s^2 (rho - 1)` and, because the collision has
/// added the whole force where the velocity has half of it,
/// `u = sum c f / rho - a / 2` (Guo, Zheng & Shi 2002, eq. 6b).
pub(crate) struct Derived<T> {
    pub populations: Vec<State<T>>,
    pub velocities: &'static [[i32; 3]],
    pub streaming: Streaming,
    pub solid: State<u8>,
    pub pressure: Rate<T>,
    pub velocity: Vec<Rate<T>>,
    pub acceleration: Acceleration,
    /// One lattice unit of velocity, m/s.
    pub unit_velocity: f64,
    /// One lattice unit of pressure, Pa.
    pub unit_pressure: f64,
}

impl<T: Real> RateStage<Grid> for Derived<T> {
    /// Density beyond one and momentum along a row, and what one population adds.
    type Scratch = ([Vec<T>; 4], Vec<T>);

    fn name(&self) -> &str {
        "lbm pressure and velocity"
    }

    fn writes(&self) -> Vec<ColumnId> {
        let velocity = self.velocity.iter().map(|v| v.id());
        [self.pressure.id()].into_iter().chain(velocity).collect()
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        (sums, leaving): &mut ([Vec<T>; 4], Vec<T>),
        moment: &Moment,
    ) -> Result<(), Fault> {
        let nx = near.domain().shape()[0];
        let views: Vec<_> = self.populations.iter().map(|&f| near.state(f)).collect();
        leaving.resize(nx, T::zero());
        let solid = near.rows(self.solid);
        let mut pressure = rates.rows(self.pressure);
        let mut velocity: Vec<_> = self.velocity.iter().map(|&v| rates.rows(v)).collect();
        for (j, k) in near.sub_domain().rows() {
            for sum in sums.iter_mut() {
                sum.clear();
                sum.resize(nx, T::zero());
            }
            let around = Around::new(near, &views, self.velocities, self.streaming, (j, k));
            for (q, c) in self.velocities.iter().enumerate() {
                around.leaving(q, leaving);
                let [excess, momentum @ ..] = &mut *sums;
                for (sum, &f) in excess.iter_mut().zip(&*leaving) {
                    *sum += f;
                }
                for (momentum, &c) in momentum.iter_mut().zip(c).filter(|(_, c)| **c != 0) {
                    let c = T::of(f64::from(c));
                    for (sum, &f) in momentum.iter_mut().zip(&*leaving) {
                        *sum += c * f;
                    }
                }
            }
            let solid = solid.row(j as isize, k as isize);
            for x in 0..nx {
                let is_fluid = solid[x] == 0;
                let excess = sums[0][x].as_f64();
                let value = SOUND_SPEED_SQUARED * excess * self.unit_pressure;
                pressure.row(j, k)[x] = if is_fluid { T::of(value) } else { T::zero() };
                let acceleration = self.acceleration.at([x, j, k], moment.time);
                for (a, velocity) in velocity.iter_mut().enumerate() {
                    let u = sums[1 + a][x].as_f64() / (1.0 + excess) - 0.5 * acceleration[a];
                    let u = T::of(u * self.unit_velocity);
                    velocity.row(j, k)[x] = if is_fluid { u } else { T::zero() };
                }
            }
        }
        Ok(())
    }
}
