//! `finegrain report`.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::{Args, Subcommand};
use finegrain::report::hard_cases::{self, HardCase};
use finegrain::report::machine::Machine;
use finegrain::report::scaling::{self, Scaling};
use finegrain::report::speed_vs_error::{self, COMPARISONS, Survey};
use finegrain::report::stability;
use finegrain::scene::{Precision, Scene};

use super::CommandError;
use super::run::{at_least, positive, say_without_effect, setting};

/// Reports over many runs.
#[derive(Subcommand)]
pub enum ReportCommand {
    /// Which variants of a scheme survive hard cases: a table and a picture.
    Stability(StabilityArguments),
    /// What an error costs by which method, in which precision: a table and a page to look at.
    SpeedVsError(SpeedVsErrorArguments),
    /// How a scene scales: Figs. 10 to 12 of the paper, measured here and forecast for up to 128 workers.
    Scaling(ScalingArguments),
}

/// Arguments of `finegrain report stability`.
#[derive(Args)]
pub struct StabilityArguments {
    /// Only cases whose name contains this.
    #[arg(long, default_value = "")]
    case: String,
    /// Only cases of this method.
    #[arg(long, value_parser = ["sph", "lbm", "fd"])]
    method: Option<String>,
    /// Begin no run after so many minutes.
    #[arg(long, value_name = "MINUTES", default_value = "60", value_parser = minutes, allow_negative_numbers = true)]
    budget: Duration,
    /// Number of worker threads; all cores by default, but at most one for every 500 particles of SPH, 4,000
    /// sites of lattice Boltzmann or 8,000 points of finite differences.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
    /// Folder for the table, the page and the picture; a map that is there already is gone on with
    #[arg(long, default_value = "out/stability")]
    out: PathBuf,
}

/// Arguments of `finegrain report speed-vs-error`.
#[derive(Args)]
pub struct SpeedVsErrorArguments {
    /// Only comparisons whose name contains this.
    #[arg(long, default_value = "")]
    scene: String,
    /// Only this method.
    #[arg(long, value_parser = ["sph", "lbm", "fd"])]
    method: Option<String>,
    /// Begin no run that would end after so many minutes; the cheapest are run first.
    #[arg(long, value_name = "MINUTES", default_value = "30", value_parser = minutes, allow_negative_numbers = true)]
    budget: Duration,
    /// Number of worker threads; all cores by default, but at most one for every 500 particles of SPH, 4,000
    /// sites of lattice Boltzmann or 8,000 points of finite differences.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
    /// Folder for the page, the table and the pictures.
    #[arg(long, default_value = "out/speed-vs-error")]
    out: PathBuf,
}

/// Arguments of `finegrain report scaling`.
#[derive(Args)]
pub struct ScalingArguments {
    /// Name of a built-in scene (see `finegrain scenes`).
    scene: String,
    /// Set a parameter of the scene; may be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    settings: Vec<(String, String)>,
    /// Numerical method; the scene's first by default.
    #[arg(long)]
    method: Option<String>,
    /// Scalar type.
    #[arg(long, default_value = "f64")]
    precision: Precision,
    /// Steps of a run.
    #[arg(long, default_value_t = 50, value_parser = at_least::<2>)]
    steps: u64,
    /// Runs of every schedule and number of workers.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,
    /// Most workers; as many as there are cores by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
    /// Folder for the page, the table and traces.
    #[arg(long, default_value = "out/scaling")]
    out: PathBuf,
}

/// Makes a report.
pub fn report(command: ReportCommand) -> Result<(), CommandError> {
    match command {
        ReportCommand::Stability(arguments) => stability(arguments),
        ReportCommand::SpeedVsError(arguments) => speed_vs_error(arguments),
        ReportCommand::Scaling(arguments) => scaling(arguments),
    }
}

fn stability(arguments: StabilityArguments) -> Result<(), CommandError> {
    let is_asked_for = |case: &HardCase| {
        case.name.contains(&arguments.case)
            && arguments.method.as_ref().is_none_or(|method| case.method == method)
    };
    let cases: Vec<HardCase> =
        hard_cases::all().filter(|case| is_asked_for(case)).copied().collect();
    if cases.is_empty() {
        let is_of_method =
            |case: &&HardCase| arguments.method.as_ref().is_none_or(|method| case.method == method);
        let known: BTreeSet<_> =
            hard_cases::all().filter(is_of_method).map(|case| case.name).collect();
        let known = known.into_iter().collect::<Vec<_>>().join("; ");
        return Err(format!("no case contains {:?}; there are {known}", arguments.case).into());
    }
    make_folder(&arguments.out)?;
    let memory = arguments.out.join("stability.json");
    let known = stability::saved(&memory)
        .map_err(|error| format!("{} is not a map to go on from: {error}", memory.display()))?;
    let workers = arguments.workers.map(usize::from);
    let plan = stability::Plan { cases, known, budget: arguments.budget, workers };
    let mut out = std::io::stdout().lock();
    let mut unsaved = Ok(());
    let map = stability::map(&plan, |map| {
        let Some(entry) = map.entries.last() else { return };
        let courant = entry.largest_courant.map_or_else(String::new, |c| format!(", CFL x {c}"));
        // Only progress: who does not listen misses nothing.
        let _ = writeln!(
            out,
            "{}, {}: {}{courant} ({:.1} s)",
            entry.case, entry.variant, entry.outcome, entry.wall_s
        );
        unsaved = map.save(&memory);
    })?;
    unsaved?;
    let (table, picture) =
        (arguments.out.join("stability.csv"), arguments.out.join("stability.png"));
    map.write_csv(&table)?;
    let page = arguments.out.join("index.html");
    map.page(command_line()).write(&page, &Machine::here())?;
    if !map.entries.is_empty() {
        map.draw(&picture)?;
    }
    for (case, variant) in &map.left_out {
        writeln!(out, "{case}, {variant}: not run, the time was up")?;
    }
    writeln!(out, "\nnumbers:  {}", table.display())?;
    writeln!(out, "page:     {}", page.display())?;
    if !map.entries.is_empty() {
        writeln!(out, "picture:  {}", picture.display())?;
    }
    Ok(())
}

fn speed_vs_error(arguments: SpeedVsErrorArguments) -> Result<(), CommandError> {
    let is_asked_for = |name: &str| name.contains(&arguments.scene);
    let comparisons: Vec<_> = COMPARISONS.iter().filter(|c| is_asked_for(c.name)).collect();
    if comparisons.is_empty() {
        let known: Vec<_> = COMPARISONS.iter().map(|comparison| comparison.name).collect();
        let known = known.join("; ");
        return Err(
            format!("no comparison contains {:?}; there are {known}", arguments.scene).into()
        );
    }
    let plan = speed_vs_error::Plan {
        program: std::env::current_exe()?,
        comparisons,
        method: arguments.method,
        budget: arguments.budget,
        workers: arguments.workers.map(usize::from),
    };
    make_folder(&arguments.out)?;
    let mut out = std::io::stdout().lock();
    let survey = Survey::run(&plan, |case, outcome| {
        // Only progress: who does not listen misses nothing.
        let _ = writeln!(
            out,
            "{}, {}, {} points across: {outcome}",
            case.comparison.name,
            case.line.title(),
            case.resolution
        );
    })?;
    let (table, page) =
        (arguments.out.join("speed-vs-error.csv"), arguments.out.join("index.html"));
    survey.write_csv(&table)?;
    survey.page(command_line()).write(&page, &Machine::here())?;
    survey.draw(&arguments.out)?;
    writeln!(out, "\nnumbers:  {}", table.display())?;
    writeln!(out, "page:     {}", page.display())?;
    Ok(())
}

fn scaling(arguments: ScalingArguments) -> Result<(), CommandError> {
    let scene = Scene::find(&arguments.scene)?;
    let method = scene.method(arguments.method.as_deref())?.name;
    let settings = arguments.settings.iter().map(|(key, value)| (key.as_str(), value.as_str()));
    let parameters = scene.set_for(Some(method), settings.clone())?;
    say_without_effect(scene.method(Some(method))?, &parameters, &arguments.settings);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let plan = scaling::Plan {
        scene,
        method,
        parameters,
        precision: arguments.precision,
        steps: arguments.steps,
        repeats: usize::from(arguments.repeats),
        workers: arguments.workers.map_or(cores, usize::from),
        out: arguments.out.clone(),
    };
    make_folder(&arguments.out)?;
    let mut out = std::io::stdout().lock();
    let scaling = Scaling::run(&plan, |what| {
        // Only progress: who does not listen misses nothing.
        let _ = writeln!(out, "{what}");
    })?;
    let (table, page) = (arguments.out.join("scaling.csv"), arguments.out.join("index.html"));
    scaling.write_csv(&table)?;
    let settings: String = settings.map(|(key, value)| format!(", {key} = {value}")).collect();
    let title = format!("{} by {}{settings}", scene.name, method.to_uppercase());
    scaling.page(&title, command_line()).write(&page, &Machine::here())?;
    writeln!(out, "\nnumbers:  {}", table.display())?;
    writeln!(out, "page:     {}", page.display())?;
    Ok(())
}

/// The command that this is.
fn command_line() -> String {
    let words: Vec<String> = std::env::args().skip(1).collect();
    format!("finegrain {}", words.join(" "))
}

fn minutes(text: &str) -> Result<Duration, String> {
    Duration::try_from_secs_f64(60.0 * positive(text)?)
        .map_err(|why| format!("{text} minutes: {why}"))
}

fn make_folder(path: &Path) -> Result<(), CommandError> {
    std::fs::create_dir_all(path)
        .map_err(|why| format!("cannot make folder `{}`: {why}", path.display()).into())
}
