//! A picture being drawn: primitives in pixels, x to the right and y down.

use std::io::Write;
use std::path::Path;
use std::sync::Once;

use finegrain_framework::format::AtomicFile;
use plotters::prelude::{BitMapBackend, DrawingBackend, RGBColor, TextStyle};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontDesc, FontFamily, FontStyle, FontTransform, register_font};

use super::error::FigureError;

/// Red, green and blue.
pub(super) type Colour = [u8; 3];

pub(super) const WHITE: Colour = [255; 3];
pub(super) const BLACK: Colour = [0; 3];

/// Drawn pixels to a pixel of the file, each way: their mean is what makes edges smooth.
const FINE: usize = 3;

const FONT: &str = "DejaVu Sans";

/// Where a text lies from the point it is drawn at; always centred on it in height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    /// It begins there.
    Left,
    /// Its middle is there.
    Centre,
    /// It ends there.
    Right,
}

/// A picture being drawn.
pub(super) struct Canvas {
    size: [usize; 2],
    /// Rows of fine pixels, three bytes each.
    fine: Vec<u8>,
    failure: Option<String>,
}

impl Canvas {
    /// A white picture of `width` x `height` pixels, to be saved as `path`.
    ///
    /// # Errors
    /// If it cannot be read or held.
    pub fn new([width, height]: [u32; 2], path: &Path) -> Result<Self, FigureError> {
        if ![width, height].iter().all(|side| (300..=10_000).contains(side)) {
            return Err(FigureError::Size { path: path.to_owned(), width, height });
        }
        load_fonts();
        let size = [width as usize, height as usize];
        let fine = vec![255; size[0] * size[1] * FINE * FINE * 3];
        Ok(Self { size, fine, failure: None })
    }

    /// Pixels across and down.
    pub fn size(&self) -> [f64; 2] {
        self.size.map(|side| side as f64)
    }

    /// A filled disc.
    pub fn disc(&mut self, centre: [f64; 2], radius: f64, colour: Colour) {
        // The fine pixel of the centre is added to twice the radius.
        let largest = (self.size[0] + self.size[1]) as f64;
        let radius = (radius.min(largest) * FINE as f64 - 0.5).round().max(1.0) as u32;
        self.draw(|fine| fine.draw_circle(at(centre), radius, &rgb(colour), true));
    }

    /// A filled rectangle, never thinner than a fine pixel.
    pub fn rectangle(&mut self, low: [f64; 2], high: [f64; 2], colour: Colour) {
        let (low, high) = (at(low), at(high));
        let high = (high.0.max(low.0 + 1), high.1.max(low.1 + 1));
        self.draw(|fine| fine.draw_rect(low, high, &rgb(colour), true));
    }

    /// A filled convex polygon.
    pub fn polygon(&mut self, corners: &[[f64; 2]], colour: Colour) {
        self.draw(|fine| fine.fill_polygon(corners.iter().map(|&c| at(c)), &rgb(colour)));
    }

    /// A line through `points`, with round corners.
    pub fn line(&mut self, points: &[[f64; 2]], width: f64, colour: Colour) {
        for pair in points.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
            let length = dx.hypot(dy);
            if length > 0.0 {
                let across = [-dy * width / (2.0 * length), dx * width / (2.0 * length)];
                let corner = |p: [f64; 2], sign: f64| [0, 1].map(|a| p[a] + sign * across[a]);
                let corners =
                    [corner(from, 1.0), corner(to, 1.0), corner(to, -1.0), corner(from, -1.0)];
                self.polygon(&corners, colour);
            }
        }
        if width > 1.0 && points.len() > 2 {
            for &point in &points[1..points.len() - 1] {
                self.disc(point, width / 2.0, colour);
            }
        }
    }

    /// A dashed line through `points`.
    pub fn dashed(&mut self, points: &[[f64; 2]], width: f64, colour: Colour) {
        const DASH: f64 = 8.0;
        const PERIOD: f64 = 13.0;
        // The pattern runs on around corners.
        let mut done = 0.0;
        for pair in points.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            let along = |s: f64| [0, 1].map(|a| from[a] + (to[a] - from[a]) * s / length);
            let mut start = -(done % PERIOD);
            while start < length {
                let (a, b) = (start.max(0.0), (start + DASH).min(length));
                if a < b {
                    self.line(&[along(a), along(b)], width, colour);
                }
                start += PERIOD;
            }
            done += length;
        }
    }

    /// Text of a height of `size` pixels.
    pub fn text(&mut self, text: &str, at: [f64; 2], size: f64, align: Align) {
        self.write(text, at, &style(size, FontStyle::Normal), align, FontTransform::None);
    }

    /// Bold text.
    pub fn bold(&mut self, text: &str, at: [f64; 2], size: f64, align: Align) {
        self.write(text, at, &style(size, FontStyle::Bold), align, FontTransform::None);
    }

    /// Text that reads upwards.
    pub fn upward(&mut self, text: &str, at: [f64; 2], size: f64, align: Align) {
        self.write(text, at, &style(size, FontStyle::Normal), align, FontTransform::Rotate270);
    }

    /// Colours every pixel of a rectangle by its place, if there is a colour for it.
    pub fn paint(
        &mut self,
        low: [f64; 2],
        high: [f64; 2],
        colour: impl Fn([f64; 2]) -> Option<Colour>,
    ) {
        let edge = |x: f64, side: usize| ((x * FINE as f64).round() as usize).min(side * FINE);
        let row = self.size[0] * FINE;
        for y in edge(low[1], self.size[1])..edge(high[1], self.size[1]) {
            for x in edge(low[0], self.size[0])..edge(high[0], self.size[0]) {
                if let Some(colour) = colour([x, y].map(|c| (c as f64 + 0.5) / FINE as f64)) {
                    let first = (y * row + x) * 3;
                    self.fine[first..first + 3].copy_from_slice(&colour);
                }
            }
        }
    }

    /// Writes the file.
    ///
    /// # Errors
    /// If anything could not be drawn, encoded or written.
    pub fn save(self, path: &Path) -> Result<(), FigureError> {
        if let Some(cause) = self.failure {
            return Err(FigureError::Draw { path: path.to_owned(), cause });
        }
        let bytes = encode(self.size, &coarse(self.size, &self.fine))
            .map_err(|source| FigureError::Encode { path: path.to_owned(), source })?;
        let write = || -> std::io::Result<()> {
            let mut file = AtomicFile::create(path)?;
            file.write_all(&bytes)?;
            file.commit()
        };
        write().map_err(|source| FigureError::File { path: path.to_owned(), source })
    }

    fn write(
        &mut self,
        text: &str,
        point: [f64; 2],
        style: &TextStyle<'_>,
        align: Align,
        transform: FontTransform,
    ) {
        let across = match align {
            Align::Left => HPos::Left,
            Align::Centre => HPos::Center,
            Align::Right => HPos::Right,
        };
        // The base line is drawn half a height below the point; capitals, 0.63 of the height, are
        // to be centred on it.
        let up = 0.185 * style.font.get_size() / FINE as f64;
        let [x, y] = point;
        let turned = matches!(transform, FontTransform::Rotate270);
        let point = if turned { [x - up, y] } else { [x, y - up] };
        let style = style.pos(Pos::new(across, VPos::Top)).transform(transform);
        self.draw(|fine| fine.draw_text(text, &style, at(point)));
    }

    /// Draws with `plotters`; the first failure is reported when the file is saved.
    fn draw<E: std::fmt::Display>(
        &mut self,
        draw: impl FnOnce(&mut BitMapBackend<'_>) -> Result<(), E>,
    ) {
        let size = self.size.map(|side| (side * FINE) as u32);
        let mut fine = BitMapBackend::with_buffer(&mut self.fine, (size[0], size[1]));
        if let Err(failure) = draw(&mut fine) {
            self.failure.get_or_insert_with(|| failure.to_string());
        }
    }
}

/// Width of a text of a height of `size` pixels.
pub(super) fn text_width(text: &str, size: f64) -> f64 {
    load_fonts();
    // Without a font nothing can be written, which drawing reports.
    let width = style(size, FontStyle::Normal).font.box_size(text).map_or(0, |(width, _)| width);
    f64::from(width) / FINE as f64
}

/// The size, at most `size`, at which a text is not wider than `width`.
pub(super) fn fitting(text: &str, size: f64, width: f64) -> f64 {
    // Bold letters are about a seventh wider.
    size.min(size * width / (1.15 * text_width(text, size)).max(1.0))
}

fn style(size: f64, weight: FontStyle) -> TextStyle<'static> {
    FontDesc::new(FontFamily::Name(FONT), size * FINE as f64, weight).into()
}

fn load_fonts() {
    static LOAD: Once = Once::new();
    // A font that is refused is missing later, which drawing reports.
    LOAD.call_once(|| {
        let _ = register_font(FONT, FontStyle::Normal, dejavu::sans::regular());
        let _ = register_font(FONT, FontStyle::Bold, dejavu::sans::bold());
    });
}

/// The fine pixel at a place.
fn at(place: [f64; 2]) -> (i32, i32) {
    let [x, y] = place.map(|c| (c * FINE as f64).round() as i32);
    (x, y)
}

fn rgb([red, green, blue]: Colour) -> RGBColor {
    RGBColor(red, green, blue)
}

/// The means of blocks of fine pixels.
fn coarse([width, height]: [usize; 2], fine: &[u8]) -> Vec<u8> {
    let row = width * FINE * 3;
    let mut coarse = Vec::with_capacity(width * height * 3);
    for y in 0..height {
        for x in 0..width {
            for channel in 0..3 {
                let block = (0..FINE * FINE).map(|k| {
                    let (i, j) = (x * FINE + k % FINE, y * FINE + k / FINE);
                    u32::from(fine[j * row + i * 3 + channel])
                });
                let (sum, count) = (block.sum::<u32>(), (FINE * FINE) as u32);
                coarse.push(((sum + count / 2) / count) as u8);
            }
        }
    }
    coarse
}

fn encode([width, height]: [usize; 2], pixels: &[u8]) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}
