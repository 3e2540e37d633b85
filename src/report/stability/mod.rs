//! Stability maps: which variants of a scheme survive a hard case, and which do not.

mod pages;

use std::collections::BTreeMap;
use std::fmt;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use finegrain_framework::run::Stopped;
use serde::{Deserialize, Serialize};

use super::hard_cases::{HardCase, Variant};
use crate::figure::{FigureError, Tile, Tiles, Tone};
use crate::scene::{Orders, Precision, Scene, SceneError};

/// How a run ended.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Outcome {
    /// In order, and nothing about it is suspicious.
    Survives,
    /// In order, but with these symptoms.
    Wrong(Vec<String>),
    /// With this error.
    BlowsUp(String),
    /// It did not end within its time.
    Unfinished,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Survives => f.write_str("survives"),
            Self::Wrong(symptoms) => write!(f, "survives, but {}", symptoms.join(", ")),
            Self::BlowsUp(error) => write!(f, "blows up: {error}"),
            Self::Unfinished => f.write_str("not finished"),
        }
    }
}

/// One variant of one case.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Entry {
    /// Method of the case.
    pub method: String,
    /// Name of the case.
    pub case: String,
    /// Name of the variant.
    pub variant: String,
    /// How it ended with the scene's own time step.
    pub outcome: Outcome,
    /// Wall-clock time of that run, s.
    pub wall_s: f64,
    /// Largest of [`COURANT_NUMBERS`] that survives, where they are tried.
    pub largest_courant: Option<f64>,
}

impl Entry {
    fn is_of(&self, case: &HardCase, variant: &Variant) -> bool {
        self.method == case.method && self.case == case.name && self.variant == variant.name
    }
}

/// Courant numbers that are tried where a method has them, in units of the scene's own; the last is its own.
pub const COURANT_NUMBERS: [f64; 5] = [4.0, 3.0, 2.0, 1.5, 1.0];

/// What to run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The cases.
    pub cases: Vec<HardCase>,
    /// What was found before, and is not run again.
    pub known: Vec<Entry>,
    /// No run is begun after this time.
    pub budget: Duration,
    /// Number of workers; all cores if `None`.
    pub workers: Option<usize>,
}

/// A stability map.
#[derive(Clone, Debug, Default)]
pub struct Map {
    /// What was run.
    pub entries: Vec<Entry>,
    /// Case and variant of what was not, for want of time.
    pub left_out: Vec<(&'static str, &'static str)>,
}

/// Runs everything in `plan` that is not known, but no variant that sets what an earlier one of its case does (such as
/// what has become the default); `say` hears of the map whenever it has one entry more.
///
/// # Errors
/// If a case names a scene or parameter that there is not.
pub fn map(plan: &Plan, mut say: impl FnMut(&Map)) -> Result<Map, SceneError> {
    let begun = Instant::now();
    let mut map = Map::default();
    for case in &plan.cases {
        let (scene, mut tried) = (Scene::find(case.scene)?, Vec::new());
        for variant in case.variants {
            let settings = case.settings.iter().chain(variant.settings).copied();
            let parameters = scene.set_for(Some(case.method), settings)?;
            if tried.contains(&parameters) {
                continue;
            }
            tried.push(parameters);
            if let Some(known) = plan.known.iter().find(|known| known.is_of(case, variant)) {
                map.entries.push(known.clone());
                continue;
            }
            let left = plan.budget.saturating_sub(begun.elapsed());
            if left.is_zero() {
                map.left_out.push((case.name, variant.name));
                continue;
            }
            map.entries.push(entry(case, variant, plan.workers, left)?);
            say(&map);
        }
    }
    Ok(map)
}

fn entry(
    case: &HardCase,
    variant: &Variant,
    workers: Option<usize>,
    left: Duration,
) -> Result<Entry, SceneError> {
    let begun = Instant::now();
    let survives = |outcome: &Outcome| matches!(outcome, Outcome::Survives | Outcome::Wrong(_));
    let (outcome, wall_s) = run(case, variant, None, workers, left)?;
    let mut largest_courant = None;
    if let (Some(name), true) = (case.time_step, survives(&outcome)) {
        // The longest steps first: they are the fewest, and what blows up ends early.
        for courant in COURANT_NUMBERS {
            let left = left.saturating_sub(begun.elapsed());
            if courant == 1.0 || left.is_zero() {
                largest_courant = Some(1.0);
                break;
            }
            let (longer, _) = run(case, variant, Some((name, courant)), workers, left)?;
            if survives(&longer) {
                largest_courant = Some(courant);
                break;
            }
        }
    }
    let [method, case, variant] = [case.method, case.name, variant.name].map(str::to_owned);
    Ok(Entry { method, case, variant, outcome, wall_s, largest_courant })
}

/// Outcome and wall-clock time of one run, with a parameter so many times its own.
fn run(
    case: &HardCase,
    variant: &Variant,
    longer: Option<(&'static str, f64)>,
    workers: Option<usize>,
    left: Duration,
) -> Result<(Outcome, f64), SceneError> {
    let scene = Scene::find(case.scene)?;
    let method = Some(case.method);
    let settings = || case.settings.iter().chain(variant.settings).copied();
    let mut parameters = scene.set_for(method, settings())?;
    if let Some((name, times)) = longer {
        let value = (times * parameters.number(name)).to_string();
        parameters = scene.set_for(method, settings().chain([(name, value.as_str())]))?;
    }
    let prepared = scene.prepare(method, &parameters, Precision::F64)?;
    let (until, wall_clock) = (Some(case.until), Some(left));
    let begun = Instant::now();
    let ended = prepared.run(Orders { until, wall_clock, workers, ..Orders::default() });
    let wall_s = begun.elapsed().as_secs_f64();
    let outcome = match ended {
        Ok(report) if report.stopped == Stopped::WallClock => Outcome::Unfinished,
        Ok(report) => judge(case, &report.results),
        Err(SceneError::Run(failed)) => Outcome::BlowsUp(failed.to_string()),
        Err(other) => return Err(other),
    };
    Ok((outcome, wall_s))
}

/// Looks for the signs that something is wrong.
fn judge(case: &HardCase, results: &BTreeMap<&str, f64>) -> Outcome {
    let mut symptoms = Vec::new();
    for sign in case.signs {
        match results.get(sign.result) {
            Some(&value) if (sign.least..=sign.most).contains(&value) => {}
            Some(value) => {
                symptoms.push(format!("{} ({} = {value:.3})", sign.symptom, sign.result))
            }
            None => symptoms.push(format!("no {}", sign.result)),
        }
    }
    if symptoms.is_empty() { Outcome::Survives } else { Outcome::Wrong(symptoms) }
}

impl Map {
    /// The entries, case by case.
    fn cases(&self) -> impl Iterator<Item = &[Entry]> {
        self.entries.chunk_by(|a, b| (&a.method, &a.case) == (&b.method, &b.case))
    }

    /// Saves what has been finished, to go on from there another time.
    ///
    /// # Errors
    /// If the file cannot be written; what it held before is still there then.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        let is_finished = |entry: &&Entry| entry.outcome != Outcome::Unfinished;
        let finished: Vec<_> = self.entries.iter().filter(is_finished).collect();
        let next = path.with_extension("part");
        serde_json::to_writer_pretty(File::create(&next)?, &finished)?;
        fs::rename(next, path)
    }

    /// Writes the map as CSV.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> io::Result<()> {
        let mut text = String::from("method,case,variant,outcome,largest_courant,wall_s\n");
        for entry in &self.entries {
            let courant = entry.largest_courant.map_or_else(String::new, |c| c.to_string());
            let outcome = entry.outcome.to_string().replace('"', "'");
            text += &format!(
                "{},\"{}\",\"{}\",\"{outcome}\",{courant},{:.1}\n",
                entry.method, entry.case, entry.variant, entry.wall_s
            );
        }
        std::fs::write(path, text)
    }

    /// Draws the map: a row a case, a tile a variant.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn draw(&self, path: &Path) -> Result<(), FigureError> {
        let mut tiles = Tiles::new("Stability on hard cases")
            .legend(Tone::Good, "survives")
            .legend(Tone::Doubtful, "survives, but wrong")
            .legend(Tone::Bad, "blows up")
            .legend(Tone::Unknown, "not finished");
        for row in self.cases() {
            tiles = tiles.row(&row[0].case, row.iter().map(tile));
        }
        tiles.save(path)
    }
}

/// What [`Map::save`] saved; nothing if there is no such file.
///
/// # Errors
/// If the file cannot be read, or holds something else.
pub fn saved(path: &Path) -> io::Result<Vec<Entry>> {
    match File::open(path) {
        Ok(file) => Ok(serde_json::from_reader(io::BufReader::new(file))?),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(error),
    }
}

fn tile(entry: &Entry) -> Tile {
    let courant = entry.largest_courant.map_or_else(String::new, |c| format!("CFL x {c}"));
    let (tone, note) = match &entry.outcome {
        Outcome::Survives => (Tone::Good, courant),
        Outcome::Wrong(symptoms) => (Tone::Doubtful, first_of(symptoms)),
        Outcome::BlowsUp(_) => (Tone::Bad, "blows up".to_owned()),
        Outcome::Unfinished => (Tone::Unknown, "not finished".to_owned()),
    };
    Tile { label: entry.variant.to_owned(), note, tone }
}

/// What a tile has room for; the page has all.
fn first_of(symptoms: &[String]) -> String {
    match symptoms {
        [] => String::new(),
        [one] => one.clone(),
        [first, ..] => format!("{first} ..."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::hard_cases;

    #[test]
    fn names_with_commas_are_one_field_of_the_table() {
        let [method, case, variant] = ["fd", "a step, carried", "weno5, rk4"].map(str::to_owned);
        let outcome = Outcome::Survives;
        let entry = Entry { method, case, variant, outcome, wall_s: 1.0, largest_courant: None };
        let map = Map { entries: vec![entry], left_out: Vec::new() };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("stability.csv");
        map.write_csv(&path).unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        let row = "fd,\"a step, carried\",\"weno5, rk4\",\"survives\",,1.0";
        assert_eq!(text.lines().nth(1), Some(row));
    }

    #[test]
    fn a_tile_has_room_for_one_symptom() {
        let symptoms = ["too fast (mach = 1.188)", "faster than sound"].map(str::to_owned);
        assert_eq!(first_of(&symptoms[..1]), "too fast (mach = 1.188)");
        assert_eq!(first_of(&symptoms), "too fast (mach = 1.188) ...");
    }

    /// Whatever a flow by lattice Boltzmann is like in the end: if it was as fast as sound it is wrong.
    #[test]
    fn what_was_faster_than_sound_does_not_survive() {
        for case in hard_cases::all().filter(|case| case.method == "lbm") {
            let after = |largest| {
                let results = [("vortices", 2.0), ("mach_reached", 0.1), ("largest_mach", largest)];
                judge(case, &BTreeMap::from(results))
            };
            assert_eq!(after(0.3), Outcome::Survives, "{}", case.name);
            let Outcome::Wrong(symptoms) = after(1.0) else { panic!("{}", case.name) };
            assert_eq!(symptoms, ["faster than sound (largest_mach = 1.000)"], "{}", case.name);
        }
    }
}
