//! Figures are PNG files that decode again, show something, and refuse what cannot be shown.

mod png_file;

use std::path::Path;

use finegrain::figure::{Axis, Chart, Field, FigureError, Mark, Outline, Scale};
use png_file::{Colours, decoded};

fn saved(save: impl FnOnce(&Path) -> Result<(), FigureError>) -> (u32, u32, Colours) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("figure.png");
    save(&path).unwrap();
    decoded(&path)
}

fn refused(save: impl FnOnce(&Path) -> Result<(), FigureError>) -> FigureError {
    let folder = tempfile::tempdir().unwrap();
    let error = save(&folder.path().join("figure.png")).unwrap_err();
    assert!(error.to_string().contains("figure.png"), "{error} does not name the file");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "a file was left");
    error
}

/// Speed-up on 1, 2, 4 ... `most` processors.
fn scaling(most: u32) -> Chart {
    let counts = || (0..=most.ilog2()).map(|e| f64::from(1 << e));
    Chart::new("Speed-up")
        .x(Axis::new("processors").scale(Scale::Log2))
        .y(Axis::new("speed-up"))
        .series("27 000 particles", counts().map(|n| [n, n.powf(0.9)]))
        .series("1 000 000 particles", counts().map(|n| [n, n.powf(0.98)]))
        .reference("ideal", counts().map(|n| [n, n]))
}

#[test]
fn a_chart_of_any_number_of_processors_is_drawn() {
    for most in [1, 2, 128] {
        let (width, height, colours) = saved(|path| scaling(most).size(800, 600).save(path));
        assert_eq!((width, height), (800, 600));
        assert!(colours.len() > 20, "{} colours with {most} processors", colours.len());
        for series in [[0x00, 0x72, 0xb2], [0xd5, 0x5e, 0x00]] {
            assert!(colours.contains_key(&series), "a series is missing with {most} processors");
        }
    }
}

#[test]
fn a_chart_leaves_out_what_has_no_place() {
    let points = [[1.0, f64::NAN], [2.0, -1.0], [4.0, 0.5], [f64::INFINITY, 1.0], [8.0, 0.25]];
    let y = Axis::new("time per step").unit("s").scale(Scale::Log10);
    let (.., colours) = saved(|path| Chart::new("Time").y(y).series("a", points).save(path));
    assert!(colours.contains_key(&[0x00, 0x72, 0xb2]));
}

#[test]
fn an_empty_chart_is_refused() {
    for chart in [
        Chart::new("no series"),
        Chart::new("no points").series("a", []),
        Chart::new("only a reference").reference("ideal", [[1.0, 1.0]]),
        Chart::new("nothing finite").series("a", [[1.0, f64::NAN]]),
    ] {
        assert!(matches!(refused(|path| chart.save(path)), FigureError::Empty { .. }));
    }
}

#[test]
fn sizes_that_make_no_sense_are_refused() {
    for (width, height) in [(0, 600), (800, 20), (100_000, 600)] {
        let chart = scaling(2).size(width, height);
        assert!(matches!(refused(|path| chart.save(path)), FigureError::Size { .. }));
    }
}

#[test]
fn a_file_that_cannot_be_written_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("missing").join("figure.png");
    let error = scaling(2).save(&path).unwrap_err();
    assert!(matches!(error, FigureError::File { .. }));
    assert!(error.to_string().contains("figure.png"));
}

fn lattice(value: impl Fn(f64, f64) -> f64) -> Vec<([f64; 2], f64)> {
    let position = |k: usize| [(k % 40) as f64 * 0.1, (k / 40) as f64 * 0.1];
    (0..800).map(|k| (position(k), value(position(k)[0], position(k)[1]))).collect()
}

#[test]
fn a_field_of_points_shows_its_values_to_scale() {
    let wave = lattice(|x, y| x.sin() * y.cos());
    for mark in [Mark::Disc, Mark::Surface] {
        let field = Field::of_points(wave.clone(), 0.1)
            .title("Wave")
            .quantity(Axis::new("speed").unit("m/s"))
            .mark(mark)
            .outline(Outline::Circle { centre: [2.0, 1.0], radius: 0.3 });
        let (width, height, colours) = saved(|path| field.save(path));
        assert_eq!(width, 1000);
        assert!((400..700).contains(&height), "4 m x 2 m are {height} pixels high");
        assert!(colours.len() > 200);
        assert!(colours.contains_key(&[0, 0, 0]), "the outline is missing");
    }
}

#[test]
fn periodic_images_fill_the_ends_of_the_window() {
    // Points on the lower ends only: the upper ones lie a spacing away from the nearest.
    let unfilled = |periodic: bool| {
        let field = Field::of_points(lattice(|_, _| 1.0), 0.1)
            .window([0.0, 0.0], [4.0, 2.0])
            .periodic([periodic; 2]);
        let (.., colours) = saved(|path| field.save(path));
        colours[&[255; 3]]
    };
    let (open, closed) = (unfilled(false), unfilled(true));
    assert!(closed + 1000 < open, "{closed} white pixels with images, {open} without");
}

#[test]
fn a_field_on_a_grid_shows_its_values() {
    let values = (0..600).map(|k| k as f64);
    let field = Field::of_grid([30, 20], [0.0; 2], [0.1; 2], values).width(700);
    let (width, _, colours) = saved(|path| field.save(path));
    assert_eq!(width, 700);
    assert!(colours.len() > 200);
}

#[test]
fn a_constant_field_is_drawn_in_one_colour() {
    for value in [0.0, -3.0, 1000.0, 1e-300, f64::MAX] {
        let field = Field::of_points(lattice(|_, _| value), 0.1);
        let (.., colours) = saved(|path| field.save(path));
        assert!(colours.len() > 20, "constant {value}");
    }
}

#[test]
fn values_that_are_not_finite_are_grey() {
    let some = lattice(|x, _| if x < 1.0 { f64::NAN } else { x });
    let none = lattice(|_, _| f64::INFINITY);
    for (points, least, most) in [(some, 10_000, 200_000), (none, 200_000, 1_000_000)] {
        let field = Field::of_points(points, 0.1).mark(Mark::Surface);
        let (.., colours) = saved(|path| field.save(path));
        assert!((least..most).contains(&colours[&[170; 3]]), "{}", colours[&[170; 3]]);
    }
}

#[test]
fn what_lies_outside_the_window_is_cut_off() {
    let far = [[-1e12, 0.5], [1e12, 0.5], [f64::NAN, 0.0]];
    let field = Field::of_points([([0.0, 0.0], 1.0), ([1e15, 0.0], 2.0)], 1e9)
        .window([-1.0, -1.0], [1.0, 1.0])
        .outline(Outline::Polygon(far.to_vec()));
    let (.., colours) = saved(|path| field.save(path));
    assert!(colours.len() > 20);
}

#[test]
fn points_at_no_place_are_left_out() {
    let mut points = lattice(|x, _| x);
    points.push(([f64::NAN, 0.0], 1.0));
    let (.., colours) = saved(|path| Field::of_points(points, 0.1).save(path));
    assert!(colours.len() > 200);
}

#[test]
fn a_field_that_cannot_be_shown_is_refused() {
    let of = |points: Vec<([f64; 2], f64)>| Field::of_points(points, 0.1);
    let empty = |field: Field| matches!(refused(|p| field.save(p)), FigureError::Empty { .. });
    assert!(empty(of(vec![])));
    assert!(empty(of(vec![([f64::NAN; 2], 1.0)])));
    assert!(empty(Field::of_grid([0, 0], [0.0; 2], [1.0; 2], [])));
    let length = |field: Field| matches!(refused(|p| field.save(p)), FigureError::Length { .. });
    assert!(length(Field::of_points(lattice(|x, _| x), -1.0)));
    assert!(length(Field::of_grid([1, 1], [0.0; 2], [0.0, 1.0], [1.0])));
    assert!(length(of(lattice(|x, _| x)).window([0.0; 2], [0.0, f64::NAN])));
    let short = Field::of_grid([2, 2], [0.0; 2], [1.0; 2], [1.0]);
    assert!(matches!(refused(|p| short.save(p)), FigureError::Values { .. }));
}
