//! What the cylinder's benchmark measured, and the ratios that the paper defines.

use std::path::Path;

/// What was measured for one width and number of workers.
#[derive(Clone, Debug)]
pub struct Row {
    /// Width of the box as asked for, m.
    pub width: f64,
    /// Number of particles.
    pub particles: usize,
    /// Number of workers.
    pub workers: usize,
    /// Neighbours within range that a particle has on average.
    pub neighbours: f64,
    /// Sweeps over all pairs that a step makes.
    pub sweeps: usize,
    /// Seconds a step of every sample, results dumps included.
    pub seconds_per_step: Vec<f64>,
    /// Of these, seconds that all workers together spent in stages.
    pub in_stages: Vec<f64>,
    /// Seconds a step with one worker, sample by sample; empty if that was not measured.
    pub alone: Vec<f64>,
    /// Of these, seconds in stages.
    pub alone_in_stages: Vec<f64>,
    /// Seconds a step of as many separate runs of one worker each as there are workers, all at the
    /// same time, sample by sample; empty with one worker. They share nothing but the machine: what
    /// is lost here the machine takes, by its clock, its memory and its other users.
    pub apart: Vec<f64>,
    /// Largest resident memory of the process, bytes.
    pub peak_memory: Option<u64>,
}

/// Middle value, the lower one of two.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len().saturating_sub(1) / 2).copied().unwrap_or(f64::NAN)
}

/// Middle value of some, if there are any.
fn median_of(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let values: Vec<_> = values.into_iter().collect();
    (!values.is_empty()).then(|| median(&values))
}

impl Row {
    /// Median seconds a step.
    pub fn seconds(&self) -> f64 {
        median(&self.seconds_per_step)
    }

    /// Seconds a step of the best sample.
    pub fn best(&self) -> f64 {
        self.seconds_per_step.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Speed-up over one worker (eq. 9) of every sample, each against its own turn's.
    pub fn speed_ups(&self) -> Vec<f64> {
        self.alone.iter().zip(&self.seconds_per_step).map(|(one, many)| one / many).collect()
    }

    /// Speed-up over one worker: median over the samples.
    pub fn speed_up(&self) -> Option<f64> {
        median_of(self.speed_ups())
    }

    /// Efficiency (eq. 10).
    pub fn efficiency(&self) -> Option<f64> {
        Some(self.speed_up()? / self.workers as f64)
    }

    /// Efficiency of the machine itself: that of as many separate runs as there are workers.
    pub fn machine_efficiency(&self) -> Option<f64> {
        median_of(self.alone.iter().zip(&self.apart).map(|(one, all)| one / all))
    }

    /// What the same stages take with one worker over what they take with all, summed over the workers:
    /// the part of the efficiency that is lost within the stages, to shared caches, memory and clock,
    /// and to other users of the machine.
    pub fn stage_efficiency(&self) -> Option<f64> {
        let pairs = self.alone_in_stages.iter().zip(&self.in_stages);
        median_of(pairs.map(|(one, many)| one / many))
    }

    /// The rest of the efficiency: share of the workers' time that they spend in stages, over that of
    /// one worker. Lost here is what handing out, waiting for each other, sorting and writing take.
    pub fn schedule_efficiency(&self) -> Option<f64> {
        let busy = |in_stages: &[f64], seconds: &[f64], workers: usize| {
            let pairs = in_stages.iter().zip(seconds);
            pairs.map(|(own, all)| own / (all * workers as f64)).collect::<Vec<_>>()
        };
        let one = busy(&self.alone_in_stages, &self.alone, 1);
        let many = busy(&self.in_stages, &self.seconds_per_step, self.workers);
        median_of(many.iter().zip(&one).map(|(many, one)| many / one))
    }

    /// Pairs of neighbours a second and worker in whole steps, each pair counted once a step from
    /// either side, however many sweeps visit it.
    pub fn pairs_per_second(&self) -> f64 {
        self.particles as f64 * self.neighbours / (self.seconds() * self.workers as f64)
    }

    /// Pair interactions a second and worker in whole steps: every sweep's visits count.
    pub fn interactions_per_second(&self) -> f64 {
        self.pairs_per_second() * self.sweeps as f64
    }

    /// Bytes a particle of the whole process.
    pub fn bytes_per_particle(&self) -> Option<f64> {
        Some(self.peak_memory? as f64 / self.particles as f64)
    }
}

/// Writes the numbers as CSV.
///
/// # Errors
/// If the file cannot be written.
pub fn write_csv(path: &Path, rows: &[Row]) -> std::io::Result<()> {
    let mut text = String::from(
        "width_m,particles,workers,neighbours,sweeps,seconds_per_step_median,\
         seconds_per_step_best,speed_up,efficiency,stage_efficiency,\
         schedule_efficiency,machine_efficiency,pairs_per_s_and_core,\
         pair_interactions_per_s_and_core,bytes_per_particle\n",
    );
    let optional = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.4}"));
    for row in rows {
        text += &format!(
            "{},{},{},{:.2},{},{:.6e},{:.6e},{},{},{},{},{},{:.4e},{:.4e},{}\n",
            row.width,
            row.particles,
            row.workers,
            row.neighbours,
            row.sweeps,
            row.seconds(),
            row.best(),
            optional(row.speed_up()),
            optional(row.efficiency()),
            optional(row.stage_efficiency()),
            optional(row.schedule_efficiency()),
            optional(row.machine_efficiency()),
            row.pairs_per_second(),
            row.interactions_per_second(),
            optional(row.bytes_per_particle()),
        );
    }
    std::fs::write(path, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn efficiency_is_lost_in_stages_or_between_them() {
        // One worker is 0.9 of a second in stages; two are 0.5 each, of 0.6.
        let row = Row {
            width: 0.001,
            particles: 1,
            workers: 2,
            neighbours: 1.0,
            sweeps: 1,
            seconds_per_step: vec![0.6],
            in_stages: vec![1.0],
            alone: vec![1.0],
            alone_in_stages: vec![0.9],
            apart: vec![1.1],
            peak_memory: None,
        };
        let efficiencies = [row.stage_efficiency(), row.schedule_efficiency(), row.efficiency()];
        let [stages, schedule, all] = efficiencies.map(Option::unwrap);
        assert!((stages - 0.9).abs() < 1e-12);
        assert!((schedule - 1.0 / 1.2 / 0.9).abs() < 1e-12);
        assert!((stages * schedule - all).abs() < 1e-12);
    }
}
