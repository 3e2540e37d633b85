//! Pictures of a field.

use std::path::Path;

use super::axis::Axis;
use super::canvas::{Align, BLACK, Canvas, Colour, WHITE, text_width};
use super::error::FigureError;
use super::frame::{Frame, MEDIUM, SMALL, widest};
use super::nearest::Nearest;
use super::outline::Outline;
use super::ruler::Ruler;
use super::viridis::viridis;

/// Colour of a value that has no place on the colour bar.
const GREY: Colour = [170; 3];
/// Width of the colour bar and its distance from the frame.
const BAR: [f64; 2] = [22.0, 24.0];
/// Shortest colour bar.
const SHORTEST_BAR: f64 = 200.0;

/// How a point is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// As a filled disc: shows where every particle is, and the gaps between them.
    Disc,
    /// As the part of space that is nearest to it, up to 0.8 diameters away: an even surface where
    /// points lie about a diameter apart, with holes where there are none.
    #[default]
    Surface,
}

/// A picture of a field: its value by colour, space to scale.
#[derive(Clone, Debug)]
#[must_use]
pub struct Field {
    title: String,
    quantity: Axis,
    axes: [Axis; 2],
    width: u32,
    content: Content,
    mark: Mark,
    window: Option<[[f64; 2]; 2]>,
    /// Directions in which the window is one period.
    periodic: [bool; 2],
    outlines: Vec<Outline>,
}

#[derive(Clone, Debug)]
enum Content {
    Points { points: Vec<([f64; 2], f64)>, diameter: f64 },
    Grid { shape: [usize; 2], origin: [f64; 2], spacing: [f64; 2], values: Vec<f64> },
}

impl Field {
    /// A field known at points, each drawn `diameter` wide.
    pub fn of_points(points: impl IntoIterator<Item = ([f64; 2], f64)>, diameter: f64) -> Self {
        Self::new(Content::Points { points: points.into_iter().collect(), diameter })
    }

    /// A field on a grid of `shape` points, x fastest; `origin` is the position of the first.
    pub fn of_grid(
        shape: [usize; 2],
        origin: [f64; 2],
        spacing: [f64; 2],
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        let values = values.into_iter().collect();
        Self::new(Content::Grid { shape, origin, spacing, values })
    }

    fn new(content: Content) -> Self {
        Self {
            title: String::new(),
            quantity: Axis::new("value"),
            axes: ["x", "y"].map(|name| Axis::new(name).unit("m")),
            width: 1000,
            content,
            mark: Mark::default(),
            window: None,
            periodic: [false; 2],
            outlines: Vec::new(),
        }
    }

    /// Title above the picture.
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// What the colours mean. A range that the axis covers is shown at least; a logarithmic axis
    /// makes a logarithmic colour bar. Values that have no place on it (NaN, say) are grey.
    pub fn quantity(mut self, quantity: Axis) -> Self {
        self.quantity = quantity;
        self
    }

    /// What the two directions are; `x` and `y` in metres by default. Always linear.
    pub fn axes(mut self, x: Axis, y: Axis) -> Self {
        self.axes = [x, y].map(|axis| axis.scale(super::Scale::Linear));
        self
    }

    /// Pixels across, 300 to 10,000; 1000 by default. The height follows from the window.
    pub fn width(mut self, width: u32) -> Self {
        self.width = width;
        self
    }

    /// How points are drawn; as a surface by default.
    pub fn mark(mut self, mark: Mark) -> Self {
        self.mark = mark;
        self
    }

    /// Shows space from `low` to `high`; by default, all points.
    pub fn window(mut self, low: [f64; 2], high: [f64; 2]) -> Self {
        self.window = Some([low, high]);
        self
    }

    /// Directions in which space goes on beyond the window as at its other end: points near an end are drawn at the
    /// other, too.
    pub fn periodic(mut self, directions: [bool; 2]) -> Self {
        self.periodic = directions;
        self
    }

    /// Adds the outline of a body.
    pub fn outline(mut self, outline: Outline) -> Self {
        self.outlines.push(outline);
        self
    }

    /// Draws the field and writes it as a PNG file.
    ///
    /// # Errors
    /// If there is no point to show, a length makes no sense, a grid has not as many values as
    /// points, or the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), FigureError> {
        self.check(path)?;
        let window = self.whole_window(path)?;
        let values = self.quantity.extent(self.values()).unwrap_or([0.0, 1.0]);
        let (frame, height) = self.frame(window, values);
        let mut canvas = Canvas::new([self.width, height as u32], path)?;
        let colours = Ruler::new(&self.quantity, values, 2);
        let colour = |value: f64| {
            if self.quantity.shows(value) { viridis(colours.place(value)) } else { GREY }
        };
        self.draw_content(&mut canvas, &frame, colour);
        for piece in self.outlines.iter().flat_map(|outline| outline.within(window)) {
            canvas.line(&piece.map(|p| frame.place(p)), 2.0, BLACK);
        }
        draw_margin(&mut canvas, &frame);
        frame.draw(&mut canvas, &self.title);
        self.draw_bar(&mut canvas, &frame, values);
        canvas.save(path)
    }

    fn check(&self, path: &Path) -> Result<(), FigureError> {
        let positive = |what, value: f64| {
            if value > 0.0 && value.is_finite() {
                Ok(())
            } else {
                Err(FigureError::Length { path: path.to_owned(), what, value })
            }
        };
        if let Some([low, high]) = self.window {
            positive("the width of the window", high[0] - low[0])?;
            positive("the height of the window", high[1] - low[1])?;
        }
        match &self.content {
            Content::Points { diameter, .. } => positive("the diameter of points", *diameter),
            Content::Grid { shape, spacing, values, .. } => {
                positive("the spacing in x", spacing[0])?;
                positive("the spacing in y", spacing[1])?;
                if values.len() == shape[0] * shape[1] {
                    Ok(())
                } else {
                    Err(FigureError::Values {
                        path: path.to_owned(),
                        shape: *shape,
                        values: values.len(),
                    })
                }
            }
        }
    }

    fn values(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        match &self.content {
            Content::Points { points, .. } => Box::new(points.iter().map(|&(_, value)| value)),
            Content::Grid { values, .. } => Box::new(values.iter().copied()),
        }
    }

    /// The part of space to show.
    fn whole_window(&self, path: &Path) -> Result<[[f64; 2]; 2], FigureError> {
        let whole = match &self.content {
            Content::Points { points, diameter } => points
                .iter()
                .map(|&(position, _)| position)
                .filter(|position| position.iter().all(|c| c.is_finite()))
                .map(|position| [position; 2])
                .reduce(|[low, high], [p, _]| {
                    [[0, 1].map(|a| low[a].min(p[a])), [0, 1].map(|a| high[a].max(p[a]))]
                })
                .map(|[low, high]| [low.map(|c| c - diameter), high.map(|c| c + diameter)]),
            Content::Grid { shape, origin, spacing, values } => (!values.is_empty()).then(|| {
                let corner = |k: [f64; 2]| [0, 1].map(|a| origin[a] + (k[a] - 0.5) * spacing[a]);
                [corner([0.0, 0.0]), corner(shape.map(|n| n as f64))]
            }),
        };
        let empty = FigureError::Empty { path: path.to_owned(), why: "at a finite position" };
        let whole = whole.ok_or(empty)?;
        Ok(self.window.unwrap_or(whole))
    }

    /// Where the field goes, to scale, and the height of the picture.
    fn frame(&self, [low, high]: [[f64; 2]; 2], values: [f64; 2]) -> (Frame, f64) {
        let along = |a: usize, length: f64| {
            Ruler::new(&self.axes[a], [low[a], high[a]], (length / [80.0, 50.0][a]) as usize)
        };
        let bar = Ruler::new(&self.quantity, values, 10);
        let most = f64::from(self.width);
        let room_right = BAR[0] + BAR[1] + widest(&bar) + MEDIUM + 40.0;
        // Numbers of an axis get no wider on a shorter axis.
        let room_left = Frame::room_left(&along(1, most));
        let available = [
            (most - room_left - room_right).max(100.0),
            (most - Frame::ROOM_ABOVE - Frame::ROOM_BELOW).max(100.0),
        ];
        let pixels = [0, 1].map(|a| available[a] / (high[a] - low[a]));
        let pixels = pixels[0].min(pixels[1]);
        let [width, height] = [0, 1].map(|a| pixels * (high[a] - low[a]));
        let below = (SHORTEST_BAR - height).max(0.0) / 2.0;
        let top = Frame::ROOM_ABOVE + below;
        let left = room_left + (available[0] - width) / 2.0;
        let frame = Frame {
            left,
            top,
            right: left + width,
            bottom: top + height,
            x: along(0, width),
            y: along(1, height),
        };
        let bottom = frame.bottom + Frame::ROOM_BELOW.max(below + 30.0);
        (frame, bottom.ceil().max(300.0))
    }

    /// From a point to itself and its periodic images around the window.
    fn shifts(&self) -> Vec<[f64; 2]> {
        let [low, high] = self.window.unwrap_or_default();
        let along = |a: usize| match self.periodic[a] {
            true => vec![0.0, low[a] - high[a], high[a] - low[a]],
            false => vec![0.0],
        };
        along(0).iter().flat_map(|&x| along(1).into_iter().map(move |y| [x, y])).collect()
    }

    fn draw_content(&self, canvas: &mut Canvas, frame: &Frame, colour: impl Fn(f64) -> Colour) {
        match &self.content {
            Content::Points { points, diameter } => {
                let [a, b] = [0.0, *diameter].map(|x| frame.place([x, 0.0])[0]);
                let pixels = b - a;
                let shifts = self.shifts();
                let points: Vec<_> = points
                    .iter()
                    .flat_map(|&([x, y], value)| {
                        shifts.iter().map(move |[dx, dy]| (frame.place([x + dx, y + dy]), value))
                    })
                    .filter(|(centre, _)| frame.holds(*centre, pixels))
                    .collect();
                match self.mark {
                    Mark::Disc => {
                        for &(centre, value) in &points {
                            canvas.disc(centre, pixels / 2.0, colour(value));
                        }
                    }
                    Mark::Surface => {
                        let nearest = Nearest::new(&points, 0.8 * pixels);
                        let Frame { left, top, right, bottom, .. } = *frame;
                        canvas.paint([left, top], [right, bottom], |pixel| {
                            nearest.value_at(pixel).map(&colour)
                        });
                    }
                }
            }
            Content::Grid { shape, origin, spacing, values } => {
                let Frame { left, top, right, bottom, .. } = *frame;
                canvas.paint([left, top], [right, bottom], |[x, y]| {
                    let place = [(x - left) / (right - left), (bottom - y) / (bottom - top)];
                    let position = [frame.x.value_at(place[0]), frame.y.value_at(place[1])];
                    let index = [0, 1].map(|a| ((position[a] - origin[a]) / spacing[a]).round());
                    let is_inside =
                        [0, 1].into_iter().all(|a| index[a] >= 0.0 && index[a] < shape[a] as f64);
                    let [i, j] = index.map(|i| i as usize);
                    is_inside.then(|| colour(values[j * shape[0] + i]))
                });
            }
        }
    }

    fn draw_bar(&self, canvas: &mut Canvas, frame: &Frame, values: [f64; 2]) {
        let middle = (frame.top + frame.bottom) / 2.0;
        let length = (frame.bottom - frame.top).max(SHORTEST_BAR);
        let (top, bottom) = (middle - length / 2.0, middle + length / 2.0);
        let ruler = Ruler::new(&self.quantity, values, (length / 50.0) as usize);
        let [left, right] = [frame.right + BAR[1], frame.right + BAR[1] + BAR[0]];
        canvas.paint([left, top], [right, bottom], |[_, y]| {
            Some(viridis((bottom - y) / (bottom - top)))
        });
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        canvas.line(&corners, 1.0, BLACK);
        for tick in &ruler.ticks {
            let y = bottom - ruler.place(tick.value) * (bottom - top);
            canvas.line(&[[right, y], [right + 5.0, y]], 1.0, BLACK);
            canvas.text(&tick.label, [right + 10.0, y], SMALL, Align::Left);
        }
        let x = right + widest(&ruler) + 28.0;
        canvas.upward(&ruler.title, [x, middle], MEDIUM, Align::Centre);
        if self.values().any(|value| !self.quantity.shows(value)) {
            let y = frame.bottom + 46.0;
            let note = "undefined";
            let end = canvas.size()[0] - 12.0;
            let start = end - text_width(note, SMALL);
            canvas.rectangle([start - 24.0, y - 8.0], [start - 8.0, y + 8.0], GREY);
            canvas.text(note, [end, y], SMALL, Align::Right);
        }
    }
}

/// Wipes what sticks out of the frame.
fn draw_margin(canvas: &mut Canvas, frame: &Frame) {
    let [width, height] = canvas.size();
    canvas.rectangle([0.0, 0.0], [width, frame.top], WHITE);
    canvas.rectangle([0.0, frame.bottom], [width, height], WHITE);
    canvas.rectangle([0.0, 0.0], [frame.left, height], WHITE);
    canvas.rectangle([frame.right, 0.0], [width, height], WHITE);
}
