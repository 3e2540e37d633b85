//! Stages and scratch that threads could not share.

/// A stage with a field of type `$field` and scratch of type `$scratch`.
macro_rules! stage {
    ($field:literal, $scratch:literal) => {
        concat!(
            "use finegrain_framework::{space::Independent, *};
            struct Counting(",
            $field,
            ");
            impl UpdateStage<Independent> for Counting {
                type Scratch = ",
            $scratch,
            ";
                fn update(
                    &self,
                    _: &mut Own<'_, Independent>,
                    _: &mut Self::Scratch,
                    _: &Moment,
                ) -> Result<(), Fault> {
                    Ok(())
                }
            }"
        )
    };
}

/// A pair of doc tests: a stage that is allowed and one that is not.
macro_rules! refused_stage {
    ($name:ident, $code:literal, allowed $allowed:expr, refused $refused:expr) => {
        #[doc = concat!("```\n", $allowed, "\n```\n")]
        #[doc = concat!("```compile_fail,", $code, "\n", $refused, "\n```")]
        mod $name {}
    };
}

refused_stage!(
    a_stage_that_counts_calls,
    "E0277",
    allowed stage!("std::sync::atomic::AtomicU64", "()"),
    refused stage!("std::cell::Cell<u64>", "()")
);

refused_stage!(
    a_stage_that_shares_in_secret,
    "E0277",
    allowed stage!("std::sync::Arc<u64>", "()"),
    refused stage!("std::rc::Rc<u64>", "()")
);

refused_stage!(
    a_scratch_that_stays_behind,
    "E0277",
    allowed stage!("()", "Vec<u64>"),
    refused stage!("()", "std::rc::Rc<u64>")
);
