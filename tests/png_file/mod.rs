//! Reads pictures back.

use std::collections::HashMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// How many pixels have each colour.
pub type Colours = HashMap<[u8; 3], usize>;

/// Width, height and colours of a PNG file.
pub fn decoded(path: &Path) -> (u32, u32, Colours) {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let mut colours = Colours::new();
    for &pixel in pixels[..info.buffer_size()].as_chunks::<3>().0 {
        *colours.entry(pixel).or_default() += 1;
    }
    (info.width, info.height, colours)
}
