//! The colour map `viridis` (van der Walt & Smith 2015): perceptually uniform, readable by the
//! colour-blind and in grey.

use super::canvas::Colour;

/// Colours at equal distances from the low to the high end.
const NODES: [Colour; 20] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x15, 0x68],
    [0x48, 0x26, 0x77],
    [0x45, 0x37, 0x81],
    [0x3f, 0x47, 0x88],
    [0x39, 0x55, 0x8c],
    [0x32, 0x64, 0x8e],
    [0x2d, 0x71, 0x8e],
    [0x28, 0x7d, 0x8e],
    [0x23, 0x8a, 0x8d],
    [0x1f, 0x96, 0x8b],
    [0x20, 0xa3, 0x86],
    [0x29, 0xaf, 0x7f],
    [0x3c, 0xbc, 0x75],
    [0x56, 0xc6, 0x67],
    [0x74, 0xd0, 0x55],
    [0x94, 0xd8, 0x40],
    [0xb8, 0xde, 0x29],
    [0xdc, 0xe3, 0x18],
    [0xfd, 0xe7, 0x25],
];

/// The colour of a value at `place`, 0 at the low end and 1 at the high end.
pub(super) fn viridis(place: f64) -> Colour {
    let last = NODES.len() - 1;
    let x = place.clamp(0.0, 1.0) * last as f64;
    let node = (x as usize).min(last - 1);
    let weight = x - node as f64;
    std::array::from_fn(|c| {
        let (a, b) = (f64::from(NODES[node][c]), f64::from(NODES[node + 1][c]));
        (a + weight * (b - a)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_grows_with_the_value() {
        let light = |k: i32| {
            let [r, g, b] = viridis(f64::from(k) / 100.0).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..100).all(|k| light(k) < light(k + 1)));
        assert_eq!(viridis(-1.0), NODES[0]);
        assert_eq!(viridis(2.0), NODES[19]);
    }
}
