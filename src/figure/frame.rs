//! The frame that data are drawn in: axes, grid lines, ticks and titles.

use super::canvas::{Align, BLACK, Canvas, Colour, fitting, text_width};
use super::ruler::Ruler;

/// Height of numbers along an axis.
pub(super) const SMALL: f64 = 15.0;
/// Height of an axis' title.
pub(super) const MEDIUM: f64 = 17.0;
const LARGE: f64 = 21.0;

const GRID: Colour = [225; 3];
/// Length of a tick.
const TICK: f64 = 5.0;

/// A rectangle of the picture with an axis along each side.
pub(super) struct Frame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
    pub x: Ruler,
    pub y: Ruler,
}

impl Frame {
    /// Space needed to the left of a frame with `y` on that side.
    pub fn room_left(y: &Ruler) -> f64 {
        widest(y) + MEDIUM + 32.0
    }

    /// Space needed above a frame.
    pub const ROOM_ABOVE: f64 = 52.0;
    /// Space needed below a frame.
    pub const ROOM_BELOW: f64 = 66.0;

    /// The pixel of a point.
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            self.left + self.x.place(x) * (self.right - self.left),
            self.bottom - self.y.place(y) * (self.bottom - self.top),
        ]
    }

    /// Whether a pixel is within the frame or no further than `margin` pixels out of it.
    pub fn holds(&self, [x, y]: [f64; 2], margin: f64) -> bool {
        x > self.left - margin
            && x < self.right + margin
            && y > self.top - margin
            && y < self.bottom + margin
    }

    /// Lines across the frame at the ticks.
    pub fn draw_grid(&self, canvas: &mut Canvas) {
        for tick in &self.x.ticks {
            let x = self.place_x(tick.value);
            canvas.line(&[[x, self.top], [x, self.bottom]], 1.0, GRID);
        }
        for tick in &self.y.ticks {
            let y = self.place_y(tick.value);
            canvas.line(&[[self.left, y], [self.right, y]], 1.0, GRID);
        }
    }

    /// The frame itself with ticks, numbers and titles.
    pub fn draw(&self, canvas: &mut Canvas, title: &str) {
        let Self { left, top, right, bottom, .. } = *self;
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        canvas.line(&corners, 1.0, BLACK);
        for tick in &self.x.ticks {
            let x = self.place_x(tick.value);
            canvas.line(&[[x, bottom], [x, bottom + TICK]], 1.0, BLACK);
            canvas.text(&tick.label, [x, bottom + TICK + 12.0], SMALL, Align::Centre);
        }
        for &value in &self.x.minor {
            let x = self.place_x(value);
            canvas.line(&[[x, bottom], [x, bottom + 0.6 * TICK]], 1.0, BLACK);
        }
        for tick in &self.y.ticks {
            let y = self.place_y(tick.value);
            canvas.line(&[[left - TICK, y], [left, y]], 1.0, BLACK);
            canvas.text(&tick.label, [left - TICK - 5.0, y], SMALL, Align::Right);
        }
        for &value in &self.y.minor {
            let y = self.place_y(value);
            canvas.line(&[[left - 0.6 * TICK, y], [left, y]], 1.0, BLACK);
        }
        let [middle, centre] = [(left + right) / 2.0, (top + bottom) / 2.0];
        let [width, height] = canvas.size();
        let size = fitting(&self.x.title, MEDIUM, width - 20.0);
        canvas.text(&self.x.title, [middle, bottom + 46.0], size, Align::Centre);
        let size = fitting(&self.y.title, MEDIUM, height - 20.0);
        let x = left - widest(&self.y) - TICK - 20.0;
        canvas.upward(&self.y.title, [x, centre], size, Align::Centre);
        draw_title(canvas, title, middle, top);
    }

    fn place_x(&self, value: f64) -> f64 {
        self.left + self.x.place(value) * (self.right - self.left)
    }

    fn place_y(&self, value: f64) -> f64 {
        self.bottom - self.y.place(value) * (self.bottom - self.top)
    }
}

/// The title above a frame, over its middle if there is space.
fn draw_title(canvas: &mut Canvas, title: &str, middle: f64, top: f64) {
    let width = canvas.size()[0];
    let size = fitting(title, LARGE, width - 30.0);
    let half = 0.5 * 1.15 * text_width(title, size) + 10.0;
    let middle = middle.clamp(half.min(width / 2.0), (width - half).max(width / 2.0));
    canvas.bold(title, [middle, top - 26.0], size, Align::Centre);
}

/// Width of the widest number along an axis.
pub(super) fn widest(ruler: &Ruler) -> f64 {
    ruler.ticks.iter().map(|t| text_width(&t.label, SMALL)).fold(0.0, f64::max)
}
