//! How far a run has come.

use std::thread::JoinHandle;
use std::time::Duration;

use finegrain::framework::port::Port;
use finegrain::framework::run::Progress;
use indicatif::{ProgressBar, ProgressStyle};

/// Progress on standard error: how far, steps per second, time left.
pub struct ProgressLine {
    /// Where it hears of progress.
    pub port: Port<Progress>,
    thread: JoinHandle<()>,
}

impl ProgressLine {
    /// Shows what comes to its port from now on.
    pub fn start() -> Self {
        let (port, mut inbox) = Port::bounded("progress", 4);
        let thread = std::thread::spawn(move || {
            let bar = ProgressBar::new(1000);
            if let Ok(style) = ProgressStyle::with_template("{bar:30} {percent:>3} % {msg}") {
                bar.set_style(style);
            }
            while let Some(progress) = inbox.take() {
                let Progress { step, time, steps_per_second, fraction, remaining } = progress;
                if let Some(fraction) = fraction {
                    bar.set_position((1000.0 * fraction) as u64);
                }
                let left = remaining.map_or_else(String::new, |left: Duration| {
                    format!(", at most {} s left", left.as_secs())
                });
                bar.set_message(format!(
                    "step {step}, t = {time:.4e} s, {steps_per_second:.1} steps/s{left}"
                ));
            }
            bar.finish_and_clear();
        });
        Self { port, thread }
    }

    /// Ends it when the last event has been shown.
    pub fn finish(self) {
        drop(self.port);
        // It only draws; if it panicked there is nothing to save.
        let _ = self.thread.join();
    }
}
