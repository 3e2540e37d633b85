//! Keeping parts beyond the call, when others write them.

refused_in_rate!(
    what_is_read_in_scratch,
    "E0521",
    "let values = near.state(self.state).own().whole();",
    "scratch.slice.replace(values);"
);

refused_in_rate!(
    what_is_written_in_scratch,
    "E0521",
    "let values = rates.column(self.rate).whole();",
    "scratch.slice_mut.replace(values);"
);

refused_in_rate!(
    what_is_read_in_the_stage,
    "E0521",
    "let values = near.state(self.state).own().whole();",
    "*self.kept.lock().unwrap() = Some(values);"
);

refused_in_rate!(
    a_neighbours_part_in_scratch,
    "E0521",
    "let values = near.state(self.state).at(near.reach(1, Span { start: 0, end: 1 }));",
    "scratch.slice.replace(values);"
);

refused_in_rate!(
    a_thread_that_outlives_the_call,
    "E0521",
    "let near = *near;",
    "std::thread::spawn(move || near.id());"
);

refused!(
    what_a_reduction_sees,
    "E0521",
    "use finegrain_framework::{space::Independent, *};
    static KEPT: std::sync::Mutex<Vec<&'static [f64]>> = std::sync::Mutex::new(Vec::new());
    fn sum(whole: &mut Whole<'_, Independent>, state: State<f64>) {
        whole.sum(|near| {
            let values = near.state(state).own().whole();",
    "KEPT.lock().unwrap().push(values);",
    "[values[0]] });
    }"
);
