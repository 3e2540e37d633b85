//! Whole-domain work of SPH: sorting particles into cells, and time step control.

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Pace, Pacing, Real, Whole, WholeStage};

use crate::fields::Fields;

/// Sorts particles into cells at the beginning of every pace.
pub(crate) struct Sort;

impl<P: Real> WholeStage<Cells<P>> for Sort {
    fn name(&self) -> &str {
        "sort into cells"
    }

    fn run(&mut self, whole: &mut Whole<'_, Cells<P>>) -> Result<(), Fault> {
        whole.domain.sort(whole.columns, whole.team)
    }
}

/// Time step from sound speed, viscosity and acceleration, and the number of steps that particles
/// surely stay within the skin.
#[derive(Clone, Debug)]
pub(crate) struct TimeStepControl<T, P> {
    pub fields: Fields<T, P>,
    /// Smoothing length, m.
    pub smoothing_length: f64,
    /// Sound speed, m/s.
    pub sound_speed: f64,
    /// Kinematic viscosity or diffusivity of the pressure, the larger, m^2/s; 0 without.
    pub diffusivity: f64,
    /// Magnitude of the body acceleration, m/s^2.
    pub body_acceleration: f64,
    /// Largest rate at which velocities are damped, 1/s; 0 without.
    pub damping_rate: f64,
    /// Fraction of each limit that is used.
    pub courant_number: f64,
    /// Strength of the transport velocity, as in the scheme.
    pub transport: f64,
    /// Most steps before particles are sorted and the time step is looked at again.
    pub most_steps: u64,
}

impl<T: Real, P: Real> Pacing<Cells<P>> for TimeStepControl<T, P> {
    /// `dt = C min(0.25 h / (c + v_max), 0.125 h^2 / nu, 0.25 sqrt(h / a_max))` (Morris, Fox & Zhu
    /// 1997, eqs. 29 to 31, with the speed added to that of sound), and half of the time in which
    /// velocities are damped.
    fn pace(&mut self, whole: &mut Whole<'_, Cells<P>>) -> Result<Pace, Fault> {
        let fields = &self.fields;
        let [v2_max, a2_max, drift2_max] = whole.max(|near| {
            let mut most = [0.0f64; 3];
            for i in 0..near.spans()[0].len() {
                let mut squared = [0.0f64; 3];
                for (&v, &a) in fields.velocity.iter().zip(&fields.acceleration) {
                    squared[0] += near.state(v).own().whole()[i].as_f64().powi(2);
                    squared[1] += near.rate(a).own().whole()[i].as_f64().powi(2);
                }
                for &drift in &fields.drift {
                    squared[2] += near.rate(drift).own().whole()[i].as_f64().powi(2);
                }
                for (most, x) in most.iter_mut().zip(squared) {
                    *most = if x > *most || x.is_nan() { x } else { *most };
                }
            }
            most
        });
        let (speed, acceleration) = (v2_max.sqrt(), a2_max.sqrt().max(self.body_acceleration));
        let h = self.smoothing_length;
        let sound_limit = 0.25 * h / (self.sound_speed + speed);
        let viscous_limit = 0.125 * h * h / self.diffusivity;
        let force_limit = 0.25 * (h / acceleration).sqrt();
        let damping_limit = 0.5 / self.damping_rate;
        if !(speed.is_finite() && acceleration.is_finite()) {
            return Err(Fault::new(format!(
                "largest speed {speed} m/s and acceleration {acceleration} m/s^2 must be finite"
            )));
        }
        if speed > self.sound_speed {
            return Err(Fault::new(format!(
                "largest speed {speed:.3e} m/s; it must be at most the sound speed, {:.3e} m/s: the \
                 time step is past stability, or the sound speed too low",
                self.sound_speed
            )));
        }
        // Shifted particles are faster than the fluid. The first drift is not known yet: at a plane
        // surface of any fluid, which is more uneven than what a scene starts from, that of the
        // transport velocity is 0.14 (1-D integral of the kernel over 0.25 h) c.
        let first = if whole.step == 0 { 0.14 * self.transport * self.sound_speed } else { 0.0 };
        let speed = speed + drift2_max.sqrt().max(first);
        let stable = self.courant_number
            * sound_limit.min(viscous_limit).min(force_limit).min(damping_limit);
        // Accelerations are not known before the first step: look again after it.
        let most_steps = if whole.step == 0 { 1 } else { self.most_steps };
        Ok(within_skin(stable, most_steps, whole.domain.slack(), speed, acceleration))
    }
}

/// The pace of time steps of at most `stable`, with which no particle moves by more than `slack`
/// before particles are sorted again.
pub(crate) fn within_skin(
    stable: f64,
    most_steps: u64,
    slack: f64,
    speed: f64,
    acceleration: f64,
) -> Pace {
    // A particle moves by at most t v + t^2 a in the time t, a factor of two allowed for
    // accelerations that grow meanwhile. That must stay within the skin.
    let slack = 0.8 * slack;
    let reach = |time: f64| time * speed + time * time * acceleration;
    let skin_limit = 2.0 * slack / (speed + (speed * speed + 4.0 * acceleration * slack).sqrt());
    let dt = stable.min(skin_limit);
    let mut steps = 1;
    while steps < most_steps && reach((steps + 1) as f64 * dt) < slack {
        steps += 1;
    }
    Pace { dt, steps }
}
