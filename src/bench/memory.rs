//! Memory of this process, as the operating system counts it.

use std::fs;

/// Forgets the largest resident size so far, where the system can.
pub fn reset_peak() {
    // Not being able to leaves a peak that is too large, never one too small.
    let _ = fs::write("/proc/self/clear_refs", "5");
}

/// Largest resident size since the last [`reset_peak`], bytes; `None` where the system does not
/// tell.
pub fn peak() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}
