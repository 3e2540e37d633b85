//! `finegrain bench`.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use finegrain::bench::breakdown::{self, Breakdown};
use finegrain::bench::cylinder::{self, Measured, Plan};
use finegrain::bench::figures;
use finegrain::bench::row::{self, Row};
use finegrain::bench::workers;
use finegrain::framework::Schedule;
use finegrain::scene::{Precision, SceneError};
use finegrain::sph::{Pairs, Viscosity};

use super::CommandError;
use super::run::at_least;

/// Benchmarks.
#[derive(Subcommand)]
pub enum BenchCommand {
    /// The paper's cylinder: time per step, speed-up and efficiency (Figs. 10 to 12).
    Cylinder(CylinderArguments),
}

impl Default for BenchCommand {
    fn default() -> Self {
        Self::Cylinder(CylinderArguments {
            sizes: vec![0.001],
            workers: Vec::new(),
            steps: 20,
            repeats: 3,
            schedule: Schedule::default(),
            precision: Precision::default(),
            viscous_form: ViscousForm::default(),
            pairs: KeptPairs::default(),
            out: PathBuf::from("out/bench-cylinder"),
        })
    }
}

/// Form of the viscous term.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum ViscousForm {
    /// Strain-rate form of the paper, eq. I.2: two sweeps a step.
    #[default]
    StrainRate,
    /// Morris et al. (1997): one sweep a step.
    Morris,
}

/// Whether sweeps share their lists of neighbours.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum KeptPairs {
    /// Every sweep searches.
    #[default]
    Searched,
    /// The second looks up what the first has found, at two bytes a pair.
    Kept,
}

/// Arguments of `finegrain bench cylinder`.
#[derive(Args)]
pub struct CylinderArguments {
    /// Widths of the box in metres, separated by commas; the paper's are 0.001 to 0.007, about 100,000
    /// particles each 0.001. It does not give the other sides, which are chosen to hold as many; the box is
    /// fitted to whole layers of the packing.
    #[arg(long, value_delimiter = ',', default_value = "0.001", value_parser = width)]
    sizes: Vec<f64>,
    /// Numbers of workers, separated by commas; 1, 2, 4 ... and all cores by default.
    #[arg(long, value_delimiter = ',', value_parser = clap::value_parser!(u16).range(1..=1024))]
    workers: Vec<u16>,
    /// Steps of a sample.
    #[arg(long, default_value_t = 20, value_parser = at_least::<1>)]
    steps: u64,
    /// Samples of each number of workers; they take turns every 10 steps.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,
    /// How workers meet: serial, lockstep, peer-to-peer, fork-join or fixed.
    #[arg(long, default_value_t)]
    schedule: Schedule,
    /// Scalar type.
    #[arg(long, default_value = "f64")]
    precision: Precision,
    /// Form of the viscous term.
    #[arg(long, default_value = "strain-rate")]
    viscous_form: ViscousForm,
    /// Lists of neighbours.
    #[arg(long, default_value = "searched")]
    pairs: KeptPairs,
    /// Folder for pictures, numbers and results dumps.
    #[arg(long, default_value = "out/bench-cylinder")]
    out: PathBuf,
}

fn width(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|x: &f64| (0.0003..=0.1).contains(x))
        .ok_or_else(|| format!("{text:?} is not a width in metres between 0.0003 and 0.1"))
}

/// Runs a benchmark.
pub fn bench(command: BenchCommand) -> Result<(), CommandError> {
    let out = &mut std::io::stdout();
    let BenchCommand::Cylinder(arguments) = command;
    let workers = if arguments.workers.is_empty() {
        workers::doubling(std::thread::available_parallelism()?.get())
    } else {
        arguments.workers.iter().map(|&w| usize::from(w)).collect()
    };
    let plan = Plan {
        widths: arguments.sizes,
        workers,
        steps: arguments.steps,
        repeats: usize::from(arguments.repeats),
        schedule: arguments.schedule,
        precision: arguments.precision,
        viscosity: match arguments.viscous_form {
            ViscousForm::StrainRate => Viscosity::StrainRate,
            ViscousForm::Morris => Viscosity::Morris,
        },
        pairs: match arguments.pairs {
            KeptPairs::Kept => Pairs::Kept,
            KeptPairs::Searched => Pairs::Searched,
        },
        out: arguments.out,
    };
    writeln!(
        out,
        "Flow past a cylinder (Holmes, Williams & Tilke 2011): {} steps, a results dump every 10, \
         {} samples of each, {}, {}",
        plan.steps,
        plan.repeats,
        plan.schedule,
        finegrain::framework::lanes::instruction_set()
    )?;
    boxes(out, &plan)?;
    let Measured { rows, flow } = cylinder::measure(&plan, |row| {
        let last = row.turns.last().map_or(0.0, |turn| turn.seconds);
        // Only progress: who does not listen misses nothing.
        let _ = writeln!(
            std::io::stderr(),
            "  {} particles, {}: {last:.4} s/step",
            row.particles,
            workers::counted(row.workers)
        );
    })?;
    // All files before the numbers are said, for who reads may stop listening.
    row::write_csv(&plan.out.join("cylinder.csv"), &rows)?;
    let mut pictures = figures::draw(&plan.out, &rows)?;
    if let Some(flow) = flow {
        let path = plan.out.join("flow.png");
        flow.save(&path)?;
        pictures.push(path);
    }
    let breakdown = breakdown::measure(&plan)?;
    let where_time_goes = plan.out.join("where-time-goes.csv");
    breakdown.write_csv(&where_time_goes)?;
    table(out, &rows)?;
    doubts(out, &rows)?;
    breakdown_table(out, &breakdown)?;
    writeln!(out, "\nnumbers:  {}", plan.out.join("cylinder.csv").display())?;
    writeln!(out, "          {}", where_time_goes.display())?;
    for picture in pictures {
        writeln!(out, "picture:  {}", picture.display())?;
    }
    for &workers in &plan.workers {
        let series = cylinder::dump_folder(&plan, workers).join("results.pvd");
        writeln!(out, "ParaView: {}", series.display())?;
    }
    Ok(())
}

/// Says what is assumed that the paper does not say.
fn boxes(out: &mut impl Write, plan: &Plan) -> Result<(), CommandError> {
    writeln!(
        out,
        "The paper gives spacing ({} m) and widths. A cylinder of radius {} m across a box of {} m x {} m is\n\
         assumed here; the box is fitted to whole layers of the close packing:",
        cylinder::SPACING,
        cylinder::RADIUS,
        cylinder::SIDE,
        cylinder::SIDE
    )?;
    for &width in &plan.widths {
        let lattice = cylinder::lattice(width).map_err(SceneError::from)?;
        let [x, y, z] = lattice.lengths();
        let sites = lattice.count();
        writeln!(out, "  width {width} m: {x:.5} m x {y:.5} m x {z:.5} m, {sites} particles")?;
    }
    Ok(())
}

fn table(out: &mut impl Write, rows: &[Row]) -> std::io::Result<()> {
    writeln!(
        out,
        "\n{:>7} {:>9} {:>7} {:>12} {:>12} {:>8} {:>6} {:>10} {:>7} {:>8} {:>7} {:>13} \
         {:>9}",
        "width/m",
        "particles",
        "workers",
        "s/step (med)",
        "s/step (min)",
        "speed-up",
        "(best)",
        "efficiency",
        "stages",
        "schedule",
        "machine",
        "Minteractions",
        "B/particle"
    )?;
    let optional = |x: Option<f64>, digits: usize| {
        x.map_or_else(|| "-".to_owned(), |x| format!("{x:.digits$}"))
    };
    for row in rows {
        writeln!(
            out,
            "{:>7} {:>9} {:>7} {:>12.4} {:>12.4} {:>8} {:>6} {:>10} {:>7} {:>8} {:>7} {:>13.1} {:>9}",
            row.width,
            row.particles,
            row.workers,
            row.seconds(),
            row.best(),
            optional(row.speed_up(), 3),
            optional(row.best_speed_up(), 3),
            optional(row.efficiency(), 3),
            optional(row.stage_efficiency(), 3),
            optional(row.schedule_efficiency(), 3),
            optional(row.machine_efficiency(), 3),
            row.interactions_per_second() / 1e6,
            optional(row.bytes_per_particle(), 0),
        )?;
    }
    if let Some(row) = rows.first() {
        writeln!(
            out,
            "medians over turns of 10 steps; speed-up: of the medians (of the best turns); efficiency: over workers\n\
             efficiency = stages x schedule: what the same stages take with one worker over what they take with\n\
             all, and the share of the time that workers spend in them, likewise\n\
             machine: efficiency of as many separate runs of one worker each, all at the same time\n\
             Minteractions: million pair interactions a second and core in whole steps (median), {:.1}\n\
             neighbours a particle visited in {} sweep(s) a step; every visit counts",
            row.neighbours, row.sweeps
        )?;
    }
    Ok(())
}

/// Worst over best turn from which on a row is not to be trusted.
const SCATTER: f64 = 1.5;

/// Says which rows are not to be trusted.
fn doubts(out: &mut impl Write, rows: &[Row]) -> std::io::Result<()> {
    for row in rows.iter().filter(|row| row.scatter() > SCATTER) {
        writeln!(
            out,
            "note: width {} m, {}: the slowest turn took {:.1} times as long as the fastest; the machine was \
             busy, and this row is not to be trusted",
            row.width,
            workers::counted(row.workers),
            row.scatter()
        )?;
    }
    Ok(())
}

fn breakdown_table(out: &mut impl Write, breakdown: &Breakdown) -> std::io::Result<()> {
    writeln!(
        out,
        "\nWhere the time goes: {} particles, one worker, {:.4} s a step\n\n{:<18} {:>6} {:>11} {:>8} {:>7} \
         {:>7} {:>7}",
        breakdown.particles,
        breakdown.seconds,
        "part",
        "share",
        "ns/particle",
        "GFLOP/s",
        "of peak",
        "GB/s",
        "of copy",
    )?;
    let percent = |x: f64| format!("{:.1} %", 100.0 * x);
    for part in &breakdown.parts {
        let rates = [part.flops, part.bytes].into_iter().zip(part.limits).map(|(amount, limit)| {
            let rate = amount.map(|amount| amount / part.seconds);
            let text = |x: Option<String>| x.unwrap_or_else(|| "-".to_owned());
            let of_limit = rate.map(|rate| percent(rate / limit));
            [text(rate.map(|rate| format!("{:.1}", 1e-9 * rate))), text(of_limit)]
        });
        let rates: Vec<_> = rates.flatten().collect();
        writeln!(
            out,
            "{:<18} {:>6} {:>11.1} {:>8} {:>7} {:>7} {:>7}",
            part.name,
            percent(part.seconds / breakdown.seconds),
            1e9 * part.seconds / breakdown.particles as f64,
            rates[0],
            rates[1],
            rates[2],
            rates[3],
        )?;
    }
    writeln!(
        out,
        "share: by looking at the worker every 0.1 ms; operations, and bytes loaded and stored wherever they \
         lie, are counted in the source\nof peak: of multiply-adds in registers; of copy: of a copy in the \
         nearest cache, for updates in memory"
    )
}
