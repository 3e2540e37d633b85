use std::io::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::document::save;
use super::{FormatError, xml};

/// The index of a time series: which file shows which time.
///
/// It is rewritten whole, at once, whenever a file was added, so that it can be opened while the
/// run goes on. Kept in a checkpoint, it lets a restarted run go on with the same series.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Pvd {
    entries: Vec<Entry>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Entry {
    time: f64,
    file: String,
}

impl Pvd {
    /// An index of no files.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds `file`, a path relative to the folder of the index with `/` between folders, which
    /// shows `time`.
    ///
    /// # Errors
    /// If the time is not finite or the file's name cannot be written in XML; the index is as
    /// before.
    pub fn push(&mut self, time: f64, file: impl Into<String>) -> Result<(), FormatError> {
        let file = file.into();
        xml::number("time", time)?;
        xml::attribute(&file)?;
        self.entries.push(Entry { time, file });
        Ok(())
    }

    /// Keeps the entries whose file `keep` says so of: those that are there, say.
    pub fn retain(&mut self, mut keep: impl FnMut(&str) -> bool) {
        self.entries.retain(|entry| keep(&entry.file));
    }

    /// How many files there are.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Writes the index to `out`.
    ///
    /// # Errors
    /// If `out` fails.
    pub fn write(&self, out: &mut impl Write) -> Result<(), FormatError> {
        out.write_all(self.xml()?.as_bytes())?;
        Ok(out.flush()?)
    }

    /// Writes the index to the file `path`, replacing an older one at once.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), FormatError> {
        let xml = self.xml()?;
        save(path.as_ref(), |file| file.write_all(xml.as_bytes()))
    }

    fn xml(&self) -> Result<String, FormatError> {
        let mut text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" \
                        byte_order=\"LittleEndian\">\n<Collection>\n"
            .to_string();
        for Entry { time, file } in &self.entries {
            let (time, file) = (xml::number("time", *time)?, xml::attribute(file)?);
            text += &format!("<DataSet timestep=\"{time}\" part=\"0\" file=\"{file}\"/>\n");
        }
        text += "</Collection>\n</VTKFile>\n";
        Ok(text)
    }
}
