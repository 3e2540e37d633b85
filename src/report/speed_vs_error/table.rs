//! A survey as CSV.

use std::io::{self, Write};
use std::path::Path;

use finegrain_framework::format::AtomicFile;

use super::reading::orders;
use super::survey::{Measurement, Survey};

impl Survey {
    /// Writes every measurement, a row each: error without a unit, `order` from the next coarser one,
    /// times in seconds, of which the best run counts, memory in bytes.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> io::Result<()> {
        let mut text = String::from(
            "comparison,method,variant,precision,schedule,resolution,points,steps,runs,wall_s,\
             slowest_wall_s,seconds_per_step,peak_memory_bytes,error,order,state_hash,command\n",
        );
        let is_same_line = |a: &Measurement, b: &Measurement| {
            let line = |m: &Measurement| (m.case.comparison.name, m.case.line.title());
            line(a) == line(b)
        };
        for line in self.measurements.chunk_by(is_same_line) {
            let orders = orders(&line.iter().collect::<Vec<_>>());
            let orders = std::iter::once(String::new())
                .chain(orders.iter().map(|order| format!("{order:.2}")));
            for (m, order) in line.iter().zip(orders) {
                text += &row(m, &order);
            }
        }
        let mut file = AtomicFile::create(path)?;
        file.write_all(text.as_bytes())?;
        file.commit()
    }
}

fn row(m: &Measurement, order: &str) -> String {
    let (case, wall_s) = (&m.case, m.wall_s());
    let slowest = m.walls.iter().copied().fold(0.0, f64::max);
    let memory = m.memory.map_or_else(String::new, |bytes| bytes.to_string());
    format!(
        "\"{}\",{},{},{},{},{},{},{},{},{wall_s:.4},{slowest:.4},{:.4e},{memory},{:.4e},{order},{},finegrain {}\n",
        case.comparison.name,
        case.line.method,
        case.line.variant,
        case.line.precision.name(),
        case.line.schedule.name(),
        case.resolution,
        m.points,
        m.steps,
        m.walls.len(),
        wall_s / m.steps as f64,
        m.error,
        m.state_hash,
        case.arguments().join(" "),
    )
}
