//! A page of a report: one HTML file that needs no other, light or dark as its reader likes it.

use std::io::{self, Write};
use std::path::Path;

use finegrain_framework::format::AtomicFile;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::machine::Machine;

const STYLE: &str = include_str!("page.css");

/// A page of a report.
pub struct Page {
    /// What it is about.
    pub title: String,
    /// What a reader has to know first.
    pub lead: String,
    /// All the rest.
    pub body: Markup,
    /// The command that made it.
    pub command: String,
}

impl Page {
    /// Writes the page, with the machine that it was made on.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write(&self, path: &Path, machine: &Machine) -> io::Result<()> {
        let mut file = AtomicFile::create(path)?;
        file.write_all(self.render(machine).into_string().as_bytes())?;
        file.commit()
    }

    fn render(&self, machine: &Machine) -> Markup {
        html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta name="color-scheme" content="light dark";
                    title { (self.title) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    h1 { (self.title) }
                    p { (self.lead) }
                    (self.body)
                    h2 { "How this was made" }
                    p { "Machine: " (machine.line()) "." }
                    p { "Command: " code { (self.command) } }
                }
            }
        }
    }
}
