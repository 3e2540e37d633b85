//! How many steps `PeerToPeer` runs between meetings.

use super::Model;
use crate::domain::Domain;

pub(super) fn steps_ahead<D: Domain>(_model: &Model<D>) -> u64 {
    8
}
