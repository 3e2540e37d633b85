//! What signals ask a run for.

use std::io;
use std::process;

use finegrain::framework::port::{Inbox, Port};

/// Requests that signals make.
pub struct Requests {
    /// Ctrl-C, and on unix SIGTERM, with which batch systems end a job.
    pub stops: Inbox<()>,
    /// SIGUSR1, on unix.
    pub checkpoints: Inbox<()>,
}

impl Requests {
    /// Listens from now on, until the process ends. The first request to stop ends the run in order, and does nothing
    /// when its steps are done and the rest is being written; the second ends the process with exit code 130.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn listen() -> io::Result<Self> {
        let (stop, stops) = Port::unbounded("stop");
        let (checkpoint, checkpoints) = Port::unbounded("checkpoint");
        let mut asked = false;
        let on_stop = move || {
            if asked {
                process::exit(130);
            }
            asked = true;
            // Nobody asks when the steps are done.
            let _ = stop.post(());
        };
        spawn(on_stop, checkpoint)?;
        Ok(Self { stops, checkpoints })
    }
}

/// SIGHUP is not among them: a run under `nohup` is to go on.
#[cfg(unix)]
fn spawn(mut on_stop: impl FnMut() + Send + 'static, checkpoint: Port<()>) -> io::Result<()> {
    use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
    let mut signals = signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGUSR1])?;
    let listen = move || {
        for signal in signals.forever() {
            match signal {
                SIGUSR1 => {
                    // Nobody asks where there is no folder, or when the run has ended.
                    let _ = checkpoint.post(());
                }
                _ => on_stop(),
            }
        }
    };
    std::thread::Builder::new().name("signals".to_owned()).spawn(listen).map(drop)
}

#[cfg(not(unix))]
fn spawn(on_stop: impl FnMut() + Send + 'static, _: Port<()>) -> io::Result<()> {
    ctrlc::set_handler(on_stop).map_err(io::Error::other)
}
