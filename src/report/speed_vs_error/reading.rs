//! What a survey says: times to an error, orders of convergence, and a few sentences.

use super::comparison::{Comparison, Line};
use super::survey::{Measurement, Survey};

/// Errors of which it is asked how cheaply they are reached.
pub const TOLERANCES: [f64; 2] = [0.01, 0.001];

impl Survey {
    /// The cheapest measurement of a line that is within an error as all finer ones are, of which there is
    /// one at least: not one at which the error passes zero by luck.
    pub fn cheapest_within(
        &self,
        comparison: &Comparison,
        line: &Line,
        tolerance: f64,
    ) -> Option<&Measurement> {
        let all = self.of(comparison, line);
        let within = all.iter().rev().take_while(|m| m.error <= tolerance);
        if within.clone().count() < 2 {
            return None;
        }
        within.copied().min_by(|a, b| a.wall_s().total_cmp(&b.wall_s()))
    }

    /// The cheapest of a method's lines within an error.
    pub fn cheapest_of(
        &self,
        comparison: &Comparison,
        method: &str,
        tolerance: f64,
    ) -> Option<&Measurement> {
        let lines = comparison.lines.iter().filter(|line| line.method == method);
        let cheapest = lines.filter_map(|line| self.cheapest_within(comparison, line, tolerance));
        cheapest.min_by(|a, b| a.wall_s().total_cmp(&b.wall_s()))
    }

    /// Whether anything of a comparison was measured.
    pub fn has(&self, comparison: &Comparison) -> bool {
        self.measurements.iter().any(|m| m.case.comparison.name == comparison.name)
    }

    /// Whether anything of a comparison was measured with a method.
    pub fn has_run(&self, comparison: &Comparison, method: &str) -> bool {
        let mut lines = comparison.lines.iter().filter(|line| line.method == method);
        lines.any(|line| !self.of(comparison, line).is_empty())
    }

    /// What the measurements of a comparison say, a sentence each.
    pub fn reading(&self, comparison: &Comparison) -> Vec<String> {
        let mut said: Vec<String> = TOLERANCES
            .iter()
            .map(|&tolerance| self.who_is_cheapest(comparison, tolerance))
            .collect();
        let finest = comparison.lines.iter().filter_map(|line| self.of(comparison, line).pop());
        let smallest = finest.min_by(|a, b| a.error.total_cmp(&b.error));
        if let Some(best) = smallest {
            said.push(format!(
                "The smallest error at a line's finest resolution is {}: {} with {} points across, in {}.",
                percent(best.error),
                best.case.line.title(),
                best.case.resolution,
                seconds(best.wall_s())
            ));
        }
        said.extend(comparison.lines.iter().filter_map(|line| self.precision(comparison, line)));
        said
    }

    fn who_is_cheapest(&self, comparison: &Comparison, tolerance: f64) -> String {
        let was_run = |method: &&str| self.has_run(comparison, method);
        let methods: Vec<_> = methods(comparison).into_iter().filter(was_run).collect();
        let reached = |method: &&str| self.cheapest_of(comparison, method, tolerance);
        let mut cheapest: Vec<_> = methods.iter().filter_map(reached).collect();
        cheapest.sort_by(|a, b| a.wall_s().total_cmp(&b.wall_s()));
        let tolerance = format!("{} %", 100.0 * tolerance);
        let Some((first, others)) = cheapest.split_first() else {
            return format!("Nothing that was run stays within {tolerance}.");
        };
        let name = |m: &Measurement| {
            format!("{} with {} points across", m.case.line.title(), m.case.resolution)
        };
        let mut said = format!(
            "Within {tolerance}, the cheapest is {}: {}",
            name(first),
            seconds(first.wall_s())
        );
        for other in others {
            let ratio = other.wall_s() / first.wall_s();
            said += &format!(
                "; {} takes {} times as long ({})",
                name(other),
                two_digits(ratio),
                seconds(other.wall_s())
            );
        }
        let missing = methods.iter().filter(|method| reached(method).is_none());
        for method in missing {
            said += &format!("; {} does not reach it in what was run", method.to_uppercase());
        }
        said + "."
    }

    /// What other scalar types cost and gain, of a line in one that is otherwise the method's own.
    fn precision(&self, comparison: &Comparison, line: &Line) -> Option<String> {
        let own = comparison.lines.iter().find(|l| l.method == line.method)?;
        if line.precision == own.precision {
            return None;
        }
        let (doubles, others) = (self.of(comparison, own), self.of(comparison, line));
        let pairs = doubles.iter().zip(&others);
        let mut same = pairs.filter(|(a, b)| a.case.resolution == b.case.resolution);
        let (double, other) = same.next_back()?;
        Some(format!(
            "{} takes {} times as long as {} with {} points across, with an error of {} and {}.",
            line.title(),
            two_digits(other.wall_s() / double.wall_s()),
            own.precision.name(),
            other.case.resolution,
            percent(other.error),
            percent(double.error)
        ))
    }
}

/// Names of the methods of a comparison, each once.
pub fn methods(comparison: &Comparison) -> Vec<&'static str> {
    let mut methods: Vec<_> = comparison.lines.iter().map(|line| line.method).collect();
    methods.dedup();
    methods
}

/// Orders of convergence from each measurement to the next finer one.
pub fn orders(measurements: &[&Measurement]) -> Vec<f64> {
    let order = |pair: &[&Measurement]| {
        let [coarse, fine] = [pair[0], pair[1]];
        let finer = f64::from(fine.case.resolution) / f64::from(coarse.case.resolution);
        (coarse.error / fine.error).ln() / finer.ln()
    };
    measurements.windows(2).map(order).collect()
}

/// A share as people write it.
pub fn percent(share: f64) -> String {
    format!("{} %", two_digits(100.0 * share))
}

/// A time as people write it.
pub fn seconds(time: f64) -> String {
    format!("{} s", two_digits(time))
}

/// A positive number with two digits that count.
pub fn two_digits(value: f64) -> String {
    if !value.is_finite() || value <= 0.0 {
        return format!("{value}");
    }
    let rounded: f64 = format!("{value:.1e}").parse().unwrap_or(value);
    let exponent = rounded.log10().floor() as i32;
    let decimals = (1 - exponent).clamp(0, 12) as usize;
    format!("{rounded:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::super::comparison::COMPARISONS;
    use super::super::survey::Case;
    use super::*;

    /// Resolution, wall-clock time and error of a run.
    type Run = (u32, f64, f64);

    /// Runs of lines of the first comparison.
    fn survey(lines: &[(usize, &[Run])]) -> Survey {
        let comparison = &COMPARISONS[0];
        let mut survey = Survey::default();
        for &(line, runs) in lines {
            for &(resolution, wall, error) in runs {
                let case = Case { comparison, line: &comparison.lines[line], resolution };
                let walls = vec![1.5 * wall, wall];
                survey.measurements.push(Measurement {
                    case,
                    points: 100,
                    steps: 10,
                    walls,
                    memory: None,
                    error,
                    state_hash: String::new(),
                });
            }
        }
        survey
    }

    #[test]
    fn an_error_that_finer_runs_do_not_keep_does_not_count() {
        let lucky: &[_] = &[(16, 0.1, 0.0005), (32, 0.4, 0.004), (64, 1.6, 0.0009)];
        let survey = survey(&[(0, lucky)]);
        let comparison = &COMPARISONS[0];
        let within = |tolerance| {
            let found = survey.cheapest_within(comparison, &comparison.lines[0], tolerance);
            found.map(|m| m.case.resolution)
        };
        assert_eq!(within(0.01), Some(16));
        // The finest alone may be lucky, too.
        assert_eq!(within(0.001), None);
    }

    #[test]
    fn orders_are_of_the_resolution() {
        let survey = survey(&[(0, &[(10, 1.0, 0.04), (20, 1.0, 0.01), (60, 1.0, 0.01 / 9.0)])]);
        let orders = orders(&survey.of(&COMPARISONS[0], &COMPARISONS[0].lines[0]));
        assert_eq!(orders.len(), 2);
        assert!(orders.iter().all(|order| (order - 2.0).abs() < 1e-12), "{orders:?}");
    }

    /// The fourth line is the first of another method.
    #[test]
    fn sentences_say_who_is_cheapest_and_who_does_not_get_there() {
        let comparison = &COMPARISONS[0];
        assert_ne!(comparison.lines[3].method, comparison.lines[0].method);
        let survey = survey(&[
            (0, &[(50, 2.0, 0.008), (100, 9.0, 0.004)]),
            (3, &[(16, 0.05, 0.0004), (32, 0.2, 0.0002)]),
        ]);
        let said = survey.reading(comparison);
        assert_eq!(
            said[0],
            "Within 1 %, the cheapest is LBM with 16 points across: 0.050 s; SPH with 50 points across \
             takes 40 times as long (2.0 s)."
        );
        assert_eq!(
            said[1],
            "Within 0.1 %, the cheapest is LBM with 16 points across: 0.050 s; SPH does not reach it in \
             what was run."
        );
        assert_eq!(
            said[2],
            "The smallest error at a line's finest resolution is 0.020 %: LBM with 32 points across, in \
             0.20 s."
        );
        assert_eq!(said.len(), 3);
    }

    #[test]
    fn precisions_are_compared_at_the_same_resolution() {
        let comparison = &COMPARISONS[0];
        assert_eq!(comparison.lines[1].title(), "SPH, mixed precision");
        let survey = survey(&[
            (0, &[(16, 0.5, 0.06), (25, 1.0, 0.02)]),
            (1, &[(16, 0.4, 0.06), (25, 0.6, 0.03), (50, 2.0, 0.01)]),
        ]);
        assert_eq!(
            survey.reading(comparison).last().map(String::as_str),
            Some(
                "SPH, mixed precision takes 0.60 times as long as f64 with 25 points across, with an \
                 error of 3.0 % and 2.0 %."
            )
        );
    }

    #[test]
    fn two_digits_count() {
        let written = [0.0123, 0.0996, 1.0, 9.96, 99.6, 1234.0].map(two_digits);
        assert_eq!(written, ["0.012", "0.10", "1.0", "10", "100", "1200"]);
        assert_eq!(two_digits(0.0), "0");
    }
}
