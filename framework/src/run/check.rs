//! Checks of a run's plan, before anything is done.

use std::collections::HashSet;

use super::{Every, Run, RunFailure};
use crate::domain::Domain;

impl<D: Domain> Run<D> {
    /// Finds what cannot work.
    pub(super) fn check(&self) -> Result<(), RunFailure> {
        if !self.can_end() {
            return Err(RunFailure::Endless);
        }
        if let Some(time) = self.until.time
            && !(time >= 0.0 && time.is_finite())
        {
            return Err(value("end time", time, "finite and not negative"));
        }
        let mut monitors = HashSet::new();
        for (monitor, history) in self.monitors.iter().zip(&self.histories) {
            let name = history.name();
            check_name("monitor", name, &mut monitors)?;
            check_every(&format!("interval of monitor `{name}`"), monitor.timetable.every())?;
            let mut columns = HashSet::from(["time", "step"]);
            for column in history.columns() {
                if !columns.insert(column) || column.contains([',', '"', '\n', '\r']) {
                    return Err(RunFailure::Name {
                        output: "monitor column",
                        name: column.clone(),
                        why: "is taken, or has a comma, a quote or a line break",
                    });
                }
            }
        }
        let mut dumps = HashSet::new();
        for dump in &self.dumps {
            let name = &dump.dump.name;
            check_name("dump", name, &mut dumps)?;
            check_every(&format!("interval of dump `{name}`"), dump.timetable.every())?;
            self.require_folder(|| format!("dump `{name}`"))?;
        }
        for criterion in &self.criteria {
            check_every("interval of a stop criterion", criterion.timetable.every())?;
        }
        if let Some(checkpoints) = &self.checkpoints {
            check_every("interval of checkpoints", checkpoints.timetable.every())?;
            if checkpoints.keep == 0 {
                return Err(value("number of checkpoints to keep", 0, "at least 1"));
            }
            self.require_folder(|| "checkpoints".to_owned())?;
        }
        if self.takes_requests {
            self.require_folder(|| "a checkpoint on request".to_owned())?;
        }
        Ok(())
    }

    fn can_end(&self) -> bool {
        let until = &self.until;
        let limited = until.steps.is_some() || until.time.is_some() || until.wall_clock.is_some();
        limited || self.takes_stops || !self.criteria.is_empty()
    }

    fn require_folder(&self, output: impl FnOnce() -> String) -> Result<(), RunFailure> {
        match self.folder {
            Some(_) => Ok(()),
            None => Err(RunFailure::NoFolder { output: output() }),
        }
    }
}

/// A name that begins the name of a file.
fn check_name<'a>(
    output: &'static str,
    name: &'a str,
    taken: &mut HashSet<&'a str>,
) -> Result<(), RunFailure> {
    let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.' | ' ');
    let why = if name.is_empty() || name.starts_with('.') || !name.chars().all(is_plain) {
        "must be letters, digits, `-`, `_`, `.` or spaces, for it names files, and not begin with `.`"
    } else if !taken.insert(name) {
        "is there twice"
    } else {
        return Ok(());
    };
    Err(RunFailure::Name { output, name: name.to_owned(), why })
}

fn check_every(key: &str, every: Every) -> Result<(), RunFailure> {
    match every {
        Every::Steps(0) => Err(value(key, 0, "at least 1 step")),
        Every::Time(t) if !(t > 0.0 && t.is_finite()) => {
            Err(value(key, t, "a positive, finite time"))
        }
        _ => Ok(()),
    }
}

fn value(key: &str, value: impl ToString, must: &'static str) -> RunFailure {
    RunFailure::Value { key: key.to_owned(), value: value.to_string(), must }
}
