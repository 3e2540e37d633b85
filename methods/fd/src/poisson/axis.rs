//! Waves along one axis in which the second derivative is diagonal.

use std::f64::consts::PI;
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, FftNum, RealFftPlanner, RealToComplex};

/// What holds at the ends of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Waves {
    /// Each is the other.
    Periodic,
    /// Points are in the middle of cells, and at both ends half a spacing away the derivative vanishes.
    Closed,
    /// The same at the lower end; the last point is half a spacing beyond the place where the solution vanishes.
    Open,
}

/// The transform of a row into waves and back, in place: of a periodic axis into cosines and sines; of a closed one
/// into cosines (the discrete cosine transform of type II, by a Fourier transform of the same length; Makhoul 1980,
/// IEEE Trans. Acoust. Speech Signal Process. 28); of an open one into cosines of an odd number of quarters of a wave
/// (type IV), the last point being minus the one before. These are every other wave of a closed row twice as long,
/// in which the row and minus its mirror image follow each other.
pub(crate) struct Axis<T: FftNum> {
    transform: Transform<T>,
    points: usize,
}

enum Transform<T: FftNum> {
    Periodic(Fourier<T>),
    Closed(Cosines<T>),
    /// Of the row that is twice as long.
    Open(Cosines<T>),
}

/// Working memory of one worker.
pub(crate) struct Scratch<T> {
    twice: Vec<T>,
    row: Vec<T>,
    waves: Vec<Complex<T>>,
    inside: Vec<Complex<T>>,
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { twice: Vec::new(), row: Vec::new(), waves: Vec::new(), inside: Vec::new() }
    }
}

impl<T: FftNum> Axis<T> {
    pub fn new(points: usize, waves: Waves) -> Self {
        let transform = match waves {
            Waves::Periodic => Transform::Periodic(Fourier::new(points)),
            Waves::Closed => Transform::Closed(Cosines::new(points)),
            Waves::Open => Transform::Open(Cosines::new(2 * (points - 1))),
        };
        Self { transform, points }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// The angle per spacing, radians, of the wave in each place of a transformed row; the last place of an open
    /// axis has none, and any will do.
    pub fn angles(&self) -> Vec<f64> {
        let n = self.points as f64;
        let angle = |place: usize| match self.transform {
            Transform::Periodic(_) => 2.0 * PI * place.div_ceil(2) as f64 / n,
            Transform::Closed(_) => PI * place as f64 / n,
            Transform::Open(_) => PI * (place as f64 + 0.5) / (n - 1.0),
        };
        (0..self.points).map(angle).collect()
    }

    /// By how much a row is larger that comes back.
    pub fn gain(&self) -> f64 {
        match self.transform {
            Transform::Periodic(_) | Transform::Closed(_) => self.points as f64,
            Transform::Open(_) => 0.5 * (self.points - 1) as f64,
        }
    }

    /// Makes waves of a row.
    pub fn forward(&self, row: &mut [T], scratch: &mut Scratch<T>) {
        match &self.transform {
            Transform::Periodic(fourier) => {
                let Scratch { waves, inside, .. } = fourier.fitting(scratch, row.len());
                fourier.forward(row, waves, inside);
                row[0] = waves[0].re;
                for (pair, wave) in row[1..].chunks_mut(2).zip(&waves[1..]) {
                    pair[0] = wave.re;
                    if let [_, im] = pair {
                        *im = wave.im;
                    }
                }
            }
            Transform::Closed(cosines) => cosines.forward(row, scratch),
            Transform::Open(cosines) => {
                let [row @ .., last] = row else { return };
                quarter_waves(cosines, row, scratch);
                *last = T::zero();
            }
        }
    }

    /// Makes a row of waves, but for a factor of [`Axis::gain`].
    pub fn back(&self, row: &mut [T], scratch: &mut Scratch<T>) {
        match &self.transform {
            Transform::Periodic(fourier) => {
                let Scratch { waves, inside, .. } = fourier.fitting(scratch, row.len());
                waves[0] = Complex::new(row[0], T::zero());
                for (pair, wave) in row[1..].chunks(2).zip(&mut waves[1..]) {
                    *wave = Complex::new(pair[0], pair.get(1).copied().unwrap_or_else(T::zero));
                }
                fourier.back(waves, row, inside);
            }
            Transform::Closed(cosines) => cosines.back(row, scratch),
            Transform::Open(cosines) => {
                let [row @ .., last] = row else { return };
                quarter_waves(cosines, row, scratch);
                *last = row.last().map_or_else(T::zero, |&u| -u);
            }
        }
    }
}

/// Quarter waves there and, the same, back.
fn quarter_waves<T: FftNum>(cosines: &Cosines<T>, row: &mut [T], scratch: &mut Scratch<T>) {
    let mut twice = std::mem::take(&mut scratch.twice);
    twice.clear();
    twice.extend_from_slice(row);
    twice.extend(row.iter().rev().map(|&u| -u));
    cosines.forward(&mut twice, scratch);
    let half: T = of(0.5);
    for (u, wave) in row.iter_mut().zip(twice.chunks(2)) {
        *u = half * wave[1];
    }
    scratch.twice = twice;
}

/// The discrete cosine transform of type II, and its inverse.
struct Cosines<T: FftNum> {
    fourier: Fourier<T>,
    /// `exp(-i pi k / (2 n))`.
    turns: Vec<Complex<T>>,
}

impl<T: FftNum> Cosines<T> {
    fn new(points: usize) -> Self {
        let turn = |k: usize| {
            let angle = -PI * k as f64 / (2 * points) as f64;
            Complex::new(of(angle.cos()), of(angle.sin()))
        };
        Self { fourier: Fourier::new(points), turns: (0..=points / 2).map(turn).collect() }
    }

    fn forward(&self, row: &mut [T], scratch: &mut Scratch<T>) {
        let n = row.len();
        let Scratch { row: copy, waves, inside, .. } = self.fourier.fitting(scratch, n);
        for (k, &u) in row.iter().enumerate() {
            copy[shuffled(k, n)] = u;
        }
        self.fourier.forward(copy, waves, inside);
        for (k, (wave, turn)) in waves.iter().zip(&self.turns).enumerate() {
            let turned = wave * turn;
            row[k] = turned.re;
            if k > 0 {
                row[n - k] = -turned.im;
            }
        }
    }

    fn back(&self, row: &mut [T], scratch: &mut Scratch<T>) {
        let n = row.len();
        // Waves that are their own mirror image are real.
        let is_real = |k: usize| k == 0 || 2 * k == n;
        let Scratch { row: copy, waves, inside, .. } = self.fourier.fitting(scratch, n);
        for (k, (wave, turn)) in waves.iter_mut().zip(&self.turns).enumerate() {
            let sine = if k > 0 { row[n - k] } else { T::zero() };
            *wave = Complex::new(row[k], -sine) * turn.conj();
            if is_real(k) {
                wave.im = T::zero();
            }
        }
        self.fourier.back(waves, copy, inside);
        for (k, u) in row.iter_mut().enumerate() {
            *u = copy[shuffled(k, n)];
        }
    }
}

/// The transform of a real row into waves.
struct Fourier<T: FftNum> {
    forward: Arc<dyn RealToComplex<T>>,
    back: Arc<dyn ComplexToReal<T>>,
}

impl<T: FftNum> Fourier<T> {
    fn new(points: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        Self { forward: planner.plan_fft_forward(points), back: planner.plan_fft_inverse(points) }
    }

    fn fitting<'s>(&self, scratch: &'s mut Scratch<T>, points: usize) -> &'s mut Scratch<T> {
        let zero = Complex::new(T::zero(), T::zero());
        scratch.row.resize(points, T::zero());
        scratch.waves.resize(points / 2 + 1, zero);
        let inside = self.forward.get_scratch_len().max(self.back.get_scratch_len());
        scratch.inside.resize(inside.max(scratch.inside.len()), zero);
        scratch
    }

    fn forward(&self, row: &mut [T], waves: &mut [Complex<T>], inside: &mut [Complex<T>]) {
        let done = self.forward.process_with_scratch(row, waves, inside);
        done.expect("all have the lengths that were planned for");
    }

    fn back(&self, waves: &mut [Complex<T>], row: &mut [T], inside: &mut [Complex<T>]) {
        let done = self.back.process_with_scratch(waves, row, inside);
        done.expect("all have the lengths that were planned for, and real waves are real");
    }
}

/// Where point `k` of `n` goes, so that a Fourier transform gives cosines: even ones forwards, then odd ones
/// backwards.
fn shuffled(k: usize, n: usize) -> usize {
    if k.is_multiple_of(2) { k / 2 } else { n - 1 - k / 2 }
}

fn of<T: FftNum>(value: f64) -> T {
    T::from_f64(value).expect("floats hold every number, rounded")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against sums, of even and odd lengths; and back.
    #[test]
    fn waves_are_what_they_should_be() {
        for n in [4, 7, 8, 9, 30] {
            let mut row: Vec<f64> =
                (0..n).map(|i| (1.3 * i as f64).sin() + 0.2 * i as f64).collect();
            for kind in [Waves::Periodic, Waves::Closed, Waves::Open] {
                let transformed = if kind == Waves::Open { n - 1 } else { n };
                if kind == Waves::Open {
                    row[n - 1] = -row[n - 2];
                }
                let axis = Axis::new(n, kind);
                let mut scratch = Scratch::default();
                let mut waves = row.clone();
                axis.forward(&mut waves, &mut scratch);
                for (place, (&found, &angle)) in
                    waves.iter().zip(&axis.angles()).enumerate().take(transformed)
                {
                    let is_sine = kind == Waves::Periodic && place > 0 && place % 2 == 0;
                    let shift = if kind == Waves::Periodic { 0.0 } else { 0.5 };
                    let wave = |i: usize| match is_sine {
                        true => -(angle * i as f64).sin(),
                        false => (angle * (i as f64 + shift)).cos(),
                    };
                    let terms = row[..transformed].iter().enumerate();
                    let sum: f64 = terms.map(|(i, u)| u * wave(i)).sum();
                    assert!((found - sum).abs() < 1e-12 * n as f64, "{n} {place}: {found} {sum}");
                }
                axis.back(&mut waves, &mut scratch);
                for (back, u) in waves.iter().zip(&row) {
                    assert!((back / axis.gain() - u).abs() < 1e-13, "{kind:?} {n}: {back} {u}");
                }
            }
        }
    }
}
