//! The size of the processor's caches, where the system tells.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

/// Taken where the system does not tell: a second-level cache of our time.
const USUAL: usize = 1 << 20;

/// Bytes of cache that one of `workers` workers has to itself: of the level where that is most.
pub(super) fn cache_share(workers: usize) -> usize {
    static CACHES: OnceLock<Vec<Cache>> = OnceLock::new();
    let caches =
        CACHES.get_or_init(|| read_caches(Path::new("/sys/devices/system/cpu/cpu0/cache")));
    share(caches, workers).unwrap_or(USUAL)
}

/// A cache that holds data.
#[derive(Debug, PartialEq)]
struct Cache {
    bytes: usize,
    /// How many processors share it.
    processors: usize,
}

fn share(caches: &[Cache], workers: usize) -> Option<usize> {
    caches.iter().map(|cache| cache.bytes / cache.processors.min(workers).max(1)).max()
}

/// The caches of one processor as Linux describes them in `folder`; none elsewhere.
fn read_caches(folder: &Path) -> Vec<Cache> {
    let described = (0..).map(|index| folder.join(format!("index{index}")));
    let described = described.map_while(|cache| {
        let read = |name| fs::read_to_string(cache.join(name));
        Some([read("type").ok()?, read("size").ok()?, read("shared_cpu_list").ok()?])
    });
    described
        .filter(|[kind, ..]| kind.trim() != "Instruction")
        .filter_map(|[_, size, sharing]| {
            Some(Cache { bytes: bytes(&size)?, processors: processors(&sharing)? })
        })
        .collect()
}

/// A size such as `1024K`.
fn bytes(size: &str) -> Option<usize> {
    let size = size.trim();
    let digits = size.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match &size[digits.len()..] {
        "" => 1,
        "K" => 1 << 10,
        "M" => 1 << 20,
        _ => return None,
    };
    Some(digits.parse::<usize>().ok()? * unit)
}

/// How many processors a list such as `0-3,8-11` names.
fn processors(list: &str) -> Option<usize> {
    let counts = list.trim().split(',').map(|range| {
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        let (first, last): (usize, usize) = (first.parse().ok()?, last.parse().ok()?);
        Some(last.checked_sub(first)? + 1)
    });
    counts.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_linux_writes_is_understood() {
        assert_eq!(bytes("1024K\n"), Some(1 << 20));
        assert_eq!(bytes("32M"), Some(32 << 20));
        assert_eq!(bytes("big"), None);
        assert_eq!(processors("0\n"), Some(1));
        assert_eq!(processors("0-3,8-11"), Some(8));
        assert_eq!(processors("3-1"), None);
    }

    #[test]
    fn a_worker_shares_with_those_that_work() {
        let caches =
            [Cache { bytes: 1 << 20, processors: 1 }, Cache { bytes: 32 << 20, processors: 16 }];
        assert_eq!(share(&caches, 2), Some(16 << 20));
        assert_eq!(share(&caches, 16), Some(2 << 20));
        assert_eq!(share(&caches[..1], 16), Some(1 << 20));
        assert_eq!(share(&[], 4), None);
    }

    #[test]
    fn a_system_that_does_not_tell_is_no_error() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(read_caches(folder.path()), []);
    }
}
