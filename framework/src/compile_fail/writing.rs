//! Writing what belongs to others.

// One's own state is read only in a rate stage: neighbours read it now.
refused_in_rate!(
    own_state_in_a_rate_stage,
    "E0594",
    "let values = near.state(self.state).own().whole();",
    "values[0] = 1.0;"
);

refused_in_rate!(
    a_neighbours_state,
    "E0594",
    "let values = near.state(self.state).at(near.reach(1, Span { start: 0, end: 1 }));",
    "values[0] = 1.0;"
);

// Only an update stage can have state to write.
refused_in_rate!(
    state_mut_in_a_rate_stage,
    "E0599",
    "let part = near.state(self.state).own();",
    "let part = near.state_mut(self.state);"
);

// A state column is not a rate column.
refused_in_rate!(
    a_state_column_among_the_rates,
    "E0308",
    "let part = rates.column(self.rate);",
    "let part = rates.column(self.state);"
);

refused_in_update!(
    rates_in_an_update_stage,
    "E0594",
    "let values = own.rate(self.rate).whole();",
    "values[0] = 1.0;"
);

refused_in_update!(
    a_rate_column_as_state,
    "E0308",
    "let values = own.state_mut(self.state).whole();",
    "let values = own.state_mut(self.rate).whole();"
);

// An update stage knows no neighbours.
refused_in_update!(
    neighbours_in_an_update_stage,
    "E0599",
    "let values = own.state(self.state).whole();",
    "let reach = own.reach(1, Span { start: 0, end: 1 });"
);

// The division of space cannot be changed while stages run.
refused_in_rate!(
    the_division_of_space,
    "E0596",
    "let partition = near.domain().partition();",
    "partition.clear(0);"
);
