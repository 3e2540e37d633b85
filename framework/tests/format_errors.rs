//! What cannot be written is refused before the first byte, with an error that names it.

use std::error::Error;
use std::fs;
use std::io::{self, Write};

use finegrain_framework::format::{Array, AtomicFile, FormatError, Pvd, Values, Vti, Vtu};

fn particles(points: Array<'_>, point_data: &[Array<'_>], time: Option<f64>) -> String {
    let mut out = Vec::new();
    let error = Vtu { points, point_data, time }.write(&mut out).unwrap_err();
    assert!(out.is_empty());
    error.to_string()
}

#[test]
fn arrays_that_do_not_fit() {
    let (two, three, six) = ([0.0_f64; 2], [0.0_f64; 3], [0.0_f64; 6]);
    let points = Array::vector("position", &six[..]);
    let with = |array| particles(points, &[array], None);
    assert_eq!(
        with(Array::scalar("density", &three[..])),
        "array `density` has values for 3 points where 2 are expected"
    );
    assert_eq!(
        with(Array::split("force", [&two[..], &three[..], &two[..]])),
        "array `force` has values for 3 points where 2 are expected"
    );
    assert_eq!(
        with(Array::vector("force", &two[..])),
        "vector array `force` has 2 numbers, which is not a multiple of 3"
    );
    assert_eq!(
        particles(Array::vector("position", &two[..]), &[], None),
        "vector array `position` has 2 numbers, which is not a multiple of 3"
    );
    assert_eq!(
        particles(Array::scalar("position", &two[..]), &[], None),
        "array `position` holds 1 f64 per point; positions are 3 f32 or f64"
    );
    let density = Array::scalar("density", &two[..]);
    assert_eq!(particles(points, &[density, density], None), "two arrays are called `density`");
}

#[test]
fn components_of_different_kinds() {
    let (double, single) = ([0.0_f64; 2], [0.0_f32; 2]);
    let points = Array::plane("position", [(&double[..]).into(), Values::F32(&single)]);
    assert_eq!(
        particles(points, &[], None),
        "array `position` has components of kind f64 and of kind f32"
    );
}

#[test]
fn names_and_times_that_xml_cannot_hold() {
    let six = [0.0_f64; 6];
    let points = Array::vector("position", &six[..]);
    for name in ["", "bell\u{7}", "two\nlines"] {
        let error = particles(points, &[Array::vector(name, &six[..])], None);
        assert!(error.starts_with(&format!("{name:?} cannot be a name")), "{error}");
    }
    let error = particles(points, &[], Some(f64::NAN));
    assert_eq!(error, "`time` is NaN; it must be finite");
    let mut series = Pvd::new();
    assert!(series.push(f64::INFINITY, "a.vtu").is_err());
    assert!(series.push(0.0, "").is_err());
    assert!(series.is_empty());
}

#[test]
fn grids_that_make_no_sense() {
    let grid = |dimensions, spacing, origin| {
        let grid = Vti {
            dimensions,
            origin: [origin; 3],
            spacing: [1.0, spacing, 1.0],
            point_data: &[],
            time: None,
        };
        grid.write(&mut Vec::new()).unwrap_err().to_string()
    };
    assert_eq!(grid([2; 3], 0.0, 0.0), "`spacing` is 0; it must be positive");
    assert_eq!(grid([2; 3], f64::NAN, 0.0), "`spacing` is NaN; it must be positive");
    assert_eq!(grid([2; 3], f64::INFINITY, 0.0), "`spacing` is inf; it must be finite");
    assert_eq!(grid([2; 3], 1.0, f64::NAN), "`origin` is NaN; it must be finite");
    assert_eq!(grid([2, 0, 2], 1.0, 0.0), "`dimensions` is 0; it must be at least 1");
    assert!(grid([usize::MAX; 3], 1.0, 0.0).contains("memory can hold"));
}

#[test]
fn a_folder_that_is_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let error = Pvd::new().save(folder.path().join("no/series.pvd")).unwrap_err();
    assert!(matches!(&error, FormatError::File { path, .. } if path.ends_with("no/series.pvd")));
    assert!(error.source().is_some());
}

#[test]
fn a_stream_that_fails() {
    struct Full;
    impl Write for Full {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let error = Pvd::new().write(&mut Full).unwrap_err();
    assert!(matches!(error, FormatError::Stream { .. }));
}

#[test]
fn an_abandoned_file_leaves_the_old_one_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result");
    fs::write(&path, "old").unwrap();
    let mut file = AtomicFile::create(&path).unwrap();
    file.write_all(b"half of the ne").unwrap();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    drop(file);
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);

    let mut file = AtomicFile::create(&path).unwrap();
    file.write_all(b"new").unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    file.commit().unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// Renaming over a folder fails, after everything was written.
#[test]
fn a_commit_that_fails_cleans_up() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("taken");
    fs::create_dir(&path).unwrap();
    assert!(AtomicFile::create(&path).unwrap().commit().is_err());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(AtomicFile::create(&folder.path().join("..")).is_err());
}
