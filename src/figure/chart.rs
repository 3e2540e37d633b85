//! Line charts.

use std::path::Path;

use super::axis::Axis;
use super::canvas::{Align, Canvas, Colour, fitting, text_width};
use super::error::FigureError;
use super::frame::{Frame, SMALL};
use super::marker;
use super::ruler::Ruler;

/// Colour of the reference line.
const GREY: Colour = [90; 3];
/// Widest name of a series that is written at full size.
const WIDEST_NAME: f64 = 260.0;
/// Length of the piece of line beside a name.
const SAMPLE: f64 = 34.0;

/// A line chart: several named series with markers, and a legend beside them.
#[derive(Clone, Debug)]
#[must_use]
pub struct Chart {
    title: String,
    x: Axis,
    y: Axis,
    size: [u32; 2],
    series: Vec<Line>,
    reference: Option<Line>,
}

#[derive(Clone, Debug)]
struct Line {
    name: String,
    points: Vec<[f64; 2]>,
    /// Place along x, and the ends along y of what the point there is the middle of.
    spreads: Vec<[f64; 3]>,
}

impl Line {
    fn new(name: impl Into<String>, points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let points = points.into_iter().collect();
        Self { name: name.into(), points, spreads: Vec::new() }
    }
}

impl Chart {
    /// A chart without series, 1000 x 650 pixels.
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            x: Axis::new("x"),
            y: Axis::new("y"),
            size: [1000, 650],
            series: Vec::new(),
            reference: None,
        }
    }

    /// What is measured to the right.
    pub fn x(mut self, axis: Axis) -> Self {
        self.x = axis;
        self
    }

    /// What is measured upwards.
    pub fn y(mut self, axis: Axis) -> Self {
        self.y = axis;
        self
    }

    /// Pixels across and down, 300 to 10,000 each.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.size = [width, height];
        self
    }

    /// Adds a series: points joined in the order given. Points that have no place on the axes
    /// (NaN, infinity, nothing positive on a logarithmic axis) interrupt its line.
    pub fn series(
        mut self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = [f64; 2]>,
    ) -> Self {
        self.series.push(Line::new(name, points));
        self
    }

    /// Shows, for the series added last, from where to where measurements scatter: at each x a bar
    /// from y = `low` to `high`, given as `[x, low, high]`.
    ///
    /// # Panics
    /// If there is no series yet.
    pub fn spread(mut self, spreads: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let line = self.series.last_mut().expect("a spread is that of a series");
        line.spreads = spreads.into_iter().collect();
        self
    }

    /// What the series are to be compared with: a dashed line without markers.
    pub fn reference(
        mut self,
        name: impl Into<String>,
        points: impl IntoIterator<Item = [f64; 2]>,
    ) -> Self {
        self.reference = Some(Line::new(name, points));
        self
    }

    /// Draws the chart and writes it as a PNG file.
    ///
    /// # Errors
    /// If there is no point to show, the size makes no sense or the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), FigureError> {
        let mut canvas = Canvas::new(self.size, path)?;
        let frame = self.frame(canvas.size()).ok_or(FigureError::Empty {
            path: path.to_owned(),
            why: "finite, and positive on a logarithmic axis",
        })?;
        frame.draw_grid(&mut canvas);
        frame.draw(&mut canvas, &self.title);
        let place = |run: &[[f64; 2]]| -> Vec<_> { run.iter().map(|&p| frame.place(p)).collect() };
        for (index, line) in self.series.iter().enumerate() {
            for run in self.runs(line) {
                canvas.line(&place(run), 2.0, marker::colour(index));
            }
        }
        // Above the lines: a series that is as good as the reference must not hide it.
        for run in self.reference.iter().flat_map(|line| self.runs(line)) {
            canvas.dashed(&place(run), 1.8, GREY);
        }
        for (index, line) in self.series.iter().enumerate() {
            for &[x, low, high] in &line.spreads {
                let [low, high] = [[x, low], [x, high]];
                if self.shows(&low) && self.shows(&high) {
                    draw_spread(&mut canvas, frame.place(low), frame.place(high), index);
                }
            }
        }
        for (index, line) in self.series.iter().enumerate() {
            // More would touch each other and hide the lines.
            const MARKERS: usize = 60;
            let every = line.points.len().div_ceil(MARKERS).max(1);
            for point in self.runs(line).flat_map(place).step_by(every) {
                marker::draw(&mut canvas, index, point);
            }
        }
        self.draw_legend(&mut canvas, &frame);
        canvas.save(path)
    }

    /// Where the data go; `None` if there are none.
    fn frame(&self, [width, height]: [f64; 2]) -> Option<Frame> {
        if !self.series.iter().any(|line| line.points.iter().any(|p| self.shows(p))) {
            return None;
        }
        let lines = || self.series.iter().chain(&self.reference);
        let ends = lines().flat_map(|line| &line.spreads).flat_map(|&[x, a, b]| [[x, a], [x, b]]);
        let points = lines().flat_map(|line| line.points.iter().copied()).chain(ends);
        let points: Vec<_> = points.filter(|point| self.shows(point)).collect();
        let (top, bottom) = (Frame::ROOM_ABOVE, height - Frame::ROOM_BELOW);
        let extent = self.y.padded(points.iter().map(|p| p[1]))?;
        let y = Ruler::new(&self.y, extent, ((bottom - top) / 50.0) as usize);
        let left = Frame::room_left(&y);
        let right = (width - self.room_for_legend()).max(left + 100.0);
        let extent = self.x.padded(points.iter().map(|p| p[0]))?;
        let x = Ruler::new(&self.x, extent, ((right - left) / 75.0) as usize);
        Some(Frame { left, top, right, bottom, x, y })
    }

    fn shows(&self, [x, y]: &[f64; 2]) -> bool {
        self.x.shows(*x) && self.y.shows(*y)
    }

    /// Stretches of a line's points that all have a place.
    fn runs<'a>(&'a self, line: &'a Line) -> impl Iterator<Item = &'a [[f64; 2]]> {
        line.points.split(|point| !self.shows(point)).filter(|run| !run.is_empty())
    }

    fn room_for_legend(&self) -> f64 {
        let names = self.series.iter().chain(&self.reference).map(|line| &line.name);
        let widest = names.map(|name| text_width(name, SMALL)).fold(0.0, f64::max);
        widest.min(WIDEST_NAME) + SAMPLE + 40.0
    }

    fn draw_legend(&self, canvas: &mut Canvas, frame: &Frame) {
        let lines = self.series.len() + usize::from(self.reference.is_some());
        let height = (frame.bottom - frame.top) / lines as f64;
        let height = height.min(26.0);
        let left = frame.right + 18.0;
        let row = |k: usize| frame.top + (k as f64 + 0.5) * height;
        let sample = |y: f64| [[left, y], [left + SAMPLE, y]];
        let name = |canvas: &mut Canvas, name: &str, y: f64| {
            let size = fitting(name, SMALL, 1.15 * WIDEST_NAME).min(0.9 * height);
            canvas.text(name, [left + SAMPLE + 10.0, y], size, Align::Left);
        };
        for (index, line) in self.series.iter().enumerate() {
            let y = row(index);
            canvas.line(&sample(y), 2.0, marker::colour(index));
            marker::draw(canvas, index, [left + SAMPLE / 2.0, y]);
            name(canvas, &line.name, y);
        }
        if let Some(line) = &self.reference {
            let y = row(self.series.len());
            canvas.dashed(&sample(y), 1.8, GREY);
            name(canvas, &line.name, y);
        }
    }
}

/// A bar from `low` to `high` with ends, in pixels.
fn draw_spread(canvas: &mut Canvas, low: [f64; 2], high: [f64; 2], index: usize) {
    let colour = marker::colour(index);
    canvas.line(&[low, high], 1.4, colour);
    for [x, y] in [low, high] {
        canvas.line(&[[x - 5.0, y], [x + 5.0, y]], 1.4, colour);
    }
}
