//! `finegrain run`.

use std::collections::BTreeMap;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use finegrain::bench::{memory, workers};
use finegrain::framework::Schedule;
use finegrain::framework::format::AtomicFile;
use finegrain::scene::{
    Method, Orders, Parameter, Parameters, Precision, Report, Scene, SceneError, Value,
};
use serde::Serialize;

use super::CommandError;
use super::progress::ProgressLine;
use super::scene_file::SceneFile;
use super::signals::Requests;

/// Arguments of `finegrain run`.
#[derive(Args)]
#[command(after_help = SCENE_FILE)]
pub struct RunArguments {
    /// Name of a built-in scene (see `finegrain scenes`), or a TOML file (see below).
    scene: String,
    /// Set a parameter of the scene (see `finegrain scenes`); may be given several times.
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = setting)]
    settings: Vec<(String, String)>,
    /// Numerical method; the scene's first by default.
    #[arg(long)]
    method: Option<String>,
    /// Number of worker threads; all cores by default, but at most one for every 500 particles of SPH, 4,000 sites
    /// of lattice Boltzmann or 8,000 points of finite differences. The bits do not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    workers: Option<u16>,
    /// How workers meet: serial, lockstep, peer-to-peer, fork-join or fixed.
    #[arg(long, default_value_t)]
    schedule: Schedule,
    /// Scalar type [default: f64].
    #[arg(long)]
    precision: Option<Precision>,
    /// End after so many steps, counted from time 0; without this and --until a scene ends by itself.
    #[arg(long, value_parser = at_least::<0>, allow_negative_numbers = true)]
    steps: Option<u64>,
    /// End at this time, in seconds, counted from time 0. To hit it steps are made a little shorter, the last ones
    /// or all of a method with a fixed time step; lattice Boltzmann and implicit steps, which cannot be, end with
    /// the first step that reaches it.
    #[arg(long, value_parser = positive, allow_negative_numbers = true)]
    until: Option<f64>,
    /// End after so many seconds of wall-clock time, in order; --restart goes on from there.
    #[arg(long, value_name = "SECONDS", value_parser = duration, allow_negative_numbers = true)]
    wall_clock: Option<Duration>,
    /// Folder for dumps, histories, checkpoints and the picture of the final field; files of an
    /// earlier run in it are overwritten where they have the same names, and stay where not.
    #[arg(long)]
    out: Option<PathBuf>,
    /// Dump fields for ParaView every so many steps (needs --out); ten times on the way to the end
    /// time of the scene by default, wherever the run ends. The beginning and the end are always shown.
    #[arg(long, requires = "out", value_parser = at_least::<1>, allow_negative_numbers = true)]
    dump_every: Option<u64>,
    /// Write OUT/checkpoint-STEP.ckpt every so many steps (needs --out), and keep the last three. One
    /// is always written at the end, Ctrl-C and SIGTERM included, and (with --out) whenever SIGUSR1 comes.
    #[arg(long, requires = "out", value_parser = at_least::<1>, allow_negative_numbers = true)]
    checkpoint_every: Option<u64>,
    /// Write which worker ran which sub-domain's which stage when, the last 200,000 parts of each
    /// worker, as a trace that chrome://tracing and ui.perfetto.dev open; and say what it sums up to.
    #[arg(long, value_name = "FILE")]
    trace: Option<PathBuf>,
    /// Go on from this checkpoint; scene, parameters and precision must be those of its run.
    #[arg(long, value_name = "FILE")]
    restart: Option<PathBuf>,
    /// Print one JSON object as the last line of standard output.
    #[arg(long)]
    json: bool,
}

/// A parameter and its value.
pub fn setting(text: &str) -> Result<(String, String), String> {
    text.split_once('=')
        .map(|(key, value)| (key.trim().to_owned(), value.trim().to_owned()))
        .filter(|(key, _)| !key.is_empty())
        .ok_or_else(|| format!("{text:?} is not of the form KEY=VALUE"))
}

/// A whole number that is not too small.
pub fn at_least<const LEAST: u64>(text: &str) -> Result<u64, String> {
    text.parse()
        .ok()
        .filter(|n: &u64| *n >= LEAST)
        .ok_or_else(|| format!("{text:?} is not a whole number of at least {LEAST}"))
}

/// A finite number above zero.
pub(super) fn positive(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| *x > 0.0 && x.is_finite())
        .ok_or_else(|| format!("{text:?} is not a finite number above zero"))
}

fn duration(text: &str) -> Result<Duration, String> {
    Duration::try_from_secs_f64(positive(text)?).map_err(|why| format!("{text} s: {why}"))
}

/// What `--json` prints.
#[derive(Serialize)]
struct Line<'a> {
    scene: &'a str,
    method: &'a str,
    /// Those that have an effect.
    parameters: BTreeMap<&'static str, &'a Value>,
    precision: Precision,
    schedule: &'a str,
    workers: usize,
    instruction_sets: &'a [String],
    stopped: String,
    steps: u64,
    time: f64,
    wall_s: f64,
    /// Largest resident memory of the process, bytes.
    peak_memory: Option<u64>,
    points: usize,
    point_steps_per_s: f64,
    state_hash: String,
    results: &'a BTreeMap<&'static str, f64>,
    errors: &'a BTreeMap<&'static str, f64>,
    notes: &'a [String],
    files: &'a [PathBuf],
}

/// The form of a scene file, shown by `--help`.
const SCENE_FILE: &str = "\
A scene file is TOML; all but the scene's name may be left out:

    scene = \"cylinder\"
    method = \"sph\"
    precision = \"f64\"

    [parameters]
    resolution = 100
    kernel = \"quintic-spline\"

What the command line says goes over it.

Signals: Ctrl-C and SIGTERM end the run in order, with a checkpoint if there is --out; a second one ends
the process at once. SIGUSR1 asks for a checkpoint, and the run goes on: kill -USR1 PID.

Exit code: 0 when the run ended in order (Ctrl-C and SIGTERM included), 1 after an error (an unknown scene or
parameter, a value out of its range, and whatever ends a run too early), 2 for options that do not exist or cannot be read, 130 after a second Ctrl-C or SIGTERM.";

/// What an earlier run has left in a folder, single fields aside; empty if nothing.
fn left_behind(folder: &Path) -> String {
    let files = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
    let names = files.filter_map(|file| file.file_name().into_string().ok());
    let is_of_a_run = |name: &String| {
        [".ckpt", ".csv", ".pvd", ".png"].iter().any(|ending| name.ends_with(ending))
    };
    let mut names: Vec<_> = names.filter(is_of_a_run).collect();
    names.sort_unstable();
    names.join(", ")
}

/// Says which of the parameters that were set have no effect.
pub(super) fn say_without_effect(
    method: &Method,
    parameters: &Parameters,
    settings: &[(String, String)],
) {
    let declared = (method.parameters)();
    let is_set = |parameter: &&Parameter| settings.iter().any(|(key, _)| key == parameter.name);
    for parameter in declared.iter().filter(is_set) {
        if let (false, Some((other, values))) =
            (parameters.has_effect(parameter), parameter.only_with)
        {
            let (name, values) = (parameter.name, values.join(" or "));
            eprintln!("note: {name} has no effect here, only with {other} = {values}");
        }
    }
}

/// A failure that names its last checkpoint once.
fn told_once(mut error: SceneError) -> SceneError {
    if let SceneError::Run(failed) = &mut error
        && let Some(path) = &failed.last_checkpoint
        && failed.cause.to_string().contains(&path.display().to_string())
    {
        failed.last_checkpoint = None;
    }
    error
}

/// Runs a scene and says what it came to.
pub fn run(arguments: RunArguments) -> Result<(), CommandError> {
    let is_file = Path::new(&arguments.scene).extension().is_some_and(|e| e == "toml");
    let file = if is_file {
        SceneFile::read(Path::new(&arguments.scene))?
    } else {
        SceneFile { scene: arguments.scene.clone(), ..SceneFile::default() }
    };
    let in_file = |error: CommandError| -> CommandError {
        if is_file { format!("scene file `{}`: {error}", arguments.scene).into() } else { error }
    };
    let scene = Scene::find(&file.scene).map_err(|e| -> CommandError {
        if is_file || !Path::new(&arguments.scene).exists() {
            return in_file(e.into());
        }
        format!("`{}` is no scene file, whose name would end in .toml; {e}", arguments.scene).into()
    })?;
    // What the command line says goes over what the file says; each answers for its own mistakes.
    let is_files_method = arguments.method.is_none();
    let method = arguments.method.or(file.method.clone());
    let method = scene
        .method(method.as_deref())
        .map_err(|e| if is_files_method { in_file(e.into()) } else { e.into() })?
        .name;
    let mut settings = file.settings();
    let set = |settings: &[(String, String)]| -> Result<Parameters, CommandError> {
        Ok(scene.set_for(Some(method), settings.iter().map(|(k, v)| (k.as_str(), v.as_str())))?)
    };
    set(&settings).map_err(in_file)?;
    settings.extend(arguments.settings);
    let parameters = set(&settings)?;
    say_without_effect(scene.method(Some(method))?, &parameters, &settings);
    let precision = arguments.precision.or(file.precision.map(Into::into)).unwrap_or_default();
    let prepared = scene
        .prepare(Some(method), &parameters, precision)
        .map_err(|e| if is_files_method { in_file(e.into()) } else { e.into() })?;

    if let Some(path) = &arguments.trace {
        // Before the run, not after it; what is there stays until there is a trace.
        AtomicFile::create(path)
            .map_err(|why| format!("cannot write trace `{}`: {why}", path.display()))?;
        if arguments.restart.as_ref() == Some(path) {
            return Err(format!(
                "`{}` is the checkpoint to restart from, and not to be the trace",
                path.display()
            )
            .into());
        }
    }

    let requests = Requests::listen()?;
    if let (Some(out), None) = (&arguments.out, &arguments.restart) {
        let names = left_behind(out);
        if !names.is_empty() {
            eprintln!(
                "note: {} holds files of an earlier run, which are overwritten only where this one has the \
                 same names: {names}",
                out.display()
            );
        }
    }
    let bar = std::io::stderr().is_terminal().then(ProgressLine::start);
    let orders = Orders {
        schedule: arguments.schedule,
        workers: arguments.workers.map(usize::from),
        steps: arguments.steps,
        until: arguments.until,
        wall_clock: arguments.wall_clock,
        out: arguments.out.clone(),
        dump_every: arguments.dump_every,
        checkpoint_every: arguments.checkpoint_every,
        trace: arguments.trace,
        restart: arguments.restart,
        progress: bar.as_ref().map(|bar| bar.port.clone()),
        stops: Some(requests.stops),
        checkpoint_requests: Some(requests.checkpoints),
    };
    let points = prepared.points();
    let workers = prepared.workers(&orders);
    let counted = workers::counted(workers);
    eprintln!("{}: {points} points, {}, {counted}", scene.name, arguments.schedule);
    let outcome = prepared.run(orders);
    if let Some(bar) = bar {
        bar.finish();
    }
    let mut report = outcome.map_err(told_once)?;
    // All files before the first word, for who reads may stop listening.
    let picture = match (&arguments.out, &report.picture) {
        (Some(out), Some(picture)) => {
            let path = out.join("final.png");
            picture.save(&path)?;
            Some(path)
        }
        _ => None,
    };
    let mut stdout = std::io::stdout().lock();
    say(&mut stdout, &report)?;
    if let Some(path) = picture {
        writeln!(stdout, "picture of the final field: {}", path.display())?;
        report.files.push(path);
    }
    if arguments.json {
        let line = Line {
            scene: scene.name,
            method,
            parameters: parameters.effective(&(scene.method(Some(method))?.parameters)()),
            precision,
            schedule: arguments.schedule.name(),
            workers,
            instruction_sets: &report.instruction_sets,
            stopped: report.stopped.to_string(),
            steps: report.steps,
            time: report.time,
            wall_s: report.wall_s,
            peak_memory: memory::peak(),
            points,
            point_steps_per_s: report.point_steps_per_s(),
            state_hash: format!("{:016x}", report.state_hash),
            results: &report.results,
            errors: &report.errors,
            notes: &report.notes,
            files: &report.files,
        };
        writeln!(stdout, "{}", serde_json::to_string(&line)?)?;
    }
    Ok(())
}

/// With three digits that mean something.
fn percent(part: f64) -> String {
    if part == 0.0 {
        return "0 %".to_owned();
    }
    let percent = 100.0 * part;
    let exponent = percent.abs().log10().floor();
    if (-3.0..6.0).contains(&exponent) {
        let decimals = (2.0 - exponent).max(0.0) as usize;
        format!("{percent:+.decimals$} %")
    } else {
        format!("{percent:+.2e} %")
    }
}

fn say(out: &mut impl Write, report: &Report) -> std::io::Result<()> {
    writeln!(
        out,
        "{} after {} step{}, t = {:.6e} s, in {:.2} s ({:.3} million point-steps a second)",
        report.stopped,
        report.steps,
        if report.steps == 1 { "" } else { "s" },
        report.time,
        report.wall_s,
        report.point_steps_per_s() / 1e6
    )?;
    for (name, value) in &report.results {
        match report.errors.get(name) {
            Some(error) if error != value => {
                writeln!(out, "  {name} = {value:.6e} (relative error {})", percent(*error))?;
            }
            _ => writeln!(out, "  {name} = {value:.6e}")?,
        }
    }
    writeln!(out, "  state hash {:016x}", report.state_hash)?;
    if report.instruction_sets.len() > 1 {
        let sets = report.instruction_sets.join(", then ");
        writeln!(out, "  computed with {sets}: the bits are not those of either alone")?;
    }
    if let Some(trace) = &report.trace {
        writeln!(out, "{trace}")?;
    }
    for note in &report.notes {
        writeln!(out, "  note: {note}")?;
    }
    for file in
        report.files.iter().filter(|f| f.extension().is_some_and(|e| e != "vtu" && e != "vti"))
    {
        writeln!(out, "  wrote {}", file.display())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::percent;

    #[test]
    fn errors_have_digits_that_mean_something() {
        let said = [-0.00000123, 0.0126, -4.0, 266.634, 1e-12, 0.0].map(percent);
        assert_eq!(said, ["-1.23e-4 %", "+1.26 %", "-400 %", "+26663 %", "+1.00e-10 %", "0 %"]);
    }
}
