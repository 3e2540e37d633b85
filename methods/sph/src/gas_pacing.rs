//! Time step control of gas dynamics.

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Pace, Pacing, Real, Whole};

use crate::fields::Fields;
use crate::pacing::within_skin;
use crate::physics::Fluid;
use crate::scheme::Scheme;
use crate::state_equation::StateEquation;

/// Time step from the fastest signals and accelerations, each with the smoothing length where it is.
#[derive(Clone, Debug)]
pub(crate) struct GasPacing<T, P> {
    fields: Fields<T, P>,
    /// `eta m^(1/d)`: smoothing length times the root of the density.
    scale: f64,
    heat_ratio: f64,
    /// How much of the approach of particles adds to the speed of signals.
    approach: f64,
    /// Magnitude of the body acceleration, m/s^2.
    body_acceleration: f64,
    courant_number: f64,
    most_steps: u64,
}

impl<T: Real, P: Real> GasPacing<T, P> {
    pub fn new(
        fields: &Fields<T, P>,
        fluid: &Fluid,
        scheme: &Scheme,
        mass: f64,
        approach: f64,
        body_acceleration: f64,
    ) -> Self {
        let dims = fields.position.len() as f64;
        let heat_ratio = match fluid.state_equation {
            StateEquation::IdealGas { heat_ratio } => heat_ratio,
            _ => 1.0,
        };
        Self {
            fields: fields.clone(),
            scale: scheme.smoothing_ratio * mass.powf(1.0 / dims),
            heat_ratio,
            approach,
            body_acceleration,
            courant_number: scheme.courant_number,
            most_steps: 20,
        }
    }
}

impl<T: Real, P: Real> Pacing<Cells<P>> for GasPacing<T, P> {
    /// `dt = C min(0.5 h / v_sig, 0.25 sqrt(h / a))` over all particles, with the fastest signal of
    /// a particle `v_sig`, at least twice its sound speed (Monaghan 1997, section 5).
    fn pace(&mut self, whole: &mut Whole<'_, Cells<P>>) -> Result<Pace, Fault> {
        let fields = &self.fields;
        let dims = fields.position.len() as f64;
        let speed = crate::measure::largest_speed(whole, fields);
        // Signals and accelerations are not known before the first step: any two particles might
        // meet. Look again after it.
        let is_first = whole.step == 0;
        let meeting = if is_first { 2.0 * self.approach * speed } else { 0.0 };
        let excess = self.heat_ratio * (self.heat_ratio - 1.0);
        let [frequency, curvature, acceleration] = whole.max(|near| {
            let density = near.state(fields.density).own().whole();
            let energy = fields.energy.map(|e| near.state(e).own().whole());
            let signal = fields.signal_speed.map(|s| near.rate(s).own().whole());
            let mut most = [0.0f64; 3];
            for i in 0..density.len() {
                let h = self.scale * density[i].as_f64().powf(-1.0 / dims);
                let sound = (excess * energy.map_or(0.0, |e| e[i].as_f64().max(0.0))).sqrt();
                let known = signal.map_or(0.0, |s| s[i].as_f64());
                let signal = (2.0 * sound + meeting).max(known);
                let squared: f64 = fields
                    .acceleration
                    .iter()
                    .map(|&a| near.rate(a).own().whole()[i].as_f64().powi(2))
                    .sum();
                let a = squared.sqrt().max(self.body_acceleration);
                for (most, x) in most.iter_mut().zip([signal / h, a / h, a]) {
                    *most = if x > *most || x.is_nan() { x } else { *most };
                }
            }
            most
        });
        if !(speed.is_finite() && acceleration.is_finite() && frequency.is_finite()) {
            return Err(Fault::new(format!(
                "largest speed {speed} m/s, acceleration {acceleration} m/s^2 and rate of signals \
                 {frequency} 1/s must be finite"
            )));
        }
        let stable = self.courant_number * (0.5 / frequency).min(0.25 / curvature.sqrt());
        let most_steps = if is_first { 1 } else { self.most_steps };
        Ok(within_skin(stable, most_steps, whole.domain.slack(), speed, acceleration))
    }
}
