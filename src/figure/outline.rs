//! Outlines of bodies.

use std::f64::consts::TAU;

/// The outline of a body, in the coordinates of the field.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// A circle.
    Circle {
        /// Its centre.
        centre: [f64; 2],
        /// Its radius.
        radius: f64,
    },
    /// A rectangle along the axes.
    Rectangle {
        /// The corner with the smaller coordinates.
        low: [f64; 2],
        /// The corner with the larger coordinates.
        high: [f64; 2],
    },
    /// A closed line through any points.
    Polygon(Vec<[f64; 2]>),
}

impl Outline {
    /// Its pieces of line within a window.
    pub(super) fn within(&self, window: [[f64; 2]; 2]) -> impl Iterator<Item = [[f64; 2]; 2]> {
        let corners = self.corners();
        (0..corners.len())
            .filter_map(move |k| clipped([corners[k], corners[(k + 1) % corners.len()]], window))
    }

    fn corners(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Circle { centre: [x, y], radius } => (0..180)
                .map(|k| {
                    let (sin, cos) = (TAU * f64::from(k) / 180.0).sin_cos();
                    [x + radius * cos, y + radius * sin]
                })
                .collect(),
            Self::Rectangle { low, high } => {
                vec![*low, [high[0], low[1]], *high, [low[0], high[1]]]
            }
            Self::Polygon(corners) => corners.clone(),
        }
    }
}

/// The part of a line that lies in a window (Liang & Barsky 1984).
fn clipped([from, to]: [[f64; 2]; 2], [low, high]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for a in 0..2 {
        let length = to[a] - from[a];
        let [enter, leave] = [(low[a] - from[a]) / length, (high[a] - from[a]) / length];
        if length == 0.0 {
            if !(low[a]..=high[a]).contains(&from[a]) {
                return None;
            }
        } else if length.is_finite() {
            first = first.max(enter.min(leave));
            last = last.min(enter.max(leave));
        } else {
            return None;
        }
    }
    let along = |s: f64| [0, 1].map(|a| from[a] + s * (to[a] - from[a]));
    (first < last).then(|| [along(first), along(last)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_window() {
        let window = [[0.0, 0.0], [1.0, 1.0]];
        assert_eq!(clipped([[-1.0, 0.5], [3.0, 0.5]], window), Some([[0.0, 0.5], [1.0, 0.5]]));
        assert_eq!(clipped([[0.5, 0.5], [0.5, 9.0]], window), Some([[0.5, 0.5], [0.5, 1.0]]));
        assert_eq!(clipped([[-1.0, 0.0], [0.0, 2.0]], window), None);
        assert_eq!(clipped([[0.2, 2.0], [0.8, 2.0]], window), None);
        assert_eq!(clipped([[f64::NAN, 0.0], [1.0, 1.0]], window), None);
    }
}
