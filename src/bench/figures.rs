//! The paper's Figs. 10, 11 and 12 from measured rows.

use std::path::{Path, PathBuf};

use super::row::Row;
use crate::figure::{Axis, Chart, FigureError, Scale};

/// Draws time per step, speed-up and efficiency against the number of workers into `out`; returns
/// the pictures' paths. What needs a measurement with one worker is left out without one.
///
/// # Errors
/// If a picture cannot be written.
pub fn draw(out: &Path, rows: &[Row]) -> Result<Vec<PathBuf>, FigureError> {
    let workers = || Axis::new("number of workers").scale(Scale::Log2);
    let most = rows.iter().map(|r| r.workers).max().unwrap_or(1);
    let numbers = || (1..=most).map(|n| n as f64);
    let mut pictures = Vec::new();

    let path = out.join("fig10-time-per-step.png");
    let chart = Chart::new("Time per step (Fig. 10; medians, bars from best to worst turn)")
        .x(workers())
        .y(Axis::new("time per step, log scale").unit("s").scale(Scale::Log10));
    let own = |row: &Row| row.turns.iter().map(|turn| turn.seconds).collect();
    series(chart, rows, |row| Some(row.seconds()), own).save(&path)?;
    pictures.push(path);

    if rows.iter().any(|row| row.speed_up().is_some()) {
        let path = out.join("fig11-speed-up.png");
        let chart = Chart::new("Speed-up over one worker (Fig. 11)")
            .x(workers())
            .y(Axis::new("speed-up"))
            .reference("ideal", numbers().map(|n| [n, n]));
        series(chart, rows, |row| ratio(row, 1.0), Row::speed_ups).save(&path)?;
        pictures.push(path);

        let path = out.join("fig12-efficiency.png");
        let chart = Chart::new("Parallel efficiency (Fig. 12)")
            .x(workers())
            .y(Axis::new("efficiency").covering(0.0, 1.05))
            .reference("ideal", numbers().map(|n| [n, 1.0]));
        let efficiencies = |row: &Row| {
            row.speed_ups().into_iter().map(|ratio| ratio / row.workers as f64).collect()
        };
        series(chart, rows, |row| ratio(row, row.workers as f64), efficiencies).save(&path)?;
        pictures.push(path);
    }
    Ok(pictures)
}

/// Speed-up over `by`; that of one worker is 1 by definition.
fn ratio(row: &Row, by: f64) -> Option<f64> {
    let speed_up = if row.workers == 1 { Some(1.0) } else { row.speed_up() };
    Some(speed_up? / by)
}

/// Adds a line a model size, with bars over all its turns.
fn series(
    mut chart: Chart,
    rows: &[Row],
    value: impl Fn(&Row) -> Option<f64>,
    samples: impl Fn(&Row) -> Vec<f64>,
) -> Chart {
    for group in rows.chunk_by(|a, b| a.width == b.width) {
        let name = format!("{} particles", group[0].particles);
        let points = group.iter().filter_map(|row| Some([row.workers as f64, value(row)?]));
        let spreads = group.iter().filter_map(|row| {
            let samples = samples(row);
            let low = samples.iter().copied().reduce(f64::min)?;
            let high = samples.iter().copied().reduce(f64::max)?;
            Some([row.workers as f64, low, high])
        });
        chart = chart.series(name, points.collect::<Vec<_>>()).spread(spreads.collect::<Vec<_>>());
    }
    chart
}
