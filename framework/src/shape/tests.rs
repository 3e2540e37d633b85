use super::*;
use approx::assert_relative_eq;

const INFINITY: f64 = f64::INFINITY;

fn shapes() -> Vec<Shape> {
    let centre = [0.3, -0.2, 0.1];
    let mut shapes: Vec<Shape> = [Axis::X, Axis::Y, Axis::Z]
        .map(|axis| Shape::Cylinder { axis, centre, radius: 0.4 })
        .into();
    shapes.extend([Axis::X, Axis::Y, Axis::Z].map(|axis| Shape::Bore {
        axis,
        centre,
        radius: 0.7,
    }));
    shapes.push(Shape::Sphere { centre, radius: 0.5 });
    shapes.push(Shape::Cuboid { low: [-0.5, -0.4, -0.3], high: [0.2, 0.6, 0.4] });
    shapes.push(Shape::Cuboid { low: [-0.5, -0.4, -INFINITY], high: [0.2, INFINITY, INFINITY] });
    shapes.push(Shape::HalfSpace { point: centre, outward: [1.0, -2.0, 3.0] });
    shapes
}

/// Points that fill the cube from -1 to 1 evenly: multiples of the inverse powers of the
/// root of g^4 = g + 1, modulo 1.
fn points(count: u32) -> impl Iterator<Item = [f64; 3]> {
    const G: f64 = 1.220_744_084_605_759_6;
    (1..=count).map(|i| [1, 2, 3].map(|power| 2.0 * (f64::from(i) / G.powi(power)).fract() - 1.0))
}

#[test]
fn distance_changes_no_faster_than_its_argument() {
    for shape in shapes() {
        for (a, b) in points(2000).zip(points(2001).skip(1)) {
            let change = (shape.signed_distance(a) - shape.signed_distance(b)).abs();
            assert!(change <= norm(difference(a, b)) + 1e-14, "{shape:?} {a:?} {b:?}");
        }
    }
}

#[test]
fn normal_is_the_gradient_of_the_distance() {
    const STEP: f64 = 1e-6;
    for shape in shapes() {
        let mut smooth = 0;
        for x in points(2000) {
            let normal = shape.normal(x);
            assert_relative_eq!(norm(normal), 1.0, epsilon = 1e-14);
            let gradient = [0, 1, 2].map(|k| {
                let (mut above, mut below) = (x, x);
                above[k] += STEP;
                below[k] -= STEP;
                (shape.signed_distance(above) - shape.signed_distance(below)) / (2.0 * STEP)
            });
            // Between two branches of a distance the difference averages both.
            if norm(gradient) > 1.0 - 1e-6 {
                smooth += 1;
                assert_relative_eq!(gradient[..], normal[..], epsilon = 1e-4);
            }
        }
        assert!(smooth > 1990, "{shape:?}: only {smooth} smooth points");
    }
}

#[test]
fn surface_is_reached_by_going_back_along_the_normal() {
    for shape in shapes() {
        for x in points(500) {
            let (distance, normal) = (shape.signed_distance(x), shape.normal(x));
            let foot = [0, 1, 2].map(|k| x[k] - distance * normal[k]);
            assert_relative_eq!(shape.signed_distance(foot), 0.0, epsilon = 1e-14);
            assert_eq!(shape.contains(x), distance <= 0.0);
        }
    }
}

#[test]
fn distances_around_a_cuboid() {
    let cuboid = Shape::Cuboid { low: [0.0, 0.0, 0.0], high: [2.0, 3.0, 4.0] };
    // From a corner, an edge, a face, on the surface, and inside.
    let third = 1.0 / 3.0_f64.sqrt();
    let half = 0.5_f64.sqrt();
    for (x, distance, normal) in [
        ([-1.0, -1.0, -1.0], 3.0_f64.sqrt(), [-third, -third, -third]),
        ([3.0, 4.0, 5.0], 3.0_f64.sqrt(), [third, third, third]),
        ([3.0, -1.0, 2.0], 2.0_f64.sqrt(), [half, -half, 0.0]),
        ([1.0, 1.0, 6.0], 2.0, [0.0, 0.0, 1.0]),
        ([2.0, 1.0, 2.0], 0.0, [1.0, 0.0, 0.0]),
        ([0.0, 0.0, 0.0], 0.0, [-1.0, 0.0, 0.0]),
        ([0.9, 2.75, 2.0], -0.25, [0.0, 1.0, 0.0]),
        ([1.0, 1.5, 2.0], -1.0, [1.0, 0.0, 0.0]),
    ] {
        assert_relative_eq!(cuboid.signed_distance(x), distance);
        assert_relative_eq!(cuboid.normal(x)[..], normal[..]);
    }
}

#[test]
fn normal_at_a_centre_is_a_unit_vector() {
    let centre = [0.1, 0.2, 0.3];
    let radius = 1.0;
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let cylinder = Shape::Cylinder { axis, centre, radius };
        let normal = cylinder.normal(centre);
        assert_eq!(norm(normal), 1.0);
        assert_eq!(across(axis, normal), normal);
        assert_eq!(cylinder.signed_distance(centre), -1.0);
    }
    let sphere = Shape::Sphere { centre, radius };
    assert_eq!(norm(sphere.normal(centre)), 1.0);
}

#[test]
fn shapes_that_describe_no_body_are_refused() {
    let origin = [0.0; 3];
    for shape in shapes() {
        assert_eq!(shape.check(), Ok(()));
    }
    for radius in [0.0, -1.0, f64::NAN, INFINITY] {
        let sphere = Shape::Sphere { centre: origin, radius };
        assert!(matches!(sphere.check(), Err(ShapeError::Radius(_))));
    }
    let flat = Shape::Cuboid { low: origin, high: [1.0, 0.0, 1.0] };
    assert!(matches!(flat.check(), Err(ShapeError::Corners { .. })));
    let lost = Shape::Sphere { centre: [0.0, f64::NAN, 0.0], radius: 1.0 };
    assert!(matches!(lost.check(), Err(ShapeError::Position(_))));
    let undirected = Shape::HalfSpace { point: origin, outward: origin };
    assert!(matches!(undirected.check(), Err(ShapeError::Direction(_))));
}

#[test]
fn shapes_survive_serialisation() {
    for shape in shapes() {
        let bytes = postcard::to_stdvec(&shape).expect("a shape has a serial form");
        assert_eq!(postcard::from_bytes(&bytes), Ok(shape));
    }
}

#[test]
fn a_way_into_a_body_crosses_its_surface_once_before_its_end() {
    for shape in shapes() {
        let mut crossed = 0;
        for (a, b) in points(2000).zip(points(2007).skip(7)) {
            let along = |s: f64| [0, 1, 2].map(|k| a[k] + s * (b[k] - a[k]));
            let is_inside = |s: f64| shape.contains(along(s));
            match shape.crossing(a, b) {
                Some(s) => {
                    assert!((0.0..=1.0).contains(&s) && !is_inside(0.0));
                    assert!(shape.signed_distance(along(s)).abs() < 1e-14, "{shape:?} {a:?} {b:?}");
                    assert!((1..100).all(|k| !is_inside(s * 0.01 * f64::from(k) - 1e-14)));
                    crossed += 1;
                }
                None => {
                    assert!(
                        is_inside(0.0) || (0..=100).all(|k| !is_inside(0.01 * f64::from(k))),
                        "{shape:?} {a:?} {b:?}"
                    );
                }
            }
        }
        assert!(crossed > 200, "{shape:?}: {crossed} ways crossed");
    }
}
