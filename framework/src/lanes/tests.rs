use super::*;
use crate::real::Real;

/// Points on a spiral, so that every distance differs.
fn points<T: Real>(n: usize) -> [Vec<T>; 3] {
    let along = |f: fn(f64) -> f64| {
        (0..n).map(|i| T::of(f(i as f64 * 0.7) * (0.1 + i as f64 / n as f64))).collect()
    };
    [along(f64::sin), along(f64::cos), along(|t| (0.3 * t).sin())]
}

/// All points there are.
fn all<const D: usize>(points: [&[f32]; D]) -> Selection<D> {
    let mut selected = Selection::default();
    near_box(points, [f32::NEG_INFINITY; D], [f32::INFINITY; D], 1.0, &mut selected);
    selected
}

#[test]
fn within_agrees_with_the_definition() {
    let mut found = Found::default();
    for n in [0, 1, 7, 8, 9, 15, 16, 17, 100, 1031] {
        let [x, y, z] = points::<f32>(n);
        let centre = [0.1, -0.2, 0.05];
        within(&all([&x, &y, &z]), centre, 0.4, &mut found);
        let is_near = |&j: &usize| {
            let [dx, dy, dz] = [x[j] - centre[0], y[j] - centre[1], z[j] - centre[2]];
            dz.mul_add(dz, dy.mul_add(dy, dx * dx)) < 0.4
        };
        let expected: Vec<u32> = (0..n).filter(is_near).map(|j| j as u32).collect();
        assert_eq!(found.indices(), expected, "{n} points");
    }
}

fn gather_agrees_with_the_definition<T: Real>() {
    let mut found = Found::default();
    for n in [0, 1, 7, 8, 9, 15, 16, 17, 100, 1031] {
        let [x, y, _] = points::<f32>(n);
        within(&all([&x, &y]), [0.1, -0.2], 0.4, &mut found);
        let records: Vec<Record<T>> =
            y.iter().map(|&y| std::array::from_fn(|s| T::of(f64::from(y) + s as f64))).collect();
        let mut gathered: [Buffer<T>; RECORD] = Default::default();
        for lane in &mut gathered {
            lane.resize(found.padded() + 3);
            lane.fill(T::nan());
        }
        T::gather(&records, &found, 3, &mut gathered);
        let few = gathered.clone();
        T::gather(&records, &found, RECORD, &mut gathered);
        assert!(
            few[..3]
                .iter()
                .zip(&gathered)
                .all(|(few, all)| { few[..found.padded()] == all[..found.padded()] })
        );
        for (s, lane) in gathered.iter().enumerate() {
            for (k, &j) in found.indices().iter().enumerate() {
                assert_eq!(lane[k], records[j as usize][s]);
            }
            let padding = found.len()..found.padded();
            assert!(lane[padding].iter().all(|&g| g == lane[0]));
            assert!(lane[found.padded()..].iter().all(|g| g.is_nan()));
        }
    }
}

fn interleave_agrees_with_the_definition<T: Real>() {
    for n in [0, 1, 7, 16, 37, 64] {
        let value = |s: usize, k: usize| T::of((100 * k + s) as f64);
        let lanes: [Vec<T>; RECORD] =
            std::array::from_fn(|s| (0..n + s).map(|k| value(s, k)).collect());
        let mut records = vec![[T::nan(); RECORD]; n];
        T::interleave(std::array::from_fn(|s| &lanes[s][..]), &mut records);
        for (k, record) in records.iter().enumerate() {
            assert_eq!(*record, std::array::from_fn(|s| value(s, k)));
        }
    }
}

#[test]
fn interleave_in_f64_and_f32() {
    interleave_agrees_with_the_definition::<f64>();
    interleave_agrees_with_the_definition::<f32>();
}

#[test]
fn gather_in_f64_and_f32() {
    gather_agrees_with_the_definition::<f64>();
    gather_agrees_with_the_definition::<f32>();
}

fn dots_agree_with_the_definition<T: Real>() {
    for groups in [0, 1, 2, 11] {
        let [x, y, _] = points::<T>(groups * SUMS);
        let mut sums = [T::zero(); SUMS];
        for (i, (&x, &y)) in x.iter().zip(&y).enumerate() {
            sums[i % SUMS] = x.mul_add(y, sums[i % SUMS]);
        }
        let minus: Vec<T> = y.iter().map(|&y| -y).collect();
        let expected = add_by_halves(sums);
        assert_eq!(T::dots(&x, [&y, &minus]), [expected, -expected]);
        let by = T::of(0.3);
        let raised: Vec<T> = x.iter().map(|&x| by + x).collect();
        let expected = T::dots(&raised, [&y, &x]);
        assert_eq!(T::raised_dots(by, &x, [&y, &x]), expected);
        assert_eq!(T::raised_contraction([by], [&x], [&y]), expected[0]);
        let sum = T::raised_contraction([by, T::zero()], [&x, &y], [&y, &y]);
        let parts = expected[0] + T::dots(&y, [&y])[0];
        assert!((sum - parts).abs() <= T::of(20.0) * T::epsilon() * parts.abs());
        assert!(groups == 0 || sum != expected[0]);
    }
}

#[test]
fn dots_in_f64_and_f32() {
    dots_agree_with_the_definition::<f64>();
    dots_agree_with_the_definition::<f32>();
}

#[test]
fn a_point_that_is_nowhere_is_not_found() {
    let mut found = Found::default();
    let selected = all([&[0.0, f32::NAN, 0.5, 1.0]]);
    within(&selected, [0.0], 0.5, &mut found);
    assert_eq!(found.indices(), [0, 2]);
}

#[test]
fn near_box_is_within_of_the_nearest_point_of_the_box() {
    let [x, y, z] = points::<f32>(500);
    let (lower, upper) = ([-0.2, 0.1, 0.0], [0.3, 0.4, 0.05]);
    let mut selected = Selection::default();
    near_box([&x, &y, &z], lower, upper, 0.09, &mut selected);
    let expected: Vec<u32> = (0..500)
        .filter(|&j| {
            let at = [x[j], y[j], z[j]];
            let d2: f32 = (0..3).map(|a| (at[a] - at[a].clamp(lower[a], upper[a])).powi(2)).sum();
            d2 < 0.09
        })
        .map(|j| j as u32)
        .collect();
    assert!(!expected.is_empty() && expected.len() < 500);
    assert_eq!(selected.indices(), expected);
    // What is found among them is named as they are.
    let (centre, near) = ([0.2, 0.2, 0.0], 0.05);
    let mut found = Found::default();
    within(&selected, centre, near, &mut found);
    let is_near = |&&j: &&u32| {
        let at = [x[j as usize], y[j as usize], z[j as usize]];
        (0..3).map(|a| (at[a] - centre[a]).powi(2)).sum::<f32>() < near
    };
    let nearest: Vec<u32> = expected.iter().filter(is_near).copied().collect();
    assert!(!nearest.is_empty() && nearest.len() < expected.len());
    assert_eq!(found.indices(), nearest);
}

#[test]
#[should_panic(expected = "fewer records")]
fn records_of_fewer_points_are_refused() {
    let mut found = Found::default();
    within(&all([&[0.0; 20]]), [0.0], 1.0, &mut found);
    let mut room = Default::default();
    f64::gather(&[[1.0; RECORD]; 19], &found, RECORD, &mut room);
}

#[test]
#[should_panic(expected = "no room")]
fn room_for_fewer_points_is_refused() {
    let mut found = Found::default();
    within(&all([&[0.0; 20]]), [0.0], 1.0, &mut found);
    let mut room: [Buffer<f64>; RECORD] = Default::default();
    room.iter_mut().enumerate().for_each(|(s, lane)| lane.resize(32 - usize::from(s == 5)));
    f64::gather(&[[1.0; RECORD]; 20], &found, RECORD, &mut room);
}
