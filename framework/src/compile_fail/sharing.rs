//! Sharing among threads what only one may have.

refused_in_rate!(
    a_part_to_be_written_with_a_thread,
    "E0277",
    "let mut part = rates.column(self.rate);
    let mut first = || part.span(0)[0] = 1.0;",
    "std::thread::scope(|scope| { scope.spawn(&mut first); });"
);

refused_in_update!(
    own_state_with_two_threads,
    "E0524",
    "let first = || own.state_mut(self.state).whole()[0] = 1.0;",
    "let second = || own.state_mut(self.state).whole()[0] = 2.0;
    rayon::join(first, second);"
);

refused!(
    a_counter_among_the_team,
    "E0594",
    "let mut team = finegrain_framework::Team::new(2).unwrap();
    let mut count = 0;",
    "team.for_each(10, 1, |_| count += 1);",
    "count += 1; assert_eq!(count, 1);"
);

refused!(
    a_counter_among_the_sub_domains,
    "E0594",
    "use finegrain_framework::{space::Independent, *};
    fn count(whole: &mut Whole<'_, Independent>) -> f64 {
        let mut count = 0.0;
        let [sum] = whole.sum(|near| {",
    "count += 1.0;",
    "[1.0] });
        count += sum;
        count
    }"
);
