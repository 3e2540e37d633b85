//! Colours and markers that tell the series of a chart apart, by the colour-blind too.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::canvas::{Canvas, Colour};

/// Okabe & Ito (2008), without yellow, which is too light on white, and black.
const COLOURS: [Colour; 6] = [
    [0x00, 0x72, 0xb2],
    [0xd5, 0x5e, 0x00],
    [0x00, 0x9e, 0x73],
    [0xcc, 0x79, 0xa7],
    [0x56, 0xb4, 0xe9],
    [0xe6, 0x9f, 0x00],
];

/// Colour of series `index`.
pub(super) fn colour(index: usize) -> Colour {
    COLOURS[index % COLOURS.len()]
}

/// Draws the marker of series `index`. There are seven shapes to six colours, so that the
/// first 42 series differ.
pub(super) fn draw(canvas: &mut Canvas, index: usize, centre: [f64; 2]) {
    let colour = colour(index);
    match index % 7 {
        0 => canvas.disc(centre, 5.0, colour),
        1 => canvas.polygon(&regular(centre, 4, 6.2, FRAC_PI_2 / 2.0), colour),
        2 => canvas.polygon(&regular(centre, 3, 6.8, -FRAC_PI_2), colour),
        3 => canvas.polygon(&regular(centre, 4, 6.8, 0.0), colour),
        4 => canvas.polygon(&regular(centre, 3, 6.8, FRAC_PI_2), colour),
        5 => {
            for direction in [[4.2, 4.2], [4.2, -4.2]] {
                let end = |sign: f64| [0, 1].map(|a| centre[a] + sign * direction[a]);
                canvas.line(&[end(-1.0), end(1.0)], 2.5, colour);
            }
        }
        _ => {
            canvas.disc(centre, 5.5, colour);
            canvas.disc(centre, 3.0, [255; 3]);
        }
    }
}

/// Corners of a regular polygon, the first in direction `angle`.
fn regular([x, y]: [f64; 2], corners: usize, radius: f64, angle: f64) -> Vec<[f64; 2]> {
    (0..corners)
        .map(|k| {
            let (sin, cos) = (angle + TAU * k as f64 / corners as f64).sin_cos();
            [x + radius * cos, y + radius * sin]
        })
        .collect()
}
