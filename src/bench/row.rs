//! What the cylinder's benchmark measured, and the ratios that the paper defines.

use std::path::Path;

use super::samples::median;

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
    /// Turns of a few steps with these workers.
    pub turns: Vec<Turn>,
    /// Turns with one worker, each right beside one of `turns`; empty if that was not measured.
    pub alone: Vec<Turn>,
    /// Seconds a step of as many separate runs of one worker each as there are workers, all at the
    /// same time, turn by turn; only for the most workers. They share nothing but the machine: what
    /// is lost here the machine takes, by its clock, its memory and its other users.
    pub apart: Vec<f64>,
    /// Largest resident memory of the process, bytes.
    pub peak_memory: Option<u64>,
}

/// What was measured in a few steps.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Seconds a step, results dumps included.
    pub seconds: f64,
    /// Seconds a step that all workers together spent in stages.
    pub in_stages: f64,
}

/// Median seconds a step; `None` without turns.
fn seconds(turns: &[Turn]) -> Option<f64> {
    median(turns.iter().map(|turn| turn.seconds))
}

/// Median seconds a step in stages.
fn in_stages(turns: &[Turn]) -> Option<f64> {
    median(turns.iter().map(|turn| turn.in_stages))
}

/// Seconds a step of the best turn.
fn best(turns: &[Turn]) -> Option<f64> {
    turns.iter().map(|turn| turn.seconds).reduce(f64::min)
}

impl Row {
    /// Median seconds a step; not a number without turns.
    pub fn seconds(&self) -> f64 {
        seconds(&self.turns).unwrap_or(f64::NAN)
    }

    /// Seconds a step of the best turn; not a number without turns.
    pub fn best(&self) -> f64 {
        best(&self.turns).unwrap_or(f64::NAN)
    }

    /// Seconds a step of the worst turn over those of the best; not a number without turns.
    pub fn scatter(&self) -> f64 {
        let worst = self.turns.iter().map(|turn| turn.seconds).reduce(f64::max);
        worst.unwrap_or(f64::NAN) / self.best()
    }

    /// Speed-up over one worker (eq. 9): median seconds a step with one over median seconds a step with
    /// these. The turns of both lie side by side, so that a machine whose speed drifts slows both.
    pub fn speed_up(&self) -> Option<f64> {
        Some(seconds(&self.alone)? / seconds(&self.turns)?)
    }

    /// The same of the best turns.
    pub fn best_speed_up(&self) -> Option<f64> {
        Some(best(&self.alone)? / best(&self.turns)?)
    }

    /// Speed-up of every turn over the one with one worker beside it: how much it scatters.
    pub fn speed_ups(&self) -> Vec<f64> {
        let pairs = self.alone.iter().zip(&self.turns);
        pairs.map(|(one, many)| one.seconds / many.seconds).collect()
    }

    /// Efficiency (eq. 10).
    pub fn efficiency(&self) -> Option<f64> {
        Some(self.speed_up()? / self.workers as f64)
    }

    /// Efficiency of the machine itself: that of as many separate runs as there are workers.
    pub fn machine_efficiency(&self) -> Option<f64> {
        Some(seconds(&self.alone)? / median(self.apart.iter().copied())?)
    }

    /// What the same stages take with one worker over what they take with all, summed over the workers:
    /// the part of the efficiency that is lost within the stages, to shared caches, memory and clock,
    /// and to other users of the machine.
    pub fn stage_efficiency(&self) -> Option<f64> {
        Some(in_stages(&self.alone)? / in_stages(&self.turns)?)
    }

    /// The rest of the efficiency: share of the workers' time that they spend in stages, over that of
    /// one worker. Lost here is what handing out, waiting for each other, sorting and writing take.
    pub fn schedule_efficiency(&self) -> Option<f64> {
        let busy = |turns: &[Turn]| Some(in_stages(turns)? / seconds(turns)?);
        Some(busy(&self.turns)? / self.workers as f64 / busy(&self.alone)?)
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
         seconds_per_step_best,speed_up,speed_up_best,efficiency,stage_efficiency,\
         schedule_efficiency,machine_efficiency,pairs_per_s_and_core,\
         pair_interactions_per_s_and_core,bytes_per_particle\n",
    );
    let optional = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.4}"));
    for row in rows {
        text += &format!(
            "{},{},{},{:.2},{},{:.6e},{:.6e},{},{},{},{},{},{},{:.4e},{:.4e},{}\n",
            row.width,
            row.particles,
            row.workers,
            row.neighbours,
            row.sweeps,
            row.seconds(),
            row.best(),
            optional(row.speed_up()),
            optional(row.best_speed_up()),
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

    fn turns(turns: &[[f64; 2]]) -> Vec<Turn> {
        turns.iter().map(|&[seconds, in_stages]| Turn { seconds, in_stages }).collect()
    }

    fn row(own: &[[f64; 2]], alone: &[[f64; 2]], apart: &[f64]) -> Row {
        Row {
            width: 0.001,
            particles: 1,
            workers: 2,
            neighbours: 1.0,
            sweeps: 1,
            turns: turns(own),
            alone: turns(alone),
            apart: apart.to_vec(),
            peak_memory: None,
        }
    }

    #[test]
    fn efficiency_is_lost_in_stages_or_between_them() {
        // One worker is 0.9 of a second in stages; two are 0.5 each, of 0.6.
        let row = row(&[[0.6, 1.0]], &[[1.0, 0.9]], &[1.1]);
        let efficiencies = [row.stage_efficiency(), row.schedule_efficiency(), row.efficiency()];
        let [stages, schedule, all] = efficiencies.map(Option::unwrap);
        assert!((stages - 0.9).abs() < 1e-12);
        assert!((schedule - 1.0 / 1.2 / 0.9).abs() < 1e-12);
        assert!((stages * schedule - all).abs() < 1e-12);
        assert!((row.machine_efficiency().unwrap() - 1.0 / 1.1).abs() < 1e-12);
    }

    #[test]
    fn the_columns_of_a_table_belong_together() {
        let own = [[0.5, 0.9], [0.8, 1.1], [0.6, 0.95], [0.7, 1.0]];
        let alone = [[1.3, 0.9], [1.0, 0.8], [1.5, 1.2], [1.1, 1.0]];
        let row = row(&own, &alone, &[]);
        // Means of the two in the middle: 0.6 and 0.7; 1.1 and 1.3.
        assert!((row.seconds() - 0.65).abs() < 1e-12);
        assert!((row.speed_up().unwrap() - 1.2 / 0.65).abs() < 1e-12);
        assert!((row.best_speed_up().unwrap() - 1.0 / 0.5).abs() < 1e-12);
        assert!((row.scatter() - 0.8 / 0.5).abs() < 1e-12);
        let product = row.stage_efficiency().unwrap() * row.schedule_efficiency().unwrap();
        assert!((product - row.efficiency().unwrap()).abs() < 1e-12);
        assert_eq!(row.machine_efficiency(), None);
    }
}
