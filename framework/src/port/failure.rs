use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::panic_message::panic_message;

/// Why messages were not handled as they should.
#[derive(Debug, thiserror::Error)]
pub enum Failure<E: Error + 'static> {
    /// The handler returned an error.
    #[error("the handler of port `{port}` failed")]
    Handler {
        /// Name of the port, or of both ports of a join.
        port: String,
        /// What the handler returned.
        source: E,
    },
    /// The handler panicked. What it owns is as the panic left it.
    #[error("the handler of port `{port}` panicked: {message}")]
    Panic {
        /// Name of the port, or of both ports of a join.
        port: String,
        /// The message of the panic.
        message: String,
    },
    /// A port closed before all the messages that one call of the handler needs had come.
    #[error("port `{port}` closed with {found} of the {expected} messages waited for")]
    Incomplete {
        /// Name of the port.
        port: String,
        /// How many messages of this port the handler needs.
        expected: usize,
        /// How many had come.
        found: usize,
    },
}

/// Runs `handler` and turns its error or its panic into a failure of `port`.
pub(super) fn guarded<R, E: Error>(
    port: &str,
    handler: impl FnOnce() -> Result<R, E>,
) -> Result<R, Failure<E>> {
    // AssertUnwindSafe: the failure tells the coordinator that what the handler owns is suspect,
    // and the arbiter itself holds no invariant across the call.
    match catch_unwind(AssertUnwindSafe(handler)) {
        Ok(Ok(result)) => Ok(result),
        Ok(Err(source)) => Err(Failure::Handler { port: port.to_string(), source }),
        Err(payload) => {
            Err(Failure::Panic { port: port.to_string(), message: panic_message(payload) })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Grudge;

    impl Drop for Grudge {
        fn drop(&mut self) {
            panic!("dropped");
        }
    }

    #[test]
    fn a_payload_that_panics_when_dropped_is_a_failure_like_any_other() {
        let handler = || -> Result<(), std::fmt::Error> { std::panic::panic_any(Grudge) };
        let failure = guarded("results", handler).unwrap_err();
        assert!(matches!(failure, Failure::Panic { .. }), "{failure}");
    }
}
