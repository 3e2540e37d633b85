//! What a panic said.

use std::any::Any;

/// What a panic said.
pub(crate) fn panic_message(panic: Box<dyn Any + Send>) -> String {
    let message = match panic.downcast::<String>() {
        Ok(message) => return *message,
        Err(panic) => panic,
    };
    match message.downcast::<&str>() {
        Ok(message) => (*message).to_owned(),
        Err(payload) => {
            // Whatever it is, dropping it might panic once more.
            std::mem::forget(payload);
            "no message".to_owned()
        }
    }
}
