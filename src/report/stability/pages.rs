//! A stability map as a page.

use maud::{Markup, html};

use super::{Entry, Map, Outcome};
use crate::report::page::Page;

impl Map {
    /// The page; `command` made it.
    pub fn page(&self, command: String) -> Page {
        let mut methods: Vec<_> = self.entries.iter().map(|entry| entry.method.as_str()).collect();
        methods.dedup();
        let body = html! {
            ul.legend {
                @for (class, what) in [
                    ("good", "survives"), ("doubtful", "survives, but wrong"), ("bad", "blows up"),
                    ("unknown", "not finished"),
                ] { li { span.tile.(class) { (what) } } }
            }
            @for method in methods {
                h2 { (method.to_uppercase()) }
                p { (self.reading(method)) }
                @for case in self.cases().filter(|case| case[0].method == method) { (row(case)) }
            }
            @if !self.left_out.is_empty() {
                h2 { "What was not run" }
                p { "The time was up before these:" }
                ul { @for (case, variant) in &self.left_out { li { (case) ", " (variant) } } }
            }
        };
        Page {
            title: "Stability on hard cases".into(),
            lead: "Variants of each method on scenes run for long, at their limits or on meshes too coarse for \
                   them. A run that ends in order is looked at for signs that something is wrong, which its \
                   tile names. Where time steps were made longer, CFL x 2 says that the run survived with twice \
                   the scene's own."
                .into(),
            body,
            command,
        }
    }

    /// Which variants survive all cases of a method that they were tried on.
    fn reading(&self, method: &str) -> String {
        let of = || self.entries.iter().filter(|entry| entry.method == method);
        let mut variants: Vec<&str> = Vec::new();
        for entry in of() {
            if !variants.contains(&entry.variant.as_str()) {
                variants.push(&entry.variant);
            }
        }
        let tally = |variant: &str| {
            let tried = || of().filter(|entry| entry.variant == variant);
            let well = tried().filter(|entry| entry.outcome == Outcome::Survives).count();
            format!("{variant} in {well} of {}", tried().count())
        };
        let tallies: Vec<_> = variants.into_iter().map(tally).collect();
        format!("Right to the end: {}.", tallies.join("; "))
    }
}

/// One case: a tile a variant, and what failures said.
fn row(case: &[Entry]) -> Markup {
    html! {
        h3 { (case[0].case) }
        div.tiles { @for entry in case { (tile(entry)) } }
        @let failures = || case.iter().filter(|e| matches!(e.outcome, Outcome::BlowsUp(_)));
        @if failures().next().is_some() {
            details {
                summary { "What the failures said" }
                ul { @for entry in failures() { li { (entry.variant) ": " (entry.outcome) } } }
            }
        }
    }
}

fn tile(entry: &Entry) -> Markup {
    let class = match entry.outcome {
        Outcome::Survives => "good",
        Outcome::Wrong(_) => "doubtful",
        Outcome::BlowsUp(_) => "bad",
        Outcome::Unfinished => "unknown",
    };
    html! {
        div.tile.(class) {
            strong { (entry.variant) }
            @match &entry.outcome {
                Outcome::Wrong(symptoms) => span { (symptoms.join(", ")) },
                Outcome::BlowsUp(_) => span { "blows up" },
                Outcome::Unfinished => span { "not finished" },
                Outcome::Survives => span { "survives" },
            }
            @if let Some(courant) = entry.largest_courant { span { "CFL x " (courant) } }
            span.grey { (format!("{:.1} s", entry.wall_s)) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::saved;
    use super::*;

    fn entry(case: &str, variant: &str, outcome: Outcome) -> Entry {
        let [method, case, variant] = ["sph", case, variant].map(str::to_owned);
        Entry { method, case, variant, outcome, wall_s: 1.0, largest_courant: None }
    }

    #[test]
    fn variants_are_tallied_over_the_cases_they_were_tried_on() {
        let wrong = Outcome::Wrong(vec!["voids".into()]);
        let blown = Outcome::BlowsUp("column \"x\" <nan>".into());
        let map = Map {
            entries: vec![
                entry("patch", "plain", wrong),
                entry("patch", "delta", Outcome::Survives),
                entry("dam", "plain", blown),
                entry("dam", "delta", Outcome::Survives),
                entry("dam", "shifting", Outcome::Unfinished),
            ],
            left_out: vec![("tank", "plain")],
        };
        assert_eq!(
            map.reading("sph"),
            "Right to the end: plain in 0 of 2; delta in 2 of 2; shifting in 0 of 1."
        );
        let page = map.page(String::new()).body.into_string();
        assert!(page.contains("voids") && page.contains("&lt;nan&gt;") && page.contains("tank"));
        assert_eq!(page.matches("<h3>").count(), 2);
    }

    /// A saved map is what it was, but for what was not finished.
    #[test]
    fn a_map_is_gone_on_with() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.json");
        assert!(saved(&path).unwrap().is_empty());
        let wrong = Outcome::Wrong(vec!["voids, \"many\"".into()]);
        let entries = vec![
            Entry { largest_courant: Some(1.5), ..entry("patch", "plain", wrong) },
            entry("dam", "plain", Outcome::BlowsUp("NaN".into())),
            entry("dam", "shifting", Outcome::Unfinished),
        ];
        let map = Map { entries, left_out: Vec::new() };
        map.save(&path).unwrap();
        let again = saved(&path).unwrap();
        assert_eq!(format!("{again:?}"), format!("{:?}", &map.entries[..2]));
        std::fs::write(&path, "[{").unwrap();
        assert!(saved(&path).is_err());
    }
}
