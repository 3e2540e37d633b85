//! Why a run ended too early.

use crate::columns::{Column, Limit};
use crate::stage::Fault;

/// What went wrong in a leg, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Number of the step.
    pub step: u64,
    /// Place of the part in the step.
    pub part: usize,
    /// Name of the stage.
    pub stage: String,
    /// Number of the sub-domain; `None` for whole-domain work.
    pub sub_domain: Option<usize>,
    /// Why.
    pub cause: Cause,
}

/// Why a stage of a sub-domain ended a run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Cause {
    /// The stage said so.
    #[error("{0}")]
    Fault(#[from] Fault),
    /// The stage panicked.
    #[error("the stage panicked: {0}")]
    Panic(String),
    /// A state column holds NaN or infinity.
    #[error("column {column:?} holds a value that is not finite")]
    NotFinite {
        /// Name of the column.
        column: String,
    },
    /// A state column holds a value beyond its limit ([`Columns::limit`](crate::Columns::limit)), NaN or
    /// infinity.
    #[error("column {column:?} holds a value that is not between -{most} and {most}: {beyond}", most = limit.most, beyond = limit.beyond)]
    Beyond {
        /// Name of the column.
        column: String,
        /// Its limit.
        limit: &'static Limit,
    },
}

impl Cause {
    /// That a column holds what it must not.
    pub(crate) fn invalid(column: &Column) -> Self {
        let name = column.name().to_owned();
        match column.limit() {
            Some(limit) => Self::Beyond { column: name, limit },
            None => Self::NotFinite { column: name },
        }
    }
}
