//! Timing of several ways to do the same thing, side by side.

use std::time::Instant;

use finegrain::bench::samples::median;

/// One way to do it.
pub struct Case<'a> {
    /// What it is.
    pub name: String,
    /// Seconds of every sample so far, in order.
    seconds: Vec<f64>,
    run: Box<dyn FnMut() + 'a>,
}

impl<'a> Case<'a> {
    /// A way called `name`; `run` takes one sample.
    pub fn new(name: impl Into<String>, run: impl FnMut() + 'a) -> Self {
        Self { name: name.into(), seconds: Vec::new(), run: Box::new(run) }
    }

    /// Takes a sample: how long it took, in seconds.
    pub fn take(&mut self) -> f64 {
        let start = Instant::now();
        (self.run)();
        start.elapsed().as_secs_f64()
    }

    /// Shortest sample, in seconds.
    pub fn best(&self) -> f64 {
        self.seconds.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Median sample, in seconds.
    pub fn median(&self) -> f64 {
        median(self.seconds.iter().copied()).expect("a sample")
    }

    /// How many times as fast as `other` it is: median of the ratios of samples taken right after
    /// one another.
    pub fn speed_beside(&self, other: &Self) -> f64 {
        let ratios = other.seconds.iter().zip(&self.seconds).map(|(other, own)| other / own);
        median(ratios).expect("a sample")
    }
}

/// Takes `samples` samples of every case, one of each in turn: whatever else the machine does
/// then slows all of them alike. The first of each only warms up.
pub fn sample(cases: &mut [Case<'_>], samples: usize) {
    for round in 0..=samples {
        for case in &mut *cases {
            let seconds = case.take();
            if round > 0 {
                case.seconds.push(seconds);
            }
        }
    }
}
