//! What a particle sees of its neighbours: gathered once, into lanes that every term runs over.

use std::ops::Index;

use finegrain_framework::lanes::{Buffer, Found, RECORD};
use finegrain_framework::{Activity, Real};

use crate::gathered::{ABSENT, Layout, Wanted};
use crate::kernel::Kernel;
use crate::kernel::adaptive::Kernels;
use crate::quantity::{Quantity, Values, component};
use crate::surroundings::Surroundings;
use crate::sweep_part::SweepPart;
use crate::wall::{Extrapolation, VelocityInBodies};

/// The particle whose rates are wanted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Particle<T, const D: usize> {
    /// Its place among all that its sub-domain sees.
    pub place: usize,
    pub position: [T; D],
    /// What was gathered of it; 0 for the rest.
    pub values: Values<T>,
    /// How it sees the velocities of wall particles.
    pub no_slip: Extrapolation<T>,
}

impl<T: Real, const D: usize> Default for Particle<T, D> {
    /// None yet.
    fn default() -> Self {
        Self {
            place: 0,
            position: [T::zero(); D],
            values: Values::zero(),
            no_slip: Extrapolation::none(),
        }
    }
}

impl<T: Real, const D: usize> Particle<T, D> {
    /// Whether it is part of a body.
    #[inline(always)]
    pub fn is_wall(&self) -> bool {
        self[Quantity::WallDepth] > T::zero()
    }

    /// A sum over kernel gradients with the correction of Bonet & Lok (1999); only for terms that
    /// read it.
    #[inline(always)]
    pub fn corrected(&self, sum: [T; D]) -> [T; D] {
        let mut corrected = [T::zero(); D];
        for a in 0..D {
            for b in 0..D {
                corrected[a] += self[Quantity::Correction(component(a, b))] * sum[b];
            }
        }
        corrected
    }
}

impl<T: Real, const D: usize> Index<Quantity> for Particle<T, D> {
    type Output = T;

    /// A gathered quantity of its own.
    #[inline(always)]
    fn index(&self, quantity: Quantity) -> &T {
        &self.values[quantity]
    }
}

/// The neighbours of one particle, in lanes; the particle itself is one of them. Padded to whole
/// vectors with neighbours of no effect (kernel and gradient factor 0).
#[derive(Clone, Debug)]
pub(crate) struct Neighbours<T, const D: usize> {
    found: Found,
    /// Lanes in use, padding included.
    padded: usize,
    distance_squared: Buffer<T>,
    gradient_factor: Buffer<T>,
    /// Empty unless every particle has its own smoothing length.
    gradient_factor_of_others: Buffer<T>,
    /// What else terms want; its lanes are empty if none does.
    wanted: Wanted,
    kernel: Buffer<T>,
    gradient: [Buffer<T>; D],
    /// Per page of the records, a lane for each place. In the first, positions have
    /// been replaced by `x_i - x_j`.
    pages: Vec<[Buffer<T>; RECORD]>,
    /// Places in use of every page.
    used: Vec<usize>,
    /// Where quantities are in these pages; `ABSENT` also for the depth in bodies if there are none
    /// around.
    places: [usize; Quantity::COUNT],
}

impl<T: Real, const D: usize> Default for Neighbours<T, D> {
    fn default() -> Self {
        Self {
            found: Found::default(),
            padded: 0,
            distance_squared: Buffer::default(),
            gradient_factor: Buffer::default(),
            gradient_factor_of_others: Buffer::default(),
            wanted: Wanted::default(),
            kernel: Buffer::default(),
            gradient: std::array::from_fn(|_| Buffer::default()),
            pages: Vec::new(),
            used: Vec::new(),
            places: [ABSENT; Quantity::COUNT],
        }
    }
}

impl<T: Real, const D: usize> Neighbours<T, D> {
    /// Makes ready for the particles of a sub-domain that sees bodies, or does not.
    pub fn prepare(&mut self, layout: &Layout, sees_bodies: bool) {
        self.places = layout.places;
        if !sees_bodies {
            self.places[Quantity::WallDepth.index()] = ABSENT;
        }
        self.wanted = layout.wanted;
        self.pages.resize_with(layout.pages.len(), Default::default);
        self.used.clone_from(&layout.pages);
    }

    /// Gathers the particles near the cell at hand that interact with `particle`, with the kernel's
    /// values for them. `longest` is the longest smoothing length of any of them, where they have
    /// their own. They are searched for unless their places are `known`.
    #[inline(always)]
    pub fn gather(
        &mut self,
        surroundings: &Surroundings<T, D>,
        particle: &Particle<T, D>,
        kernels: &Kernels<T, D>,
        longest: T,
        known: Option<&[u16]>,
        activity: &Activity,
    ) {
        // One place where the kernel is evaluated: it is compiled for every smoothing function.
        let (kernel, radius) = match kernels {
            Kernels::Uniform(kernel) => (*kernel, kernel.support_radius()),
            Kernels::Adaptive(kernel) => {
                let own = particle[Quantity::SmoothingLength];
                (kernel.at(own), kernel.support() * own.max(longest))
            }
        };
        self.find(surroundings, particle, radius, known, activity);
        SweepPart::Kernel.begin(activity);
        self.evaluate(&kernel);
        if let Kernels::Adaptive(kernel) = kernels {
            let (count, padded) = (self.found.len(), self.padded);
            let place = self.places[Quantity::SmoothingLength.index()];
            let smoothing_length = &self.pages[place / RECORD][place % RECORD][..padded];
            let factor = &mut self.gradient_factor_of_others[..padded];
            kernel.gradient_factor(&self.distance_squared[..padded], smoothing_length, factor);
            factor[count..].fill(T::zero());
        }
    }

    /// Gathers the particles near the cell at hand that are nearer to `particle` than `radius`, m, and
    /// perhaps some that are little further away; or those at the places that are `known`.
    #[inline(always)]
    pub fn find(
        &mut self,
        surroundings: &Surroundings<T, D>,
        particle: &Particle<T, D>,
        radius: T,
        known: Option<&[u16]>,
        activity: &Activity,
    ) {
        SweepPart::Search.begin(activity);
        match known {
            Some(places) => self.found.recall(places, surroundings.len()),
            None => surroundings.find(particle, radius * Kernel::<T>::cut(), &mut self.found),
        }
        SweepPart::Gather.begin(activity);
        let padded = self.found.padded();
        self.padded = padded;
        if self.distance_squared.len() < padded {
            self.grow(padded);
        }
        let pages = self.pages.iter_mut().zip(&surroundings.pages).zip(&self.used);
        for ((page, records), &used) in pages {
            T::gather(records, &self.found, used, page);
        }
        let distance_squared = &mut self.distance_squared[..padded];
        for a in 0..D {
            let x = particle.position[a];
            let difference = &mut self.pages[0][a][..padded];
            let lanes = difference.iter_mut().zip(&mut *distance_squared);
            if a == 0 {
                for (d, r2) in lanes {
                    *d = x - *d;
                    *r2 = *d * *d;
                }
            } else {
                for (d, r2) in lanes {
                    *d = x - *d;
                    *r2 = d.mul_add(*d, *r2);
                }
            }
        }
    }

    /// The kernel's values for what was found.
    #[inline(always)]
    pub fn evaluate(&mut self, kernel: &Kernel<T>) {
        let (count, padded) = (self.found.len(), self.padded);
        let distance_squared = &self.distance_squared[..padded];
        let gradient_factor = &mut self.gradient_factor[..padded];
        if !self.kernel.is_empty() {
            let values = &mut self.kernel[..padded];
            kernel.evaluate(distance_squared, values, gradient_factor);
            values[count..].fill(T::zero());
        } else {
            kernel.gradient_factor(distance_squared, gradient_factor);
        }
        // The padding repeats a neighbour: it must have no effect.
        gradient_factor[count..].fill(T::zero());
        if self.wanted.gradient {
            for a in 0..D {
                let difference = &self.pages[0][a][..padded];
                let lanes = self.gradient[a][..padded].iter_mut().zip(&*gradient_factor);
                for ((gradient, &factor), &d) in lanes.zip(difference) {
                    *gradient = factor * d;
                }
            }
        }
    }

    #[cold]
    fn grow(&mut self, length: usize) {
        let has_own_lengths = self.places[Quantity::SmoothingLength.index()] != ABSENT;
        let all = self
            .pages
            .iter_mut()
            .flatten()
            .chain([&mut self.distance_squared, &mut self.gradient_factor])
            .chain(self.wanted.kernel.then_some(&mut self.kernel))
            .chain(self.gradient.iter_mut().filter(|_| self.wanted.gradient))
            .chain(has_own_lengths.then_some(&mut self.gradient_factor_of_others));
        for lanes in all {
            lanes.resize(length);
        }
    }

    /// Their places among all that the sub-domain sees.
    #[inline(always)]
    pub fn found(&self) -> &[u32] {
        self.found.indices()
    }

    /// `x_i - x_j` along direction `a`.
    #[inline(always)]
    pub fn difference(&self, a: usize) -> &[T] {
        &self.pages[0][a][..self.padded]
    }

    /// `sum_j weight_j (x_i - x_j)`.
    #[inline(always)]
    pub fn sum_differences(&self, weight: &[T]) -> [T; D] {
        let mut differences = [weight; D];
        for a in 0..D {
            differences[a] = self.difference(a);
        }
        T::dots(weight, differences)
    }

    /// `|x_i - x_j|^2`.
    #[inline(always)]
    pub fn distance_squared(&self) -> &[T] {
        &self.distance_squared[..self.padded]
    }

    /// `F`, with `grad_i W_ij = F (x_i - x_j)`.
    #[inline(always)]
    pub fn gradient_factor(&self) -> &[T] {
        &self.gradient_factor[..self.padded]
    }

    /// Component `a` of `grad_i W_ij`; only for terms that say that they use it.
    #[inline(always)]
    pub fn gradient(&self, a: usize) -> &[T] {
        &self.gradient[a][..self.padded]
    }

    /// All components of `grad_i W_ij`, as above.
    #[inline(always)]
    pub fn gradients(&self) -> [&[T]; D] {
        let mut gradients = [&[][..]; D];
        for a in 0..D {
            gradients[a] = self.gradient(a);
        }
        gradients
    }

    /// `F` with the neighbours' smoothing lengths, where they have their own.
    #[inline(always)]
    pub fn gradient_factor_of_others(&self) -> &[T] {
        &self.gradient_factor_of_others[..self.padded]
    }

    /// Writes `(v_i - v_j) . (x_i - x_j)`, below 0 for particles that approach.
    #[inline(always)]
    pub fn velocity_jump(&self, i: &Particle<T, D>, jump: &mut [T]) {
        jump.fill(T::zero());
        for a in 0..D {
            let own = i[Quantity::Velocity(a)];
            let (v, dx) = (self.values(Quantity::Velocity(a)), self.difference(a));
            for ((jump, &v), &dx) in jump.iter_mut().zip(v).zip(dx) {
                *jump = (own - v).mul_add(dx, *jump);
            }
        }
    }

    /// Writes `(v_i - v_j) . L_i (x_i - x_j)` with the correction `L_i` of the kernel gradient; only
    /// for terms that read it.
    #[inline(always)]
    pub fn corrected_velocity_jump(&self, i: &Particle<T, D>, jump: &mut [T]) {
        jump.fill(T::zero());
        for a in 0..D {
            let (own, v) = (i[Quantity::Velocity(a)], self.values(Quantity::Velocity(a)));
            for b in 0..D {
                let correction = i[Quantity::Correction(component(a, b))];
                for ((jump, &v), &dx) in jump.iter_mut().zip(v).zip(self.difference(b)) {
                    *jump = (correction * (own - v)).mul_add(dx, *jump);
                }
            }
        }
    }

    /// Writes component `a` of `v_i - v_j`, where bodies have the velocity that friction sees in
    /// them besides their own.
    #[inline(always)]
    pub fn friction_jump(
        &self,
        i: &Particle<T, D>,
        a: usize,
        in_bodies: Option<VelocityInBodies>,
        jump: &mut [T],
    ) {
        let (mut own, v) = (i[Quantity::Velocity(a)], self.values(Quantity::Velocity(a)));
        if let Some(in_bodies) = in_bodies {
            own += i[in_bodies.component(a)];
        }
        for (jump, &v) in jump.iter_mut().zip(v) {
            *jump = own - v;
        }
        if let Some(in_bodies) = in_bodies {
            for (jump, &v) in jump.iter_mut().zip(self.values(in_bodies.component(a))) {
                *jump -= v;
            }
        }
    }

    /// `W_ij`; only for terms that say that they use it.
    #[inline(always)]
    pub fn kernel(&self) -> &[T] {
        &self.kernel[..self.padded]
    }

    /// Depth of the neighbours below the surface of a body, if there are bodies.
    #[inline(always)]
    pub fn wall_depth(&self) -> Option<&[T]> {
        (self.places[Quantity::WallDepth.index()] != ABSENT)
            .then(|| self.values(Quantity::WallDepth))
    }

    /// Writes `W_ij` for neighbours in the fluid, and 0 for those in bodies.
    #[inline(always)]
    pub fn kernel_in_fluid(&self, weight: &mut [T]) {
        weight.copy_from_slice(self.kernel());
        self.leave_out_bodies(weight);
    }

    /// Sets the weights of neighbours in bodies to 0.
    #[inline(always)]
    pub fn leave_out_bodies(&self, weight: &mut [T]) {
        for (weight, &depth) in weight.iter_mut().zip(self.wall_depth().into_iter().flatten()) {
            *weight = if depth > T::zero() { T::zero() } else { *weight };
        }
    }

    /// A gathered quantity of the neighbours.
    #[inline(always)]
    pub fn values(&self, quantity: Quantity) -> &[T] {
        let place = self.places[quantity.index()];
        &self.pages[place / RECORD][place % RECORD][..self.padded]
    }
}
