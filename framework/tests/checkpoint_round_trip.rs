//! What a checkpoint gives back has the bits that were put in.

use finegrain_framework::checkpoint::{CheckpointReader, CheckpointWriter, Header};
use finegrain_framework::format::Kind;
use serde::{Deserialize, Serialize};

#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Metadata {
    step: u64,
    time: f64,
    files: Vec<String>,
}

fn header() -> Header {
    Header { method: "sph".into(), scene_hash: u64::MAX - 1 }
}

#[test]
fn bits_of_every_kind() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.ckpt");
    // NaNs with payloads, quiet and signalling, infinities, both zeros, subnormals; and enough of
    // everything to need more than one buffer.
    let odd = [0x7ff8_0000_dead_beef, 0x7ff0_0000_0000_0001, 0xfff0_0000_0000_0000, 1, 1 << 63];
    let doubles: Vec<f64> = (0..20_000_u64)
        .map(|i| f64::from_bits(odd.get(i as usize).copied().unwrap_or(i << 44)))
        .collect();
    let singles: Vec<f32> =
        [0x7fc0_beef, 0x7f80_0001, 0xff80_0000, 1, 1 << 31].map(f32::from_bits).to_vec();
    let bytes: Vec<u8> = (0..=255).collect();
    let words = vec![0, 1, u32::MAX];
    let longs = vec![u64::MAX; 10_001];
    let metadata = Metadata { step: 12, time: 0.1 + 0.2, files: vec!["a.vtu".into()] };

    let mut writer = CheckpointWriter::create(&path, &header(), &metadata).unwrap();
    writer.add_block("doubles", &doubles).unwrap();
    writer.add_block("singles", &singles).unwrap();
    writer.add_block("bytes", &bytes).unwrap();
    writer.add_block("words", &words).unwrap();
    writer.add_block("longs", &longs).unwrap();
    writer.add_block("none", &[] as &[f64]).unwrap();
    assert!(!path.exists(), "not before it is finished");
    writer.finish().unwrap();

    let mut reader = CheckpointReader::open(&path).unwrap();
    reader.require("sph", u64::MAX - 1).unwrap();
    assert_eq!(reader.header(), &header());
    assert_eq!(reader.metadata::<Metadata>().unwrap(), metadata);
    let blocks: Vec<_> =
        reader.blocks().map(|block| (block.name.clone(), block.kind, block.count)).collect();
    let expected = [
        ("doubles", Kind::F64, 20_000),
        ("singles", Kind::F32, 5),
        ("bytes", Kind::U8, 256),
        ("words", Kind::U32, 3),
        ("longs", Kind::U64, 10_001),
        ("none", Kind::F64, 0),
    ];
    assert_eq!(blocks, expected.map(|(name, kind, count)| (name.to_string(), kind, count)));
    // Not in the order of writing.
    let bits = |numbers: &[f64]| numbers.iter().map(|n| n.to_bits()).collect::<Vec<_>>();
    assert_eq!(reader.read::<u64>("longs").unwrap(), longs);
    let read: Vec<f32> = reader.read("singles").unwrap();
    assert!(read.iter().zip(&singles).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert_eq!(bits(&reader.read("doubles").unwrap()), bits(&doubles));
    let mut filled = vec![0.0; doubles.len()];
    reader.read_into("doubles", &mut filled).unwrap();
    assert_eq!(bits(&filled), bits(&doubles));
    assert_eq!(reader.read::<u8>("bytes").unwrap(), bytes);
    assert_eq!(reader.read::<u32>("words").unwrap(), words);
    assert!(reader.read::<f64>("none").unwrap().is_empty());
}

#[test]
fn a_checkpoint_of_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.ckpt");
    let writer = CheckpointWriter::create(&path, &header(), &()).unwrap();
    writer.finish().unwrap();
    let reader = CheckpointReader::open(&path).unwrap();
    assert_eq!(reader.blocks().count(), 0);
    reader.metadata::<()>().unwrap();
}

#[test]
fn the_same_state_gives_the_same_file() {
    let folder = tempfile::tempdir().unwrap();
    let files = ["a.ckpt", "b.ckpt"].map(|name| {
        let path = folder.path().join(name);
        let mut writer = CheckpointWriter::create(&path, &header(), &3_u8).unwrap();
        writer.add_block("x", &vec![1.5_f64; 3]).unwrap();
        writer.finish().unwrap();
        std::fs::read(path).unwrap()
    });
    assert_eq!(files[0], files[1]);
}
