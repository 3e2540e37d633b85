//! Waves along one axis in which the second derivative is diagonal.

use std::f64::consts::PI;
use std::sync::Arc;

use realfft::num_complex::Complex;
use realfft::{ComplexToReal, FftNum, RealFftPlanner, RealToComplex};

/// The transform of a row into waves and back, in place: of a periodic axis into cosines and sines, of one
/// between walls, in the middle of cells, into cosines (the discrete cosine transform of type II, by a
/// Fourier transform of the same length; Makhoul 1980, IEEE Trans. Acoust. Speech Signal Process. 28).
pub(crate) struct Axis<T: FftNum> {
    forward: Arc<dyn RealToComplex<T>>,
    back: Arc<dyn ComplexToReal<T>>,
    /// Between walls: `exp(-i pi k / (2 n))`.
    turns: Option<Vec<Complex<T>>>,
    points: usize,
}

/// Working memory of one worker.
pub(crate) struct Scratch<T> {
    row: Vec<T>,
    waves: Vec<Complex<T>>,
    inside: Vec<Complex<T>>,
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { row: Vec::new(), waves: Vec::new(), inside: Vec::new() }
    }
}

impl<T: FftNum> Axis<T> {
    pub fn new(points: usize, is_periodic: bool) -> Self {
        let mut planner = RealFftPlanner::new();
        let turn = |k: usize| {
            let angle = -PI * k as f64 / (2 * points) as f64;
            Complex::new(of(angle.cos()), of(angle.sin()))
        };
        Self {
            forward: planner.plan_fft_forward(points),
            back: planner.plan_fft_inverse(points),
            turns: (!is_periodic).then(|| (0..=points / 2).map(turn).collect()),
            points,
        }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// The angle per spacing, radians, of the wave in each place of a transformed row.
    pub fn angles(&self) -> Vec<f64> {
        let n = self.points as f64;
        let angle = |place: usize| match self.turns {
            None => 2.0 * PI * place.div_ceil(2) as f64 / n,
            Some(_) => PI * place as f64 / n,
        };
        (0..self.points).map(angle).collect()
    }

    /// Makes waves of a row.
    pub fn forward(&self, row: &mut [T], scratch: &mut Scratch<T>) {
        let Scratch { row: copy, waves, inside } = self.fitting(scratch);
        let n = self.points;
        if let Some(turns) = &self.turns {
            for (k, &u) in row.iter().enumerate() {
                copy[shuffled(k, n)] = u;
            }
            self.transform(copy, waves, inside);
            for (k, (wave, turn)) in waves.iter().zip(turns).enumerate() {
                let turned = wave * turn;
                row[k] = turned.re;
                if k > 0 {
                    row[n - k] = -turned.im;
                }
            }
        } else {
            self.transform(row, waves, inside);
            row[0] = waves[0].re;
            for (pair, wave) in row[1..].chunks_mut(2).zip(&waves[1..]) {
                pair[0] = wave.re;
                if let [_, im] = pair {
                    *im = wave.im;
                }
            }
        }
    }

    /// Makes a row of waves, but for a factor of [`Axis::points`].
    pub fn back(&self, row: &mut [T], scratch: &mut Scratch<T>) {
        let Scratch { row: copy, waves, inside } = self.fitting(scratch);
        let n = self.points;
        // Waves that are their own mirror image are real.
        let is_real = |k: usize| k == 0 || 2 * k == n;
        if let Some(turns) = &self.turns {
            for (k, (wave, turn)) in waves.iter_mut().zip(turns).enumerate() {
                let sine = if k > 0 { row[n - k] } else { T::zero() };
                *wave = Complex::new(row[k], -sine) * turn.conj();
                if is_real(k) {
                    wave.im = T::zero();
                }
            }
            self.transform_back(waves, copy, inside);
            for (k, u) in row.iter_mut().enumerate() {
                *u = copy[shuffled(k, n)];
            }
        } else {
            waves[0] = Complex::new(row[0], T::zero());
            for (pair, wave) in row[1..].chunks(2).zip(&mut waves[1..]) {
                *wave = Complex::new(pair[0], pair.get(1).copied().unwrap_or_else(T::zero));
            }
            self.transform_back(waves, row, inside);
        }
    }

    fn fitting<'s>(&self, scratch: &'s mut Scratch<T>) -> &'s mut Scratch<T> {
        let zero = Complex::new(T::zero(), T::zero());
        scratch.row.resize(self.points, T::zero());
        scratch.waves.resize(self.points / 2 + 1, zero);
        let inside = self.forward.get_scratch_len().max(self.back.get_scratch_len());
        scratch.inside.resize(inside.max(scratch.inside.len()), zero);
        scratch
    }

    fn transform(&self, row: &mut [T], waves: &mut [Complex<T>], inside: &mut [Complex<T>]) {
        let done = self.forward.process_with_scratch(row, waves, inside);
        done.expect("all have the lengths that were planned for");
    }

    fn transform_back(&self, waves: &mut [Complex<T>], row: &mut [T], inside: &mut [Complex<T>]) {
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
            let row: Vec<f64> = (0..n).map(|i| (1.3 * i as f64).sin() + 0.2 * i as f64).collect();
            for is_periodic in [true, false] {
                let axis = Axis::new(n, is_periodic);
                let mut scratch = Scratch::default();
                let mut waves = row.clone();
                axis.forward(&mut waves, &mut scratch);
                for (place, (&found, &angle)) in waves.iter().zip(&axis.angles()).enumerate() {
                    let is_sine = is_periodic && place > 0 && place % 2 == 0;
                    let shift = if is_periodic { 0.0 } else { 0.5 };
                    let wave = |i: usize| match is_sine {
                        true => -(angle * i as f64).sin(),
                        false => (angle * (i as f64 + shift)).cos(),
                    };
                    let sum: f64 = row.iter().enumerate().map(|(i, u)| u * wave(i)).sum();
                    assert!((found - sum).abs() < 1e-12 * n as f64, "{n} {place}: {found} {sum}");
                }
                axis.back(&mut waves, &mut scratch);
                for (back, u) in waves.iter().zip(&row) {
                    assert!((back / n as f64 - u).abs() < 1e-13, "{n}: {back} {u}");
                }
            }
        }
    }
}
