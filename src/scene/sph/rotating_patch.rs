//! The rotating square patch in SPH: a square lattice.
//!
//! The defaults: under tension, sums of pressures pull particles into clumps. Tensile control makes
//! differences of them inside of the fluid, shifting keeps the particles even where the flow
//! draws them out to filaments, and the delta-SPH diffusion takes the noise out of the pressure. With Wendland's C2
//! and a smoothing length of two spacings pairs form in the filaments: at omega t = 4 the closest were 0.003 spacings
//! apart, instead of 0.5. The artificial viscosity `alpha h c / 8` of half of that length takes more of `alpha`.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Simulation, Whole};
use finegrain_sph::{Fields, Fluid, Packing, Physics, Sph, Start, measure};

use super::{Flow, SphScene, free_surface};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::rotating_patch::{
    self, ANGULAR_VELOCITY, CENTRE_PRESSURE, DENSITY, RotatingPatch, SIDE,
};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    free_surface::parameters(
        &[&rotating_patch::PARAMETERS],
        &[("smoothing_ratio", 1.0), ("artificial_viscosity", 0.06)],
        &[("kernel", "quintic-spline"), ("tension", "control"), ("shifting", "on")],
    )
}

prepare_with!(build);

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let scene = RotatingPatch::new(parameters);
    let spacing = SIDE / scene.resolution;
    let lattice = Packing::Square.fit([SIDE; 3], spacing)?;
    let positions: Vec<_> =
        lattice.positions().map(|[x, y, _]| [x - 0.5 * SIDE, y - 0.5 * SIDE, 0.0]).collect();
    let start = Start {
        region: Region {
            lower: vec![-1.5 * SIDE; 2],
            upper: vec![1.5 * SIDE; 2],
            periodic: vec![false; 2],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        velocities: positions.iter().map(|&x| scene.velocity(x)).collect(),
        positions,
    };
    // That of the corners.
    let speed = ANGULAR_VELOCITY * SIDE * 0.5f64.sqrt();
    let fluid = Fluid {
        density: DENSITY,
        sound_speed: speed / parameters.number("mach"),
        kinematic_viscosity: 0.0,
        state_equation: free_surface::state_equation(parameters),
    };
    let scheme = free_surface::scheme(parameters, speed);
    let mut sph = Sph::<T, P>::new(&start, &fluid, &Physics::default(), &scheme)?;
    free_surface::set_pressure(&mut sph, &fluid, &start.positions, |x| scene.pressure(x));
    let description = super::description("rotating-patch", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(PatchFlow { scene, fluid }), description })
}

struct PatchFlow {
    scene: RotatingPatch,
    fluid: Fluid,
}

/// Angular momentum about the origin, kg m^2/s (per m).
fn angular_momentum<T: Real, P: Real>(
    whole: &mut Whole<'_, Cells<P>>,
    fields: &Fields<T, P>,
    mass: f64,
) -> f64 {
    let [sum] = whole.sum(|near| {
        let [x, y] = [0, 1].map(|a| near.state(fields.position[a]).own().whole());
        let [u, v] = [0, 1].map(|a| near.state(fields.velocity[a]).own().whole());
        let of = |i: usize| x[i].as_f64() * v[i].as_f64() - y[i].as_f64() * u[i].as_f64();
        [(0..x.len()).map(of).sum()]
    });
    sum * mass
}

impl<T: Real, P: Real> Flow<T, P> for PatchFlow {
    fn end_time(&self) -> f64 {
        2.0 / ANGULAR_VELOCITY
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let every = Every::Time(0.005 / ANGULAR_VELOCITY);
        let run = free_surface::monitor_energy(run, every, fields, self.fluid, mass, |_| 0.0);
        let (fields, fluid) = (fields.clone(), self.fluid);
        let radius = 2.0 * Flow::<T, P>::spacing(self);
        let scale = DENSITY * (ANGULAR_VELOCITY * SIDE).powi(2);
        let columns =
            ["angular_momentum", "centre_pressure", "momentum_x", "momentum_y", "largest_speed"];
        run.monitor("patch", every, columns, move |whole| {
            let [x, y, _] = measure::totals(whole, &fields, mass).momentum;
            [
                angular_momentum(whole, &fields, mass),
                free_surface::pressure_near(whole, &fields, &fluid, [0.0; 3], radius) / scale,
                x,
                y,
                measure::largest_speed(whole, &fields),
            ]
        })
    }

    /// `voids`: area of holes wider than two spacings over that of the fluid; `angular_momentum`
    /// over that at the beginning; `centre_pressure`, the mean over a tenth of `1 / omega` at the
    /// beginning, in which the exact one does not change; `energy_growth` and `energy_change` over
    /// the energy at the beginning.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        _: f64,
    ) {
        let spacing = Flow::<T, P>::spacing(self);
        report.result("voids", free_surface::voids(simulation, fields, spacing, spacing), None);
        let history = &summary.histories[1];
        let column = |name| history.column(name).map(Iterator::collect::<Vec<f64>>);
        if let Some(turning) = column("angular_momentum")
            && let (Some(first), Some(last)) = (turning.first(), turning.last())
        {
            report.result("angular_momentum", last / first, Some(1.0));
        }
        if let Some(pressure) = column("centre_pressure") {
            let is_early = |&&t: &&f64| t <= 0.1 / ANGULAR_VELOCITY;
            let early = history.times().iter().take_while(is_early).count();
            let mean = pressure[..early].iter().sum::<f64>() / early as f64;
            report.result("centre_pressure", mean, Some(CENTRE_PRESSURE));
        }
        let first = summary.histories[0].column("kinetic_energy").and_then(|mut e| e.next());
        if let Some(scale) = first {
            free_surface::judge_energy(report, &summary.histories, scale);
        }
    }

    fn title(&self) -> String {
        "Rotating square patch".to_owned()
    }

    fn spacing(&self) -> f64 {
        SIDE / self.scene.resolution
    }
}
