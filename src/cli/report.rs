//! `finegrain report`.

use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};
use finegrain::report::hard_cases::{self, HardCase};
use finegrain::report::stability::{self, Plan};

use super::CommandError;

/// Reports over many runs.
#[derive(Subcommand)]
pub enum ReportCommand {
    /// Which variants of a scheme survive hard cases: a table and a picture.
    Stability(StabilityArguments),
}

/// Arguments of `finegrain report stability`.
#[derive(Args)]
pub struct StabilityArguments {
    /// Only cases whose name contains this.
    #[arg(long, default_value = "")]
    case: String,
    /// Only cases of this method.
    #[arg(long, value_parser = ["sph", "lbm"])]
    method: Option<String>,
    /// Begin no run after so many minutes.
    #[arg(long, default_value_t = 60.0)]
    budget: f64,
    /// Number of worker threads; all cores by default.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Option<u16>,
    /// Folder for the table and the picture.
    #[arg(long, default_value = "out/stability")]
    out: PathBuf,
}

/// Makes a report.
pub fn report(command: ReportCommand) -> Result<(), CommandError> {
    let ReportCommand::Stability(arguments) = command;
    let is_asked_for = |case: &HardCase| {
        case.name.contains(&arguments.case)
            && arguments.method.as_ref().is_none_or(|method| case.method == method)
    };
    let cases: Vec<HardCase> =
        hard_cases::all().filter(|case| is_asked_for(case)).copied().collect();
    if cases.is_empty() {
        let known: Vec<_> = hard_cases::all().map(|case| case.name).collect();
        let known = known.join(", ");
        return Err(format!("no case contains {:?}; there are {known}", arguments.case).into());
    }
    let budget = Duration::try_from_secs_f64(60.0 * arguments.budget)
        .map_err(|why| format!("budget of {} minutes: {why}", arguments.budget))?;
    let plan = Plan { cases, budget, workers: arguments.workers.map(usize::from) };
    std::fs::create_dir_all(&arguments.out)
        .map_err(|why| format!("cannot make folder `{}`: {why}", arguments.out.display()))?;
    let mut out = std::io::stdout().lock();
    let map = stability::map(&plan, |entry| {
        let courant = entry.largest_courant.map_or_else(String::new, |c| format!(", CFL x {c}"));
        // Only progress: who does not listen misses nothing.
        let _ = writeln!(
            out,
            "{}, {}: {}{courant} ({:.1} s)",
            entry.case, entry.variant, entry.outcome, entry.wall_s
        );
    })?;
    for (case, variant) in &map.left_out {
        writeln!(out, "{case}, {variant}: not run, the time was up")?;
    }
    let (table, picture) =
        (arguments.out.join("stability.csv"), arguments.out.join("stability.png"));
    map.write_csv(&table)?;
    writeln!(out, "\nnumbers:  {}", table.display())?;
    if !map.entries.is_empty() {
        map.draw(&picture)?;
        writeln!(out, "picture:  {}", picture.display())?;
    }
    Ok(())
}
