//! What it costs to trace a run (`--trace`): the same steps with and without, in turns.

use std::thread;

use finegrain::scene::{Orders, Precision, Scene};

type Error = Box<dyn std::error::Error>;

/// Samples of each case.
const SAMPLES: usize = 15;

/// Scene, method, resolution, and steps of a sample: from large parts to small ones.
const CASES: [(&str, &str, &str, u64); 3] = [
    ("taylor-green", "sph", "150", 60),
    ("taylor-green", "lbm", "512", 300),
    ("heat", "fd", "1000", 300),
];

fn main() -> Result<(), Error> {
    let workers = thread::available_parallelism()?.get();
    println!("workers: {workers}, {SAMPLES} samples in turns\n");
    println!("| run | parts a second | ms a step, best: without | traced | cost: best | median |");
    println!("|---|---|---|---|---|---|");
    for (scene, method, resolution, steps) in CASES {
        let mut samples = Vec::new();
        let mut parts = 0.0;
        for _ in 0..SAMPLES {
            let (without, _) = run(scene, method, resolution, steps, false)?;
            let (traced, a_second) = run(scene, method, resolution, steps, true)?;
            samples.push([without, traced]);
            parts = a_second;
        }
        let best = |k: usize| samples.iter().map(|s| s[k]).fold(f64::INFINITY, f64::min);
        let mut ratios: Vec<_> = samples.iter().map(|s| s[1] / s[0]).collect();
        ratios.sort_by(f64::total_cmp);
        let percent = |ratio: f64| 100.0 * (ratio - 1.0);
        println!(
            "| {scene}, {method}, {resolution} | {:.0} thousand | {:.3} | {:.3} | {:+.2} % | {:+.2} % |",
            1e-3 * parts,
            1e3 * best(0),
            1e3 * best(1),
            percent(best(1) / best(0)),
            percent(ratios[SAMPLES / 2]),
        );
    }
    Ok(())
}

/// Seconds a step of a run, and parts that were recorded a second.
fn run(
    scene: &str,
    method: &str,
    resolution: &str,
    steps: u64,
    traced: bool,
) -> Result<(f64, f64), Error> {
    let scene = Scene::find(scene)?;
    let parameters = scene.set_for(Some(method), [("resolution", resolution)])?;
    let folder = tempfile::tempdir()?;
    let trace = traced.then(|| folder.path().join("trace.json"));
    let orders = Orders { steps: Some(steps), trace, ..Orders::default() };
    let report = scene.prepare(Some(method), &parameters, Precision::F64)?.run(orders)?;
    let parts = report.trace.map_or(0.0, |summary| {
        let parts: usize = summary.workers.iter().map(|worker| worker.parts).sum();
        parts as f64 / summary.seconds
    });
    Ok((report.wall_s / steps as f64, parts))
}
