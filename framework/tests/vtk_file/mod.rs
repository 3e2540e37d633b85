//! Reads back the VTK files that the tests write: just enough of the format, and strict about it.

use std::collections::BTreeMap;

/// An array as it stands in the file.
#[derive(Debug)]
pub struct ReadArray {
    pub kind: String,
    pub components: usize,
    bytes: Vec<u8>,
}

impl ReadArray {
    /// The numbers, converted to `f64`.
    pub fn numbers(&self) -> Vec<f64> {
        let bytes = &self.bytes;
        match self.kind.as_str() {
            "Float32" => words(bytes, |b| f64::from(f32::from_le_bytes(b))),
            "Float64" => words(bytes, f64::from_le_bytes),
            "UInt8" => words(bytes, |[b]| f64::from(b)),
            "UInt32" => words(bytes, |b| f64::from(u32::from_le_bytes(b))),
            "UInt64" => words(bytes, |b| u64::from_le_bytes(b) as f64),
            "Int64" => words(bytes, |b| i64::from_le_bytes(b) as f64),
            kind => panic!("unknown type {kind}"),
        }
    }
}

fn words<const N: usize>(bytes: &[u8], word: impl Fn([u8; N]) -> f64) -> Vec<f64> {
    assert_eq!(bytes.len() % N, 0);
    let chunks = bytes.chunks_exact(N);
    chunks.map(|chunk| word(chunk.try_into().unwrap())).collect()
}

/// The XML before the raw bytes, and the arrays by name.
pub fn read(file: &[u8]) -> (String, BTreeMap<String, ReadArray>) {
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let at = file.windows(mark.len()).position(|window| window == mark).unwrap();
    let xml = String::from_utf8(file[..at].to_vec()).unwrap();
    let raw = &file[at + mark.len()..];
    let mut arrays = BTreeMap::new();
    let mut end = 0;
    for tag in xml.split('<').filter(|tag| tag.contains("format=\"appended\"")) {
        let offset: usize = attribute(tag, "offset").parse().unwrap();
        assert_eq!(offset, end, "arrays follow one another without a gap");
        let length = u64::from_le_bytes(raw[offset..offset + 8].try_into().unwrap()) as usize;
        end = offset + 8 + length;
        let array = ReadArray {
            kind: attribute(tag, "type"),
            components: find(tag, "NumberOfComponents").map_or(1, |n| n.parse().unwrap()),
            bytes: raw[offset + 8..end].to_vec(),
        };
        assert!(arrays.insert(attribute(tag, "Name"), array).is_none());
    }
    assert_eq!(&raw[end..], b"\n</AppendedData>\n</VTKFile>\n");
    (xml, arrays)
}

/// The unescaped value of an attribute that a tag must have.
pub fn attribute(tag: &str, key: &str) -> String {
    find(tag, key).unwrap_or_else(|| panic!("no {key} in {tag}"))
}

fn find(tag: &str, key: &str) -> Option<String> {
    let (_, rest) = tag.split_once(&format!(" {key}=\""))?;
    let (value, _) = rest.split_once('"')?;
    let value = value.replace("&lt;", "<").replace("&gt;", ">");
    let value = value.replace("&quot;", "\"").replace("&apos;", "'");
    Some(value.replace("&amp;", "&"))
}
