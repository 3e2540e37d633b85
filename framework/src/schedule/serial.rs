//! The serial reference: what every other schedule must agree with, bit for bit.

use super::order::Order;
use super::work::Work;

/// Runs every part of every step over all sub-domains in order.
pub(super) fn run(work: &dyn Work, order: &Order) {
    for step in work.steps() {
        for part in 0..work.parts() {
            let fence = work.fence();
            for place in 0..work.partition().len() {
                work.run(0, &fence, step, part, order.at(place));
            }
            if work.failed() {
                return;
            }
        }
    }
}
