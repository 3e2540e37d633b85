//! Traces as files that chrome://tracing and ui.perfetto.dev open.

use std::io::{self, Write};
use std::path::Path;

use finegrain_framework::format::AtomicFile;
use finegrain_framework::trace::{Event, Trace};
use serde::Serialize;

/// An event in the trace event format: `X` is one with a duration, `M` names a row.
#[derive(Serialize)]
struct Row<'a, A> {
    name: &'a str,
    ph: &'static str,
    /// When, microseconds.
    ts: f64,
    /// How long, microseconds.
    dur: f64,
    pid: u32,
    tid: usize,
    args: A,
}

#[derive(Serialize)]
struct Named {
    name: String,
}

#[derive(Serialize)]
struct Place {
    step: u64,
    /// Number of the part in the step: its name may occur several times.
    part: u32,
    sub_domain: u32,
}

/// Writes a trace in the trace event format (JSON): a row a worker, and one for the stretches in which
/// the workers were given parts and for whole-domain stages between them.
///
/// # Errors
/// If the file cannot be written.
pub fn write(trace: &Trace, path: &Path) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    write!(file, "{{\"traceEvents\": [")?;
    let legs = trace.workers();
    for row in 0..=legs {
        let name = if row == legs { "steps".to_owned() } else { format!("worker {row}") };
        let args = Named { name };
        if row > 0 {
            writeln!(file, ",")?;
        }
        let named = Row { name: "thread_name", ph: "M", ts: 0.0, dur: 0.0, pid: 1, tid: row, args };
        serde_json::to_writer(&mut file, &named)?;
    }
    let mut put = |name: &str, row: usize, event: &Event| -> io::Result<()> {
        writeln!(file, ",")?;
        let (ts, dur) = (1e-3 * event.begin as f64, 1e-3 * (event.end - event.begin) as f64);
        let Event { step, part, sub_domain, .. } = *event;
        let args = Place { step, part, sub_domain };
        serde_json::to_writer(&mut file, &Row { name, ph: "X", ts, dur, pid: 1, tid: row, args })?;
        Ok(())
    };
    for leg in trace.legs() {
        put("steps", legs, &leg)?;
    }
    for event in trace.whole() {
        put(&trace.parts()[event.part as usize], legs, &event)?;
    }
    for worker in 0..trace.workers() {
        for event in trace.events(worker) {
            put(&trace.parts()[event.part as usize], worker, &event)?;
        }
    }
    writeln!(file, "]}}")?;
    file.commit()
}
