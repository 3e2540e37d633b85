//! A rate stage of SPH: for every particle gather its neighbours once, then let every term of
//! the scene run over them.

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::CellBlock;
use finegrain_framework::{ColumnId, Domain, Fault, Handle, Moment, Near, RateStage, Rates, Real};

use crate::fields::{Fields, symmetric};
use crate::kernel::Kernel;
use crate::neighbourhood::{Candidates, Gathered, Neighbours, Particle};
use crate::term::continuity::continuity;
use crate::term::momentum::{pressure_gradient, stress_divergence};
use crate::term::{Term, Work};
use crate::wall::{Extrapolation, NoSlip};

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
    work: Work<T>,
}

impl<T: Real, const D: usize> Default for Scratch<T, D> {
    fn default() -> Self {
        Self {
            candidates: Candidates::default(),
            neighbours: Neighbours::default(),
            work: Work::default(),
        }
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

    fn sees_velocity_in_bodies(&self) -> bool {
        self.has(|t| matches!(t, Term::StrainRate(_) | Term::MorrisViscosity(_)))
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
        let Scratch { candidates, neighbours, work } = scratch;
        let first = near.spans()[0].start;
        for cell in block.cells() {
            candidates.collect(&self.gathered, near, block, cell, self.kernel.support_radius());
            for k in 0..cell.span.len() {
                let particle = candidates.particle(&self.gathered, k);
                neighbours.gather(&self.gathered, candidates, &particle, &self.kernel);
                let sums = self.sum(&particle, neighbours, work);
                written.store(cell.span.start - first + k, &sums);
            }
        }
    }

    /// All terms for one particle.
    #[inline(always)]
    fn sum(&self, i: &Particle<T, D>, near: &Neighbours<T, D>, work: &mut Work<T>) -> Sums<T, D> {
        let mass = self.particle_mass;
        let is_wall = i.wall_depth > T::zero();
        let no_slip = match &self.no_slip {
            Some(no_slip) if !is_wall && self.sees_velocity_in_bodies() => no_slip.at(i.position),
            _ => Extrapolation::none(),
        };
        let mut sums = Sums {
            density_rate: T::zero(),
            acceleration: self.body_acceleration.unwrap_or([T::zero(); D]),
            stress_term: [T::zero(); 6],
            energy_rate: T::zero(),
        };
        for term in &self.terms {
            let added = match term {
                Term::Continuity => {
                    sums.density_rate = continuity(i, near, work, mass);
                    continue;
                }
                Term::StrainRate(term) => {
                    let density = mass / i.volume;
                    sums.stress_term = term.stress_term(i, near, work, density, &no_slip);
                    continue;
                }
                Term::Energy(term) => {
                    sums.energy_rate = term.rate(i, near, work, mass, mass / i.volume);
                    continue;
                }
                Term::PressureGradient => pressure_gradient(i, near, work, mass),
                Term::StressDivergence => stress_divergence(i, near, work, mass),
                Term::MorrisViscosity(term) => {
                    let density = mass / i.volume;
                    term.acceleration(i, near, work, density, &no_slip)
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
