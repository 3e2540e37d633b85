//! What particles of a start must be before anything is computed with them.

use crate::bins::Bins;
use crate::error::SphError;
use crate::start::Start;
use crate::wall::Walls;

/// Particles nearer to each other than this, in spacings, overlap.
const LEAST_DISTANCE: f64 = 1e-3;

/// The longest way, in spacings, from a point in a body to the next particle that fills it. More
/// than a packing leaves room for, beside the steps of a lattice at a slanted surface, too: the
/// outermost layer that the fluid sees may be missing, where the kernel is nearly 0.
const WIDEST_GAP: f64 = 1.3;

/// Longest reach of a kernel, in periods: further, a particle sees more images of itself than other
/// particles.
const MOST_PERIODS: f64 = 2.0;

/// Refuses a box that is shorter in a periodic direction than the kernel with this `range`, m,
/// allows.
pub(crate) fn check_periods(start: &Start, range: f64) -> Result<(), SphError> {
    let region = &start.region;
    for direction in (0..region.lower.len()).filter(|&a| region.periodic[a]) {
        let period = region.upper[direction] - region.lower[direction];
        if range > MOST_PERIODS * period {
            return Err(SphError::Period { direction, period, range });
        }
    }
    Ok(())
}

/// Refuses two particles at one place.
pub(crate) fn check_overlap(start: &Start) -> Result<(), SphError> {
    let bins = Bins::new(&start.region, start.spacing, &start.positions);
    let least = LEAST_DISTANCE * start.spacing;
    for (first, &position) in start.positions.iter().enumerate() {
        if let Some(second) = bins.find(position, least, |other| other != first) {
            let distance = bins.distance(position, start.positions[second]);
            return Err(SphError::Overlap { first, second, position, distance, least });
        }
    }
    Ok(())
}

/// Refuses bodies that no particle fills, and those with gaps, or thinner, as far as the fluid sees
/// them with a kernel of this `range`, m.
pub(crate) fn check_bodies(start: &Start, walls: &Walls, range: f64) -> Result<(), SphError> {
    let is_inside = |x: [f64; 3]| walls.signed_distance(x) < 0.0;
    if let Some(number) = walls.find_empty(&start.positions) {
        return Err(SphError::EmptyBody { number });
    }
    let filling: Vec<_> = start.positions.iter().copied().filter(|&x| is_inside(x)).collect();
    let gap = WIDEST_GAP * start.spacing;
    let bins = Bins::new(&start.region, gap, &filling);
    for (particle, &x) in start.positions.iter().enumerate() {
        let Some((body, distance)) = walls.nearest(x) else { return Ok(()) };
        if distance < 0.0 || distance >= range {
            continue;
        }
        // Straight through the surface, layer by layer, as deep as it sees.
        let inwards = body.inwards(x, 1e-3 * start.spacing, start.region.lower.len());
        let layers = (0..).map(|k| distance + (f64::from(k) + 0.5) * start.spacing);
        for depth in layers.take_while(|&depth| depth < range) {
            let at = std::array::from_fn(|a| x[a] + depth * inwards[a]);
            if bins.find(at, gap, |_| true).is_none() {
                let (number, is_thin) = (body.number, !is_inside(at));
                return Err(SphError::Gap { number, particle, at, range, is_thin });
            }
        }
    }
    Ok(())
}
