//! Scaling as a page: the paper's Figs. 10, 11 and 12 with what is forecast.

use finegrain_framework::Schedule;
use maud::{Markup, html};

use super::measure::{Forecast, Scaling};
use crate::figure::{Axis, Scale};
use crate::report::diagram::{Diagram, Point, Series};
use crate::report::page::Page;

/// Makes a value of a time per step and a number of workers, given the time with one worker.
type Value = fn(seconds: f64, workers: f64, alone: f64) -> f64;

impl Scaling {
    /// The page about a scene, which is described by `scene`; `command` made it.
    pub fn page(&self, scene: &str, command: String) -> Page {
        let seconds: Value = |seconds, _, _| seconds;
        let speed_up: Value = |seconds, _, alone| alone / seconds;
        let efficiency: Value = |seconds, workers, alone| alone / (seconds * workers);
        let log = |name: &str| Axis::new(name).scale(Scale::Log10);
        let body = html! {
            @for sentence in self.reading() { p { (sentence) } }
            (self.figure("Time per step (Fig. 10)", log("time per step").unit("s"), seconds))
            (self.figure("Speed-up over one worker (Fig. 11)", log("speed-up"), speed_up))
            (self.figure(
                "Efficiency (Fig. 12)", Axis::new("efficiency").covering(0.0, 1.05), efficiency
            ))
            h2 { "Numbers" }
            div.scroll { (self.table()) }
        };
        Page {
            title: format!("Scaling: {scene}"),
            lead: "Filled markers are measured, the best of several runs. Open ones are a forecast: \
                   Dispatch simulated event by event with the measured cost of every part of every \
                   sub-domain and the measured cost of handing out and meeting. It supposes that every core brings its own \
                   memory bandwidth, and that a hand-out costs the same under every schedule. Where it takes \
                   longer to pass all fields once through this machine's memory, once a step or, \
                   peer-to-peer, a leg, a second line shows that: the best there can be."
                .into(),
            body,
            command,
        }
    }

    fn figure(&self, title: &str, y: Axis, value: Value) -> Markup {
        let x = Axis::new("number of workers").scale(Scale::Log2);
        let mut series = Vec::new();
        for schedule in Schedule::ALL {
            let Some(alone) = self.seconds(schedule, 1) else { continue };
            let point = |workers: usize, seconds: f64, alone: f64, what: &str| {
                let y = value(seconds, workers as f64, alone);
                let about = format!("{schedule}, {workers} workers, {what}: {y:.4}");
                Point { place: [workers as f64, y], label: String::new(), about }
            };
            let measured = self.measured.iter().filter(|m| m.schedule == schedule);
            let measured = measured.map(|m| point(m.workers, m.best(), alone, "measured"));
            let name = format!("{schedule}, measured");
            let class = schedule.name();
            series.push(Series { name, class, index: 0, points: measured.collect() });
            let all = |seconds: fn(&Forecast) -> f64| -> Vec<Point> {
                let of = || self.forecasts.iter().filter(|f| f.schedule == schedule);
                // Of its own time with one worker, lest one disturbed measurement bend a whole line.
                let alone = of().find(|f| f.workers == 1).map_or(alone, seconds);
                of().map(|f| point(f.workers, seconds(f), alone, "forecast")).collect()
            };
            let (own, here) = (all(|f| f.seconds), all(|f| f.seconds_here));
            let memory_binds =
                self.forecasts.iter().any(|f| f.schedule == schedule && f.is_bound());
            let name = format!("{schedule}, forecast");
            series.push(Series { name, class, index: 4, points: own });
            if memory_binds {
                let name = format!("{schedule}, forecast with this memory");
                series.push(Series { name, class, index: 5, points: here });
            }
        }
        Diagram { title: title.into(), x, y, series }.render().unwrap_or_default()
    }

    /// What the numbers say, a sentence each.
    fn reading(&self) -> Vec<String> {
        let workers = self.overheads.workers;
        let mut said = vec![format!(
            "{} points in {} sub-domains, {:.1} MiB of fields. Handing out a sub-domain takes {:.1} ns of \
             a worker, a meeting of {workers} workers {:.2} microseconds; together they copy {:.1} GB/s.",
            self.points,
            self.sub_domains,
            self.bytes as f64 / f64::from(1 << 20),
            1e9 * self.overheads.hand_out,
            1e6 * self.overheads.meeting,
            1e-9 * self.bandwidth
        )];
        for schedule in Schedule::ALL {
            let at = |n| self.forecasts.iter().find(|f| f.schedule == schedule && f.workers == n);
            let (Some(alone), Some(all)) =
                (self.seconds(schedule, 1), self.seconds(schedule, workers))
            else {
                continue;
            };
            let mut sentence =
                format!("{schedule}: speed-up {:.2} on {workers} workers", alone / all);
            if let Some(forecast) = at(workers) {
                sentence += &format!(
                    ", a step {:+.1} % from the forecast",
                    100.0 * (all / forecast.seconds - 1.0)
                );
            }
            let forecast_alone = at(1).map_or(alone, |f| f.seconds);
            if let Some(most) = self.forecasts.iter().rev().find(|f| f.schedule == schedule) {
                sentence += &format!(
                    "; forecast on {}: {:.1}",
                    most.workers,
                    forecast_alone / most.seconds
                );
                if most.is_bound() {
                    let bound = forecast_alone / most.seconds_here;
                    sentence += &format!(", with this machine's memory {bound:.1}");
                }
            }
            said.push(sentence + ".");
        }
        said
    }

    fn table(&self) -> Markup {
        let ms = |seconds: f64| format!("{:.4}", 1e3 * seconds);
        html! {
            table {
                tr {
                    th { "schedule" } th { "workers" } th { "measured (ms a step)" } th { "speed-up" }
                    th { "efficiency" }
                }
                @for m in &self.measured {
                    @let alone = self.seconds(m.schedule, 1);
                    @let speed_up = alone.map(|alone| alone / m.best());
                    tr {
                        td class=(m.schedule.name()) { (m.schedule) }
                        td { (m.workers) }
                        td { (ms(m.best())) }
                        td { @if let Some(s) = speed_up { (format!("{s:.3}")) } }
                        td { @if let Some(s) = speed_up { (format!("{:.3}", s / m.workers as f64)) } }
                    }
                }
            }
            table {
                tr {
                    th { "schedule" } th { "workers" } th { "forecast (ms a step)" }
                    th { "with this memory (ms a step)" }
                }
                @for f in &self.forecasts {
                    tr {
                        td class=(f.schedule.name()) { (f.schedule) }
                        td { (f.workers) }
                        td { (ms(f.seconds)) }
                        td { (ms(f.seconds_here)) }
                    }
                }
            }
        }
    }
}
