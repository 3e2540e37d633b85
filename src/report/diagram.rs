//! Diagrams of lines with markers, as SVG whose colours the page chooses.

use maud::{Markup, html};

use crate::figure::{Axis, Ruler};

/// A line of a diagram.
pub struct Series {
    /// Its name.
    pub name: String,
    /// Class of the page that colours it.
    pub class: &'static str,
    /// Which of the class, from 0: markers and dashes tell them apart.
    pub index: usize,
    /// Its points.
    pub points: Vec<Point>,
}

/// A point of a line.
pub struct Point {
    /// Along x and y.
    pub place: [f64; 2],
    /// What is written beside it, where there is room.
    pub label: String,
    /// What is said about it where it is pointed at.
    pub about: String,
}

/// A diagram.
pub struct Diagram {
    /// What it shows.
    pub title: String,
    /// What is measured to the right.
    pub x: Axis,
    /// What is measured upwards.
    pub y: Axis,
    /// Its lines.
    pub series: Vec<Series>,
}

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 400.0;
const LEFT: f64 = 74.0;
const RIGHT: f64 = WIDTH - 14.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = HEIGHT - 54.0;
/// Half the size of a marker.
const MARKER: f64 = 4.5;
/// Height and width of a letter of a label.
const LETTER: [f64; 2] = [6.6, 11.0];

/// Dashes of the lines of a class.
const DASHES: [&str; 6] = ["none", "7 4", "2 3", "9 3 2 3", "4 4", "12 5"];

impl Diagram {
    /// The diagram with its legend below it; `None` if there is nothing to show.
    pub fn render(&self) -> Option<Markup> {
        let frame = self.frame()?;
        let mut taken: Vec<Rectangle> = Vec::new();
        for point in self.points() {
            taken.push(Rectangle::around(frame.place(point.place), [MARKER; 2]));
        }
        Some(html! {
            figure {
                figcaption { (self.title) }
                svg viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) role="img" aria-label=(self.title) {
                    (frame.render())
                    @for series in &self.series {
                        g class=(series.class) { (series.line(&frame)) }
                    }
                    @for series in &self.series {
                        g class=(series.class) {
                            @for point in &series.points {
                                (marker(series.index, frame.place(point.place), Some(&point.about)))
                                @if let Some(at) = room(frame.place(point.place), &point.label, &mut taken) {
                                    text.label x=(pixel(at[0])) y=(pixel(at[1])) { (point.label) }
                                }
                            }
                        }
                    }
                }
                ul.legend {
                    @for series in self.series.iter().filter(|s| !s.points.is_empty()) {
                        li {
                            svg class=(format!("sample {}", series.class)) viewBox="0 0 34 14" {
                                line x1="1" y1="7" x2="33" y2="7" stroke-dasharray=(series.dash()) {}
                                (marker(series.index, [17.0, 7.0], None))
                            }
                            " " (series.name)
                        }
                    }
                }
            }
        })
    }

    fn points(&self) -> impl Iterator<Item = &Point> {
        self.series.iter().flat_map(|series| &series.points)
    }

    fn frame(&self) -> Option<Frame> {
        let ruler = |a: usize, axis: &Axis| {
            let extent = axis.padded(self.points().map(|point| point.place[a]))?;
            Some(Ruler::new(axis, extent, 8))
        };
        Some(Frame { x: ruler(0, &self.x)?, y: ruler(1, &self.y)? })
    }
}

/// The axes of a diagram.
struct Frame {
    x: Ruler,
    y: Ruler,
}

impl Frame {
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [LEFT + self.x.place(x) * (RIGHT - LEFT), BOTTOM - self.y.place(y) * (BOTTOM - TOP)]
    }

    fn render(&self) -> Markup {
        let along = |value: f64| pixel(LEFT + self.x.place(value) * (RIGHT - LEFT));
        let up = |value: f64| pixel(BOTTOM - self.y.place(value) * (BOTTOM - TOP));
        let middle = pixel(0.5 * (TOP + BOTTOM));
        html! {
            g.grid {
                @for tick in &self.x.ticks {
                    line x1=(along(tick.value)) x2=(along(tick.value)) y1=(TOP) y2=(BOTTOM) {}
                }
                @for tick in &self.y.ticks {
                    line x1=(LEFT) x2=(RIGHT) y1=(up(tick.value)) y2=(up(tick.value)) {}
                }
            }
            rect.frame x=(LEFT) y=(TOP) width=(RIGHT - LEFT) height=(BOTTOM - TOP) {}
            g.ticks {
                @for tick in &self.x.ticks {
                    text x=(along(tick.value)) y=(BOTTOM + 17.0) text-anchor="middle" { (tick.label) }
                }
                @for tick in &self.y.ticks {
                    text x=(LEFT - 7.0) y=(up(tick.value)) dy="0.35em" text-anchor="end" { (tick.label) }
                }
            }
            text x=(0.5 * (LEFT + RIGHT)) y=(HEIGHT - 12.0) text-anchor="middle" { (self.x.title) }
            text text-anchor="middle" transform=(format!("translate(15 {middle}) rotate(-90)")) { (self.y.title) }
        }
    }
}

impl Series {
    fn dash(&self) -> &'static str {
        DASHES[self.index % DASHES.len()]
    }

    fn line(&self, frame: &Frame) -> Markup {
        let places = self.points.iter().map(|point| frame.place(point.place));
        let places: Vec<_> = places.map(|[x, y]| format!("{},{}", pixel(x), pixel(y))).collect();
        html! { polyline points=(places.join(" ")) stroke-dasharray=(self.dash()) {} }
    }
}

/// Marker of line `index` of a class: filled, then open ones.
fn marker(index: usize, [x, y]: [f64; 2], about: Option<&str>) -> Markup {
    let corners = |corners: &[[f64; 2]]| {
        let places = corners.iter().map(|[dx, dy]| format!("{},{}", pixel(x + dx), pixel(y + dy)));
        places.collect::<Vec<_>>().join(" ")
    };
    let m = MARKER;
    let class = if index % 6 < 4 { "marker" } else { "open marker" };
    html! {
        @match index % 6 {
            1 | 5 => polygon class=(class) points=(corners(&[[-m, -m], [m, -m], [m, m], [-m, m]])) {
                @if let Some(about) = about { title { (about) } }
            },
            2 => polygon class=(class) points=(corners(&[[0.0, -1.3 * m], [1.2 * m, m], [-1.2 * m, m]])) {
                @if let Some(about) = about { title { (about) } }
            },
            3 => polygon class=(class) points=(corners(&[[0.0, -1.3 * m], [1.3 * m, 0.0], [0.0, 1.3 * m], [-1.3 * m, 0.0]])) {
                @if let Some(about) = about { title { (about) } }
            },
            _ => circle class=(class) cx=(pixel(x)) cy=(pixel(y)) r=(m) {
                @if let Some(about) = about { title { (about) } }
            },
        }
    }
}

/// A part of the picture.
#[derive(Clone, Copy)]
struct Rectangle {
    low: [f64; 2],
    high: [f64; 2],
}

impl Rectangle {
    fn around(centre: [f64; 2], half: [f64; 2]) -> Self {
        let corner = |sign: f64| [0, 1].map(|a| centre[a] + sign * half[a]);
        Self { low: corner(-1.0), high: corner(1.0) }
    }

    fn meets(&self, other: &Self) -> bool {
        (0..2).all(|a| self.low[a] < other.high[a] && other.low[a] < self.high[a])
    }

    fn is_inside(&self) -> bool {
        self.low[0] > LEFT && self.high[0] < RIGHT && self.low[1] > TOP && self.high[1] < BOTTOM
    }
}

/// Where a label of a point begins so that it hides nothing; `None` if there is no such place.
fn room(point: [f64; 2], label: &str, taken: &mut Vec<Rectangle>) -> Option<[f64; 2]> {
    let half = [0.5 * LETTER[0] * label.chars().count() as f64, 0.5 * LETTER[1]];
    let [out, off] = [MARKER + 2.0 + half[0], MARKER + 2.0 + half[1]];
    let moves = [[out, 0.0], [0.0, -off], [0.0, off], [-out, 0.0]].into_iter().chain([
        [out, -off],
        [out, off],
        [-out, -off],
        [-out, off],
    ]);
    let places = moves.map(|by| Rectangle::around([0, 1].map(|a| point[a] + by[a]), half));
    let mut free = places.filter(|p| p.is_inside() && !taken.iter().any(|other| p.meets(other)));
    let place = free.next()?;
    taken.push(place);
    // Text stands on its base line, a quarter of its height above its lower end.
    Some([place.low[0], place.high[1] - 0.2 * LETTER[1]])
}

/// A coordinate, short.
fn pixel(x: f64) -> String {
    format!("{x:.1}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Scale;

    fn point(place: [f64; 2]) -> Point {
        Point { place, label: "100".into(), about: "100 points".into() }
    }

    fn diagram(points: Vec<Point>) -> Diagram {
        let series = Series { name: "A & B".into(), class: "sph", index: 0, points };
        let axis = |name| Axis::new(name).scale(Scale::Log10);
        Diagram { title: "t".into(), x: axis("x"), y: axis("y"), series: vec![series] }
    }

    #[test]
    fn what_is_written_is_escaped() {
        let text =
            diagram(vec![point([0.1, 0.2]), point([1.0, 0.02])]).render().unwrap().into_string();
        assert!(text.contains("A &amp; B") && !text.contains("A & B"), "{text}");
        assert_eq!(text.matches("<title>100 points</title>").count(), 2);
    }

    #[test]
    fn there_is_none_of_nothing() {
        assert!(diagram(Vec::new()).render().is_none());
        assert!(diagram(vec![point([0.0, 1.0])]).render().is_none());
    }

    #[test]
    fn labels_hide_neither_points_nor_each_other() {
        let mut taken = vec![Rectangle::around([200.0, 200.0], [MARKER; 2])];
        let mut labels = Vec::new();
        while let Some(at) = room([200.0, 200.0], "100", &mut taken) {
            labels.push(at);
        }
        assert!(labels.len() >= 4, "{labels:?}");
        for (k, a) in taken.iter().enumerate() {
            assert!(taken[..k].iter().all(|b| !a.meets(b)));
        }
    }
}
