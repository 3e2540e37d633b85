//! No damage to a checkpoint passes unnoticed: there is an error that says what is wrong and where,
//! never a panic, and never wrong numbers.

use std::fs;
use std::path::PathBuf;

use finegrain_framework::checkpoint::{
    CheckpointError, CheckpointReader, CheckpointWriter, Header, Part,
};
use finegrain_framework::format::Kind;
use serde::Serialize;

struct Sample {
    _folder: tempfile::TempDir,
    path: PathBuf,
    bytes: Vec<u8>,
}

impl Sample {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.ckpt");
        let header = Header { method: "sph".into(), scene_hash: 42 };
        let mut writer = CheckpointWriter::create(&path, &header, &(7_u64, "meta")).unwrap();
        writer.add_block("x", &vec![1.0_f64, 2.0, 3.0]).unwrap();
        writer.add_block("id", &vec![10_u32, 20]).unwrap();
        writer.finish().unwrap();
        let bytes = fs::read(&path).unwrap();
        Self { _folder: folder, path, bytes }
    }

    fn open(&self, bytes: &[u8]) -> Result<CheckpointReader, CheckpointError> {
        fs::write(&self.path, bytes).unwrap();
        CheckpointReader::open(&self.path)
    }

    fn error(&self, bytes: &[u8]) -> CheckpointError {
        let error = self.open(bytes).unwrap_err();
        assert!(error.to_string().contains("run.ckpt"), "{error} names the file");
        error
    }

    /// Where the numbers of block x are.
    fn numbers(&self) -> usize {
        let one = 1.0_f64.to_le_bytes();
        self.bytes.windows(8).position(|window| window == one).unwrap()
    }
}

#[test]
fn every_changed_byte_is_noticed() {
    let sample = Sample::new();
    for at in 0..sample.bytes.len() {
        for change in (0..8).map(|bit| 1 << bit).chain([0xff]) {
            let mut bytes = sample.bytes.clone();
            bytes[at] ^= change;
            sample.error(&bytes);
        }
    }
}

#[test]
fn every_missing_end_is_noticed() {
    let sample = Sample::new();
    for length in 0..sample.bytes.len() {
        let error = sample.error(&sample.bytes[..length]);
        if length < 8 {
            assert!(matches!(error, CheckpointError::NotACheckpoint { .. }));
        } else {
            assert!(matches!(error, CheckpointError::Truncated { .. }), "{error}");
        }
    }
    let error = sample.error(&sample.bytes[..sample.numbers() + 10]);
    assert!(error.to_string().ends_with("truncated: block `x` needs 24 more bytes, 10 are left"));
}

#[test]
fn more_than_was_written() {
    let sample = Sample::new();
    let bytes = [&sample.bytes[..], b"more"].concat();
    assert!(matches!(sample.error(&bytes), CheckpointError::TrailingBytes { bytes: 4, .. }));
}

#[test]
fn a_changed_number_names_its_block() {
    let sample = Sample::new();
    let mut bytes = sample.bytes.clone();
    bytes[sample.numbers() + 9] ^= 1;
    let error = sample.error(&bytes);
    let CheckpointError::Checksum { part, .. } = &error else {
        panic!("{error}");
    };
    assert_eq!(part, &Part::Block { name: "x".into() });
}

#[test]
fn other_files_and_other_versions() {
    let sample = Sample::new();
    for bytes in [&b""[..], b"FINE", b"<?xml version=\"1.0\"?>"] {
        assert!(matches!(sample.error(bytes), CheckpointError::NotACheckpoint { .. }));
    }
    let mut bytes = sample.bytes.clone();
    bytes[8] = 2;
    let error = sample.error(&bytes);
    assert!(error.to_string().ends_with("layout version 2; this program reads version 1"));

    fs::remove_file(&sample.path).unwrap();
    let error = CheckpointReader::open(&sample.path).unwrap_err();
    assert!(matches!(error, CheckpointError::File { attempt: "read", .. }));
}

fn checked(bytes: &[u8]) -> Vec<u8> {
    [bytes, &crc32fast::hash(bytes).to_le_bytes()].concat()
}

fn frame(content: &[u8]) -> Vec<u8> {
    let length = (content.len() as u64).to_le_bytes();
    [checked(&length), checked(content)].concat()
}

fn encode(content: &impl Serialize) -> Vec<u8> {
    frame(&postcard::to_stdvec(content).unwrap())
}

/// Files whose checksums are right, but which no writer of ours writes.
#[test]
fn nonsense_with_the_right_checksums() {
    let preamble = checked(b"FINEGRN\0\x01\0\0\0");
    let header = encode(&("sph", 42_u64, &[0_u8; 0][..]));
    let sample = Sample::new();

    let error = sample.error(&[&preamble[..], &frame(b"\xff")].concat());
    assert!(matches!(error, CheckpointError::Malformed { part: Part::Header, .. }));

    let with = |record: Vec<u8>| sample.error(&[&preamble[..], &header, &record].concat());
    let head = Part::Head { index: 0 };
    for record in
        [frame(b"\x07"), encode(&(1_u32, 3_u64)), encode(&(0_u32, "x", Kind::F64, u64::MAX))]
    {
        let error = with(record);
        assert!(
            matches!(&error, CheckpointError::Malformed { part, .. } if *part == head),
            "{error}"
        );
    }
    // Lengths that no memory can hold, where the file ends.
    let error = with(encode(&(0_u32, "x", Kind::F64, u64::MAX / 8)));
    assert!(matches!(error, CheckpointError::Truncated { found: 0, .. }), "{error}");
    let error = with(checked(&u64::MAX.to_le_bytes()));
    assert!(matches!(error, CheckpointError::Truncated { expected: u64::MAX, .. }), "{error}");
}

#[test]
fn a_file_that_changes_while_it_is_open() {
    let sample = Sample::new();
    let mut reader = sample.open(&sample.bytes).unwrap();
    let mut bytes = sample.bytes.clone();
    bytes[sample.numbers()] ^= 1;
    fs::write(&sample.path, &bytes).unwrap();
    assert!(matches!(reader.read::<f64>("x"), Err(CheckpointError::Checksum { .. })));
    fs::write(&sample.path, &bytes[..20]).unwrap();
    assert!(matches!(reader.read::<u32>("id"), Err(CheckpointError::File { .. })));
}
