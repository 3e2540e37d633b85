//! finegrain
