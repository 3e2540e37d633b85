//! What a stage's author can get wrong about columns and neighbours is an error of that stage that
//! says what is wrong, never a race.

mod models;

use finegrain_framework::*;
use models::closures::{rate_stage, update_stage};

/// Five sub-domains in a row, each of a span of 2 points and one of 1, seeing only the next ones.
struct Row {
    partition: Partition,
}

impl Row {
    fn new() -> Self {
        let mut partition = Partition::new(15);
        for id in 0..5u32 {
            let start = 3 * id as usize;
            let spans = [Span { start, end: start + 2 }, Span { start: start + 2, end: start + 3 }];
            let near = [id.checked_sub(1), (id < 4).then_some(id + 1)];
            partition.push(spans, near.into_iter().flatten());
        }
        partition.seal().unwrap();
        Self { partition }
    }
}

impl Domain for Row {
    type SubDomain<'a> = Piece<'a>;

    fn partition(&self) -> &Partition {
        &self.partition
    }

    fn sub_domain(&self, id: usize) -> Piece<'_> {
        self.partition.piece(id)
    }
}

#[derive(Clone, Copy)]
struct Fields {
    notes: Notes<Vec<u64>>,
    foreign_notes: Notes<Vec<u8>>,
    state: State<f64>,
    other: State<f32>,
    rate: Rate<f64>,
    unlisted: Rate<f64>,
}

fn run(make: impl FnOnce(Fields) -> Stage<Row>) -> Result<(), RunError> {
    let mut columns = Columns::new(15);
    let fields = Fields {
        notes: columns.notes(),
        foreign_notes: Columns::new(1).notes(),
        state: columns.state("state"),
        other: columns.state("other"),
        rate: columns.rate("rate"),
        unlisted: columns.rate("unlisted"),
    };
    let step = Step::builder().stage_at(0.0, &make(fields)).build();
    let model = Model::with_fixed_dt("misuse", Row::new(), columns, step, 1.0);
    let settings = Settings { workers: 2, ..Settings::default() };
    Simulation::new(model, settings).unwrap().advance(1)
}

/// Sub-domain 2 does what `rate` does.
fn in_rate(
    rate: impl Fn(Fields, &Near<'_, Row>, &mut Rates<'_, Row>) + Send + Sync + 'static,
) -> Result<(), RunError> {
    run(|fields| {
        rate_stage("misusing", &[fields.rate.id()], move |near, rates, _| {
            if near.id() == 2 {
                rate(fields, near, rates);
            }
            Ok(())
        })
    })
}

/// Sub-domain 2 does what `update` does.
fn in_update(
    update: impl Fn(Fields, &mut Own<'_, Row>) + Send + Sync + 'static,
) -> Result<(), RunError> {
    run(|fields| {
        update_stage("misusing", move |own, _| {
            if own.id() == 2 {
                update(fields, own);
            }
            Ok(())
        })
    })
}

#[track_caller]
fn assert_refused(outcome: Result<(), RunError>, why: &str) {
    let error = outcome.expect_err("it must be refused");
    assert!(matches!(error.cause, Cause::Panic(_)), "{error}");
    assert_eq!((error.stage.as_str(), error.sub_domain), ("misusing", Some(2)));
    assert!(error.to_string().contains(why), "{error}");
}

fn span(start: usize, end: usize) -> Span {
    Span { start, end }
}

#[test]
fn what_is_allowed() {
    in_rate(|f, near, rates| {
        let (state, before) = (near.state(f.state), near.rate(f.unlisted));
        for (owner, span) in [(1, span(3, 5)), (1, span(5, 6)), (2, span(7, 8)), (3, span(9, 9))] {
            let reach = near.reach(owner, span);
            assert_eq!(state.at(reach).len(), reach.span().len());
            assert_eq!(before.at(reach).len(), near.state(f.other).at(reach).len());
        }
        assert_eq!(state.own().span(0).len(), 2);
        rates.column(f.rate).span(1).fill(1.0);
    })
    .unwrap();
    in_update(|f, own| {
        let (rate, unlisted) = (own.rate(f.rate), own.rate(f.unlisted));
        assert_eq!(rate.span(0).len() + unlisted.span(1).len(), 3);
        let (mut state, other) = (own.state_mut(f.state), own.state(f.other));
        state.span(0)[1] = f64::from(other.span(0)[1]);
    })
    .unwrap();
}

#[test]
fn reading_past_the_neighbours() {
    for owner in [0, 4] {
        let start = 3 * owner;
        let outcome = in_rate(move |_, near, _| {
            near.reach(owner, span(start, start + 1));
        });
        assert_refused(outcome, &format!("reads sub-domain {owner}, which is not its neighbour"));
    }
    for owner in [5, usize::MAX, u32::MAX as usize + 2] {
        let outcome = in_rate(move |_, near, _| {
            near.reach(owner, span(3, 4));
        });
        assert_refused(outcome, "which is not its neighbour");
    }
}

#[test]
fn reading_points_that_the_neighbour_does_not_own() {
    let spans = [(1, 2, 5), (1, 3, 6), (1, 5, 7), (3, 8, 10), (3, 14, 15), (2, 9, 10), (2, 5, 7)];
    let backwards = [(1, 5, 3), (1, usize::MAX, 4), (2, 8, 6)];
    for (owner, start, end) in spans.into_iter().chain(backwards) {
        let outcome = in_rate(move |_, near, _| {
            near.reach(owner, span(start, end));
        });
        assert_refused(outcome, &format!("which sub-domain {owner} does not own"));
    }
}

#[test]
fn reading_what_the_stage_itself_writes() {
    let outcome = in_rate(|f, near, _| {
        near.rate(f.rate);
    });
    assert_refused(outcome, "written by the stage that reads it");
}

#[test]
fn writing_what_the_stage_does_not_list() {
    let outcome = in_rate(|f, _, rates| {
        rates.column(f.unlisted);
    });
    assert_refused(
        outcome,
        "column \"unlisted\" is written but not listed in the stage's `writes`",
    );
}

#[test]
fn taking_a_column_twice() {
    let outcome = in_rate(|f, _, rates| {
        let _first = rates.column(f.rate);
        rates.column(f.rate);
    });
    assert_refused(outcome, "already borrowed");
    let twice: [fn(Fields, &mut Own<'_, Row>); 3] = [
        |f, own| {
            let _first = own.state_mut(f.state);
            own.state_mut(f.state);
        },
        |f, own| {
            let _first = own.state_mut(f.state);
            own.state(f.state);
        },
        |f, own| {
            let _first = own.state(f.state);
            own.state_mut(f.state);
        },
    ];
    for twice in twice {
        assert_refused(in_update(twice), "already borrowed");
    }
}

/// Handles of other columns name nothing here, or something of another type.
#[test]
fn handles_of_other_columns() {
    let mut foreign = Columns::new(15);
    let [_, wrong_type, ..] = ["a", "b", "c", "d"].map(|name| foreign.state::<f64>(name));
    let missing = foreign.state::<f64>("e");
    let missing_rate = foreign.rate::<f64>("f");
    for handle in [wrong_type, missing] {
        let outcome = in_rate(move |_, near, _| {
            near.state(handle);
        });
        assert_refused(outcome, "belongs to other columns");
        let outcome = in_update(move |_, own| {
            own.state(handle);
        });
        assert_refused(outcome, "belongs to other columns");
        let outcome = in_update(move |_, own| {
            own.state_mut(handle);
        });
        assert_refused(outcome, "belongs to other columns");
    }
    let outcome = in_update(move |_, own| {
        own.rate(missing_rate);
    });
    assert_refused(outcome, "belongs to other columns");
    let outcome = run(|_| {
        rate_stage("misusing", &[missing_rate.id()], move |near, rates, _| {
            if near.id() == 2 {
                rates.column(missing_rate);
            }
            Ok(())
        })
    });
    assert_refused(outcome, "belongs to other columns");
}

/// A reach that was checked in one division of space is not good for another one, not even for
/// the sub-domain of the same number.
#[test]
fn a_reach_of_another_domain() {
    let whole_row = |points: usize| {
        let mut columns = Columns::new(points);
        let state = columns.state::<f64>("state");
        let domain = space::Independent::with_share(points, points);
        let model = Model::with_fixed_dt("other", domain, columns, Step::builder().build(), 1.0);
        (Simulation::new(model, Settings::default()).unwrap(), state)
    };
    let (mut small, state) = whole_row(1);
    small.whole().sum(|near_small| {
        let (mut large, _) = whole_row(1000);
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            large.whole().sum(|near_large| {
                let reach = near_large.reach(0, span(500, 1000));
                [near_small.state(state).at(reach).len() as f64]
            })
        }));
        assert!(outcome.is_err(), "{outcome:?} values out of 1");
        [0.0]
    });
}

#[test]
fn swapping_a_column_with_itself() {
    let mut columns = Columns::new(15);
    let rate = columns.rate::<f64>("rate");
    let outcome = std::panic::catch_unwind(|| Step::<Row>::builder().swap_rates(rate, rate));
    assert!(outcome.is_err());
}

/// The memory of one would be too short for the other.
#[test]
fn swapping_columns_of_other_types() {
    let mut foreign = Columns::new(15);
    let (f64_state, f64_rate) = (foreign.state::<f64>("a"), foreign.rate::<f64>("b"));
    let mut columns = Columns::new(15);
    columns.state::<f64>("a");
    columns.rate::<f32>("b");
    let step = Step::builder().swap(f64_state, f64_rate).build();
    let model = Model::with_fixed_dt("misuse", Row::new(), columns, step, 1.0);
    let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        Simulation::new(model, Settings::default()).map(|mut s| s.advance(1))
    }));
    assert!(outcome.is_err());
}

#[test]
fn notes_borrowed_twice_or_of_other_columns() {
    in_rate(|f, _, rates| {
        rates.notes(f.notes).push(1);
        assert_eq!(*rates.notes(f.notes), [1]);
    })
    .unwrap();
    let outcome = in_rate(|f, _, rates| {
        let (mut first, mut second) = (rates.notes(f.notes), rates.notes(f.notes));
        first.append(&mut second);
    });
    assert_refused(outcome, "the notes of sub-domain 2 are already borrowed");
    let outcome = in_rate(|f, _, rates| {
        rates.notes(f.foreign_notes).push(1);
    });
    assert_refused(outcome, "notes belong to other columns");
}
