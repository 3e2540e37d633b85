//! A survey as a page, and its diagrams as pictures.

use std::path::{Path, PathBuf};

use maud::{Markup, html};

use super::comparison::{COMPARISONS, Comparison};
use super::reading::{TOLERANCES, methods, orders, percent, seconds, two_digits};
use super::survey::{Case, Measurement, Survey};
use crate::figure::{Axis, Chart, FigureError, Scale};
use crate::report::diagram::{Diagram, Point, Series};
use crate::report::page::Page;

const TIME: &str = "wall-clock time of a run";

impl Survey {
    /// The page about everything that was measured; `command` made it.
    pub fn page(&self, command: String) -> Page {
        let shown: Vec<&Comparison> = COMPARISONS.iter().filter(|c| self.has(c)).collect();
        let body = html! {
            h2 { "Time to an error" }
            p.grey {
                "The cheapest run of each method that stays within the error as all its finer runs do, of which \
                 there is one at least; in brackets points across. What is not reached was not reached by \
                 the runs that there was time for."
            }
            div.scroll { (self.times(&shown)) }
            @for comparison in &shown { (self.section(comparison)) }
            (self.rest())
        };
        Page {
            title: "Speed against error".into(),
            lead: "The same scenes by every method that can run them: error against a reference that is \
                   not our own, over the time that a run took to its end. Further down is more accurate, \
                   further left is cheaper. The preparation of a run is not counted; of short runs the \
                   best of several counts."
                .into(),
            body,
            command,
        }
    }

    fn times(&self, shown: &[&Comparison]) -> Markup {
        const METHODS: [&str; 3] = ["sph", "lbm", "fd"];
        html! {
            table {
                tr {
                    th rowspan="2" { "scene" }
                    @for tolerance in TOLERANCES {
                        th colspan=(METHODS.len()) { "within " (100.0 * tolerance) " %" }
                    }
                }
                tr { @for _ in TOLERANCES { @for method in METHODS { th class=(method) { (method.to_uppercase()) } } } }
                @for comparison in shown {
                    tr {
                        td { (comparison.name) }
                        @for tolerance in TOLERANCES {
                            @for method in METHODS {
                                td { (self.time(comparison, method, tolerance)) }
                            }
                        }
                    }
                }
            }
        }
    }

    fn time(&self, comparison: &Comparison, method: &str, tolerance: f64) -> String {
        match self.cheapest_of(comparison, method, tolerance) {
            Some(m) => format!("{} ({})", seconds(m.wall_s()), m.case.resolution),
            None if self.has_run(comparison, method) => "not reached".into(),
            None if methods(comparison).contains(&method) => "not run".into(),
            None => "\u{2013}".into(),
        }
    }

    fn section(&self, comparison: &Comparison) -> Markup {
        html! {
            h2 { (comparison.name) }
            div.beside {
                div { @if let Some(figure) = self.diagram(comparison).render() { (figure) } }
                div { @for sentence in self.reading(comparison) { p { (sentence) } } }
            }
            details {
                summary { "All runs" }
                div.scroll { (self.runs(comparison)) }
            }
        }
    }

    fn diagram(&self, comparison: &Comparison) -> Diagram {
        let series = comparison.lines.iter().map(|line| {
            let of_method = comparison.lines.iter().filter(|other| other.method == line.method);
            let index = of_method.take_while(|other| other.title() != line.title()).count();
            let shown = self.of(comparison, line).into_iter().filter(|m| m.error > 0.0);
            let points = shown.map(point).collect();
            Series { name: line.title(), class: line.method, index, points }
        });
        Diagram {
            title: format!("{}: {}", comparison.name, comparison.quantity),
            x: Axis::new(TIME).unit("s").scale(Scale::Log10),
            y: Axis::new("relative error").scale(Scale::Log10),
            series: series.collect(),
        }
    }

    fn runs(&self, comparison: &Comparison) -> Markup {
        html! {
            table {
                tr {
                    th { "method" } th { "points across" } th { "points" } th { "steps" } th { "time" }
                    th { "ms a step" } th { "memory" } th { "error" } th { "order" }
                    th.text { "command" }
                }
                @for line in comparison.lines {
                    @let runs = self.of(comparison, line);
                    @let orders = orders(&runs);
                    @for (k, run) in runs.iter().enumerate() {
                        tr {
                            td class=(line.method) { (line.title()) }
                            td { (run.case.resolution) }
                            td { (run.points) }
                            td { (run.steps) }
                            td { (seconds(run.wall_s())) }
                            td { (two_digits(1e3 * run.wall_s() / run.steps as f64)) }
                            td { @if let Some(bytes) = run.memory { (bytes >> 20) " MiB" } }
                            td { (percent(run.error)) }
                            td { @if k > 0 { (format!("{:.1}", orders[k - 1])) } }
                            td.wide { code { "finegrain " (run.case.arguments().join(" ")) } }
                        }
                    }
                }
            }
        }
    }

    /// What failed, and what was not run.
    fn rest(&self) -> Markup {
        html! {
            @if !self.failures.is_empty() {
                h2 { "What failed" }
                ul { @for (case, why) in &self.failures { li { (name(case)) ": " (why) } } }
            }
            @if !self.left_out.is_empty() {
                h2 { "What was not run, for want of time" }
                ul { @for case in &self.left_out { li { (name(case)) } } }
            }
        }
    }

    /// Draws a diagram for every comparison into `out`; returns the pictures' paths.
    ///
    /// # Errors
    /// If a picture cannot be written.
    pub fn draw(&self, out: &Path) -> Result<Vec<PathBuf>, FigureError> {
        let mut pictures = Vec::new();
        for comparison in COMPARISONS.iter().filter(|c| self.has(c)) {
            let mut chart = Chart::new(format!("{}: {}", comparison.name, comparison.quantity))
                .x(Axis::new(TIME).unit("s").scale(Scale::Log10))
                .y(Axis::new("relative error").scale(Scale::Log10));
            for line in comparison.lines {
                let measured = self.of(comparison, line);
                if !measured.is_empty() {
                    chart =
                        chart.series(line.title(), measured.iter().map(|m| [m.wall_s(), m.error]));
                }
            }
            let path = out.join(format!("{}.png", file_name(comparison.name)));
            chart.save(&path)?;
            pictures.push(path);
        }
        Ok(pictures)
    }
}

fn point(m: &Measurement) -> Point {
    let about = format!(
        "{} points across: {} in {}",
        m.case.resolution,
        percent(m.error),
        seconds(m.wall_s())
    );
    Point { place: [m.wall_s(), m.error], label: m.case.resolution.to_string(), about }
}

fn name(case: &Case) -> String {
    let Case { comparison, line, resolution } = case;
    format!("{}, {}, {resolution} points across", comparison.name, line.title())
}

/// A name without what file systems and addresses do not like.
fn file_name(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-").to_lowercase()
}
