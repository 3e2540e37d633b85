//! A rate stage of SPH: for every particle gather its neighbours once, then let every term of
//! the scene run over them.

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::CellBlock;
use finegrain_framework::{ColumnId, Domain, Fault, Handle, Moment, Near, RateStage, Rates, Real};

use crate::fields::{Fields, symmetric};
use crate::kernel::Kernel;
use crate::neighbourhood::{Candidates, Gathered, Neighbours, Particle};
use crate::term::Term;
use crate::term::continuity::continuity;
use crate::term::momentum::{pressure_gradient, stress_divergence};
use crate::wall::NoSlip;

/// One sweep over all pairs, in `D` dimensions.
#[derive(Clone, Debug)]
pub(crate) struct Sweep<T, const D: usize> {
    pub name: String,
    pub fields: Fields<T>,
    pub kernel: Kernel<T>,
    pub terms: Vec<Term<T>>,
    pub gathered: Gathered<T>,
    pub particle_mass: T,
    /// Acceleration of the fluid by a body force, m/s^2; only in the sweep that writes the
    /// acceleration.
    pub body_acceleration: Option<[T; D]>,
    pub no_slip: Option<NoSlip<T>>,
}

/// Working memory of one worker.
pub(crate) struct Scratch<T, const D: usize> {
    candidates: Candidates<T, D>,
    neighbours: Neighbours<T, D>,
}

impl<T: Real, const D: usize> Default for Scratch<T, D> {
    fn default() -> Self {
        Self { candidates: Candidates::default(), neighbours: Neighbours::default() }
    }
}

/// What the terms of a sweep add up to for one particle.
struct Sums<T, const D: usize> {
    density_rate: T,
    acceleration: [T; D],
    stress_term: [T; 6],
    energy_rate: T,
}

/// A sub-domain's own part of the rates that a sweep writes.
struct Written<'a, T> {
    density_rate: Option<&'a mut [T]>,
    acceleration: Vec<&'a mut [T]>,
    stress_term: Vec<&'a mut [T]>,
    energy_rate: Option<&'a mut [T]>,
}

impl<T: Real, const D: usize> Sweep<T, D> {
    fn has(&self, wanted: impl Fn(&Term<T>) -> bool) -> bool {
        self.terms.iter().any(wanted)
    }

    fn writes_density_rate(&self) -> bool {
        self.has(|t| matches!(t, Term::Continuity))
    }

    fn writes_stress(&self) -> bool {
        self.has(|t| matches!(t, Term::StrainRate(_)))
    }

    fn writes_energy_rate(&self) -> bool {
        self.has(|t| matches!(t, Term::Energy(_)))
    }

    /// Rates of all particles of a sub-domain.
    #[inline(always)]
    fn run(
        &self,
        near: &Near<'_, Cells<T>>,
        block: &CellBlock<'_, T>,
        written: &mut Written<'_, T>,
        scratch: &mut Scratch<T, D>,
    ) {
        let Scratch { candidates, neighbours } = scratch;
        let first = near.spans()[0].start;
        for cell in block.cells() {
            candidates.collect(&self.gathered, near, block, cell, self.kernel.support_radius());
            for k in 0..cell.span.len() {
                let particle = candidates.particle(&self.gathered, k);
                neighbours.gather(&self.gathered, candidates, &particle, &self.kernel);
                let sums = self.sum(&particle, neighbours);
                written.store(cell.span.start - first + k, &sums);
            }
        }
    }

    /// All terms for one particle.
    #[inline(always)]
    fn sum(&self, i: &Particle<T, D>, near: &Neighbours<T, D>) -> Sums<T, D> {
        let mass = self.particle_mass;
        let is_wall = i.wall_depth > T::zero();
        let has_walls = self.no_slip.is_some();
        // How much of v_i - v_j a wall particle at a depth adds to it: depth_j / distance_i, so
        // that the velocity falls linearly through zero at the surface.
        let (most, per_depth) = match &self.no_slip {
            Some(no_slip) if !is_wall => {
                let mut x = [0.0; 3];
                for a in 0..D {
                    x[a] = i.position[a].as_f64();
                }
                let distance = T::of(no_slip.walls.signed_distance(x));
                (no_slip.most, T::one() / distance.max(no_slip.least_distance))
            }
            _ => (T::zero(), T::zero()),
        };
        let extrapolation = move |depth: T| (depth * per_depth).min(most);
        let mut sums = Sums {
            density_rate: T::zero(),
            acceleration: self.body_acceleration.unwrap_or([T::zero(); D]),
            stress_term: [T::zero(); 6],
            energy_rate: T::zero(),
        };
        for term in &self.terms {
            let added = match term {
                Term::Continuity => {
                    sums.density_rate = continuity(i, near, mass);
                    continue;
                }
                Term::StrainRate(term) => {
                    let density = mass / i.volume;
                    sums.stress_term = term.stress_term(i, near, density, extrapolation, has_walls);
                    continue;
                }
                Term::Energy(term) => {
                    sums.energy_rate = term.rate(i, near, mass, mass / i.volume);
                    continue;
                }
                Term::PressureGradient => pressure_gradient(i, near, mass),
                Term::StressDivergence => stress_divergence(i, near, mass, has_walls),
                Term::MorrisViscosity(term) => {
                    let density = mass / i.volume;
                    term.acceleration(i, near, density, extrapolation, has_walls)
                }
            };
            for a in 0..D {
                sums.acceleration[a] += added[a];
            }
        }
        if is_wall {
            sums.acceleration = [T::zero(); D];
        }
        sums
    }
}

impl<T: Real> Written<'_, T> {
    #[inline(always)]
    fn store<const D: usize>(&mut self, i: usize, sums: &Sums<T, D>) {
        if let Some(density_rate) = &mut self.density_rate {
            density_rate[i] = sums.density_rate;
        }
        for (column, value) in self.acceleration.iter_mut().zip(sums.acceleration) {
            column[i] = value;
        }
        for (column, value) in self.stress_term.iter_mut().zip(sums.stress_term) {
            column[i] = value;
        }
        if let Some(energy_rate) = &mut self.energy_rate {
            energy_rate[i] = sums.energy_rate;
        }
    }
}

/// A sub-domain's share of a sweep, to be compiled for every instruction set.
struct Task<'s, 'n, T: Real, const D: usize> {
    sweep: &'s Sweep<T, D>,
    near: &'s Near<'n, Cells<T>>,
    block: &'s CellBlock<'n, T>,
    written: &'s mut Written<'n, T>,
    scratch: &'s mut Scratch<T, D>,
}

impl<T: Real, const D: usize> pulp::WithSimd for Task<'_, '_, T, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.sweep.run(self.near, self.block, self.written, self.scratch);
    }
}

impl<T: Real, const D: usize> RateStage<Cells<T>> for Sweep<T, D> {
    type Scratch = Scratch<T, D>;

    fn name(&self) -> &str {
        &self.name
    }

    fn writes(&self) -> Vec<ColumnId> {
        let mut ids = Vec::new();
        if self.writes_density_rate() {
            ids.push(self.fields.density_rate.id());
        }
        if self.body_acceleration.is_some() {
            ids.extend(self.fields.acceleration.iter().map(|a| a.id()));
        }
        if self.writes_stress() {
            ids.extend(self.fields.stress_term[..symmetric(D)].iter().map(|s| s.id()));
        }
        if self.writes_energy_rate() {
            ids.extend(self.fields.energy_rate.iter().map(|e| e.id()));
        }
        ids
    }

    fn rate(
        &self,
        near: &Near<'_, Cells<T>>,
        rates: &mut Rates<'_, Cells<T>>,
        scratch: &mut Self::Scratch,
        _: &Moment,
    ) -> Result<(), Fault> {
        let block = near.domain().sub_domain(near.id());
        let fields = &self.fields;
        let mut written = Written {
            density_rate: self
                .writes_density_rate()
                .then(|| rates.column(fields.density_rate).whole()),
            acceleration: if self.body_acceleration.is_some() {
                fields.acceleration.iter().map(|&a| rates.column(a).whole()).collect()
            } else {
                Vec::new()
            },
            stress_term: if self.writes_stress() {
                fields.stress_term.iter().map(|&s| rates.column(s).whole()).collect()
            } else {
                Vec::new()
            },
            energy_rate: fields
                .energy_rate
                .filter(|_| self.writes_energy_rate())
                .map(|e| rates.column(e).whole()),
        };
        pulp::Arch::new().dispatch(Task {
            sweep: self,
            near,
            block: &block,
            written: &mut written,
            scratch,
        });
        Ok(())
    }
}
