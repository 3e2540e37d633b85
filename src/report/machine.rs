//! On what a report was made.

use std::thread::available_parallelism;

use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};

/// The machine that this process runs on, and the versions of what runs.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Name of the processor.
    pub processor: String,
    /// Cores that this process may use.
    pub cores: usize,
    /// Memory, bytes.
    pub memory: u64,
    /// Name and version of the operating system.
    pub system: String,
    /// Version of finegrain.
    pub version: &'static str,
}

impl Machine {
    /// This one.
    pub fn here() -> Self {
        let wanted = RefreshKind::nothing()
            .with_cpu(CpuRefreshKind::nothing())
            .with_memory(MemoryRefreshKind::nothing().with_ram());
        // Where the system does not tell, a report can still be made.
        let system = System::new_with_specifics(wanted).ok();
        let processor = system.as_ref().and_then(|system| system.cpus().first());
        let processor = processor.map_or("", |cpu| cpu.brand().trim());
        let unknown = |name: &str| if name.is_empty() { "unknown" } else { name }.to_owned();
        Self {
            processor: unknown(processor),
            cores: available_parallelism().map_or(1, usize::from),
            memory: system.as_ref().map_or(0, System::total_memory),
            system: unknown(&System::long_os_version().unwrap_or_default()),
            version: env!("CARGO_PKG_VERSION"),
        }
    }

    /// A line about it.
    pub fn line(&self) -> String {
        let Self { processor, cores, memory, system, version } = self;
        let gigabytes = *memory as f64 / f64::from(1 << 30);
        let plural = if *cores == 1 { "" } else { "s" };
        format!(
            "{processor}, {cores} core{plural}, {gigabytes:.0} GiB, {system}; finegrain {version}"
        )
    }
}
