//! Rows of coloured tiles with a few words in each.

use std::path::Path;

use super::canvas::{Align, BLACK, Canvas, Colour, fitting, text_width};
use super::error::FigureError;
use super::frame::{MEDIUM, SMALL};

/// How a tile is coloured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// As it should be.
    Good,
    /// Not quite.
    Doubtful,
    /// Not at all.
    Bad,
    /// Not known.
    Unknown,
}

impl Tone {
    /// Light enough for black text, and told apart by people who see no red or green.
    fn colour(self) -> Colour {
        match self {
            Self::Good => [166, 217, 206],
            Self::Doubtful => [253, 224, 150],
            Self::Bad => [236, 148, 126],
            Self::Unknown => [225, 225, 225],
        }
    }
}

/// One tile.
#[derive(Clone, Debug)]
pub struct Tile {
    /// What it is about.
    pub label: String,
    /// What is said about it.
    pub note: String,
    /// Its colour.
    pub tone: Tone,
}

/// A picture of rows of tiles.
#[derive(Clone, Debug)]
#[must_use]
pub struct Tiles {
    title: String,
    rows: Vec<(String, Vec<Tile>)>,
    legend: Vec<(Tone, String)>,
}

const ROW: f64 = 62.0;
const ABOVE: f64 = 60.0;
const BELOW: f64 = 46.0;
const WIDTH: u32 = 1400;

impl Tiles {
    /// Without rows.
    pub fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), rows: Vec::new(), legend: Vec::new() }
    }

    /// Adds a row.
    pub fn row(mut self, name: impl Into<String>, tiles: impl IntoIterator<Item = Tile>) -> Self {
        self.rows.push((name.into(), tiles.into_iter().collect()));
        self
    }

    /// Says what a tone means.
    pub fn legend(mut self, tone: Tone, meaning: impl Into<String>) -> Self {
        self.legend.push((tone, meaning.into()));
        self
    }

    /// Draws the tiles and writes them as a PNG file.
    ///
    /// # Errors
    /// If there are none or the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), FigureError> {
        let most = self.rows.iter().map(|(_, tiles)| tiles.len()).max().unwrap_or(0);
        if most == 0 {
            return Err(FigureError::Empty { path: path.to_owned(), why: "in any row" });
        }
        let height = (ABOVE + BELOW + ROW * self.rows.len() as f64).ceil().max(300.0);
        let mut canvas = Canvas::new([WIDTH, height as u32], path)?;
        let [width, _] = canvas.size();
        canvas.bold(&self.title, [width / 2.0, 28.0], 20.0, Align::Centre);
        let widest = self.rows.iter().map(|(name, _)| text_width(name, SMALL)).fold(0.0, f64::max);
        let left = widest.min(0.3 * width) + 28.0;
        let side = (width - left - 12.0) / most as f64;
        for (k, (name, tiles)) in self.rows.iter().enumerate() {
            let top = ABOVE + k as f64 * ROW;
            let middle = top + 0.5 * ROW;
            canvas.text(
                name,
                [left - 12.0, middle],
                fitting(name, SMALL, left - 24.0),
                Align::Right,
            );
            for (n, tile) in tiles.iter().enumerate() {
                let low = left + n as f64 * side;
                let centre = low + 0.5 * side;
                canvas.rectangle(
                    [low + 2.0, top + 2.0],
                    [low + side - 2.0, top + ROW - 2.0],
                    tile.tone.colour(),
                );
                for (text, at) in [(&tile.label, middle - 11.0), (&tile.note, middle + 12.0)] {
                    let size = fitting(text, SMALL, side - 12.0);
                    canvas.text(text, [centre, at], size, Align::Centre);
                }
            }
        }
        let mut x = left;
        let y = ABOVE + ROW * self.rows.len() as f64 + 22.0;
        for (tone, meaning) in &self.legend {
            canvas.rectangle([x, y - 8.0], [x + 16.0, y + 8.0], tone.colour());
            canvas.line(
                &[
                    [x, y - 8.0],
                    [x + 16.0, y - 8.0],
                    [x + 16.0, y + 8.0],
                    [x, y + 8.0],
                    [x, y - 8.0],
                ],
                0.7,
                BLACK,
            );
            canvas.text(meaning, [x + 24.0, y], SMALL.min(MEDIUM), Align::Left);
            x += 24.0 + text_width(meaning, SMALL) + 30.0;
        }
        canvas.save(path)
    }
}
