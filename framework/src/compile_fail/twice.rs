//! Having the same points twice, once to write.

refused_in_rate!(
    two_spans_to_be_written,
    "E0499",
    "let mut part = rates.column(self.rate);
    let first = part.span(0);",
    "let second = part.span(1); second[0] = 2.0;
    first[0] = 1.0;"
);

refused_in_rate!(
    a_span_after_the_whole,
    "E0382",
    "let mut part = rates.column(self.rate);
    let whole = part.whole();
    whole[0] = 1.0;",
    "part.span(0)[0] = 2.0;"
);

refused_in_rate!(
    a_copy_of_a_part_to_be_written,
    "E0599",
    "let part = rates.column(self.rate);",
    "let copy = part.clone();"
);
