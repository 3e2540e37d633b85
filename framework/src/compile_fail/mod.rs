//! Races that do not compile.
//!
//! Every case is a pair of doc tests made from one text: without the offending line it compiles,
//! with it it does not, so that no case can fail for a reason of its own. The error codes are
//! compared only by a nightly rustdoc: `RUSTC_BOOTSTRAP=1 cargo test --doc -p finegrain-framework`.

/// A pair of doc tests: `$before $after`, and with `$offence` in between.
macro_rules! refused {
    ($name:ident, $code:literal, $before:expr, $offence:expr, $after:expr) => {
        #[doc = concat!("```\n", $before, $after, "\n```\n")]
        #[doc = concat!("```compile_fail,", $code, "\n", $before, $offence, $after, "\n```")]
        mod $name {}
    };
}

/// The pair inside a rate stage of particles that own one span.
macro_rules! refused_in_rate {
    ($name:ident, $code:literal, $before:literal, $offence:literal) => {
        refused!(
            $name,
            $code,
            concat!(
                "use finegrain_framework::{space::Independent, *};
                struct Stage {
                    state: State<f64>,
                    rate: Rate<f64>,
                    kept: std::sync::Mutex<Option<&'static [f64]>>,
                }
                #[derive(Default)]
                struct Scratch {
                    slice: Option<&'static [f64]>,
                    slice_mut: Option<&'static mut [f64]>,
                }
                impl RateStage<Independent> for Stage {
                    type Scratch = Scratch;
                    fn writes(&self) -> Vec<ColumnId> {
                        vec![self.rate.id()]
                    }
                    fn rate(
                        &self,
                        near: &Near<'_, Independent>,
                        rates: &mut Rates<'_, Independent>,
                        scratch: &mut Scratch,
                        _: &Moment,
                    ) -> Result<(), Fault> {\n",
                $before
            ),
            $offence,
            "\nOk(()) } }"
        );
    };
}

/// The pair inside an update stage of particles that own one span.
macro_rules! refused_in_update {
    ($name:ident, $code:literal, $before:literal, $offence:literal) => {
        refused!(
            $name,
            $code,
            concat!(
                "use finegrain_framework::{space::Independent, *};
                struct Stage {
                    state: State<f64>,
                    rate: Rate<f64>,
                }
                impl UpdateStage<Independent> for Stage {
                    type Scratch = ();
                    fn update(
                        &self,
                        own: &mut Own<'_, Independent>,
                        _: &mut (),
                        _: &Moment,
                    ) -> Result<(), Fault> {\n",
                $before
            ),
            $offence,
            "\nOk(()) } }"
        );
    };
}

mod keeping;
mod sharing;
mod stages;
mod twice;
mod writing;
