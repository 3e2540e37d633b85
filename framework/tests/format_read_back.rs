//! What is written for viewing reads back to the same numbers.
//!
//! The files stay in the build folder, under `tmp/format`, for `tests/read_back.py` to read them
//! with the readers that viewers use.

mod vtk_file;

use std::fs;
use std::path::PathBuf;

use finegrain_framework::format::{Array, Pvd, Vti, Vtu};

/// More than the writer's buffer holds at once, and not a multiple of it.
const POINTS: usize = 2500;

fn folder() -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("format");
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn column<T>(value: impl Fn(usize) -> T) -> Vec<T> {
    (0..POINTS).map(value).collect()
}

#[test]
fn particles() {
    let x = column(|i| i as f64 * 0.1);
    let y = column(|i| -(i as f64));
    let z = column(|i| 1.0 / (i as f64 + 1.0));
    let triples: Vec<f32> = (0..3 * POINTS).map(|i| i as f32).collect();
    let density = column(|i| 1000.0 + i as f32);
    let id = column(|i| i as u64 + (1 << 40));
    let cell = column(|i| i as u32 * 3);
    let flag = column(|i| (i % 2) as u8);
    let odd_name = "a<b & \"c\" > 'd' \u{3c1}";
    let path = folder().join("particles.vtu");
    Vtu {
        points: Array::split("position", [&x, &y, &z]),
        point_data: &[
            Array::scalar("density", &density),
            Array::vector("velocity", &triples),
            Array::plane("force", [&x, &y]),
            Array::scalar("id", &id),
            Array::scalar("cell", &cell),
            Array::scalar(odd_name, &flag),
        ],
        time: Some(0.1 + 0.2),
    }
    .save(&path)
    .unwrap();

    let (xml, arrays) = vtk_file::read(&fs::read(path).unwrap());
    assert!(xml.contains(">0.30000000000000004</DataArray>"));
    assert!(xml.contains("<Piece NumberOfPoints=\"2500\" NumberOfCells=\"2500\">"));
    let expect = |name: &str, kind: &str, numbers: Vec<f64>| {
        let array = &arrays[name];
        assert_eq!(array.kind, kind, "{name}");
        assert_eq!(array.components * POINTS, numbers.len(), "{name}");
        assert!(array.numbers() == numbers, "{name}");
    };
    let vectors = |z: &dyn Fn(usize) -> f64| (0..POINTS).flat_map(|i| [x[i], y[i], z(i)]).collect();
    expect("position", "Float64", vectors(&|i| z[i]));
    expect("force", "Float64", vectors(&|_| 0.0));
    expect("velocity", "Float32", triples.iter().map(|&v| v.into()).collect());
    expect("density", "Float32", density.iter().map(|&v| v.into()).collect());
    expect("id", "UInt64", id.iter().map(|&v| v as f64).collect());
    expect("cell", "UInt32", cell.iter().map(|&v| v.into()).collect());
    expect(odd_name, "UInt8", flag.iter().map(|&v| v.into()).collect());
    expect("connectivity", "Int64", column(|i| i as f64));
    expect("offsets", "Int64", column(|i| i as f64 + 1.0));
    expect("types", "UInt8", vec![1.0; POINTS]);
}

#[test]
fn grid() {
    let dimensions = [25, 20, 5];
    let pressure = column(|i| (i as f64).sqrt());
    let (u, v, w) = (column(|i| i as f32), column(|i| -(i as f32)), column(|_| 0.5_f32));
    let path = folder().join("grid.vti");
    Vti {
        dimensions,
        origin: [-1.0, 0.0, 1e-300],
        spacing: [0.1, 0.2, 1e20],
        point_data: &[Array::scalar("pressure", &pressure), Array::split("velocity", [&u, &v, &w])],
        time: None,
    }
    .save(&path)
    .unwrap();

    let (xml, arrays) = vtk_file::read(&fs::read(path).unwrap());
    let tag = xml.split('<').find(|tag| tag.starts_with("ImageData")).unwrap();
    assert_eq!(vtk_file::attribute(tag, "WholeExtent"), "0 24 0 19 0 4");
    assert_eq!(vtk_file::attribute(tag, "Origin"), "-1.0 0.0 1e-300");
    assert_eq!(vtk_file::attribute(tag, "Spacing"), "0.1 0.2 1e20");
    assert_eq!(arrays["pressure"].numbers(), pressure);
    let velocity: Vec<f64> = (0..POINTS).flat_map(|i| [u[i], v[i], w[i]].map(f64::from)).collect();
    assert_eq!(arrays["velocity"].numbers(), velocity);
}

#[test]
fn no_points_at_all() {
    let none: &[f64] = &[];
    let path = folder().join("empty.vtu");
    Vtu {
        points: Array::vector("position", none),
        point_data: &[Array::scalar("density", none)],
        time: None,
    }
    .save(&path)
    .unwrap();
    let (xml, arrays) = vtk_file::read(&fs::read(path).unwrap());
    assert!(xml.contains("NumberOfPoints=\"0\""));
    assert!(arrays["position"].numbers().is_empty());
}

#[test]
fn time_series() {
    let folder = folder();
    let index = folder.join("series.pvd");
    let mut series = Pvd::new();
    for step in 0..3 {
        let name = format!("series & {step}.vti");
        let values = [step as f64; 4];
        Vti {
            dimensions: [2, 2, 1],
            origin: [0.0; 3],
            spacing: [1.0; 3],
            point_data: &[Array::scalar("step", &values[..])],
            time: Some(step as f64 * 0.5),
        }
        .save(folder.join(&name))
        .unwrap();
        series.push(step as f64 * 0.5, name).unwrap();
        series.save(&index).unwrap();

        let xml = fs::read_to_string(&index).unwrap();
        let entries: Vec<_> = xml
            .split('<')
            .filter(|tag| tag.starts_with("DataSet "))
            .map(|tag| {
                let time: f64 = vtk_file::attribute(tag, "timestep").parse().unwrap();
                (time, vtk_file::attribute(tag, "file"))
            })
            .collect();
        let expected: Vec<_> =
            (0..=step).map(|n| (n as f64 * 0.5, format!("series & {n}.vti"))).collect();
        assert_eq!(entries, expected);
    }
}
