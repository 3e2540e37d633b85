//! What a dump shows.

use super::Every;

/// A series of files for viewing, each with the same fields; made with [`Dump::new`].
#[derive(Clone, Debug)]
#[must_use]
pub struct Dump {
    pub(super) name: String,
    pub(super) every: Every,
    /// Whether the state at the end of a run is shown too.
    pub(super) has_last: bool,
    pub(super) fields: Vec<Field>,
}

/// A field of a dump.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub name: String,
    /// Names of the columns that hold its components; one for a scalar.
    pub columns: Vec<String>,
    pub is_vector: bool,
}

impl Dump {
    /// A series called `name`, which begins its files' names, of no fields.
    pub fn new(name: impl Into<String>, every: Every) -> Self {
        Self { name: name.into(), every, has_last: false, fields: Vec::new() }
    }

    /// Shows the state at the end of the run too, however it comes to an end in order. (A run that is
    /// stopped and restarted then has a file more than one that was not.)
    pub fn and_last(mut self) -> Self {
        self.has_last = true;
        self
    }

    /// Shows the column `name`.
    pub fn scalar(self, name: &str) -> Self {
        let columns = vec![name.to_owned()];
        self.field(Field { name: name.to_owned(), columns, is_vector: false })
    }

    /// Shows columns as the components x, y, z of a vector called `name`; the file gets zeros for
    /// components that are not given. They must be of one element type.
    pub fn vector<'a>(self, name: &str, columns: impl IntoIterator<Item = &'a str>) -> Self {
        let columns = columns.into_iter().map(str::to_owned).collect();
        self.field(Field { name: name.to_owned(), columns, is_vector: true })
    }

    fn field(mut self, field: Field) -> Self {
        self.fields.push(field);
        self
    }
}
