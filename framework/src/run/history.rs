//! The history of a monitor.

use std::fmt::Write;

/// Rows of numbers, each of one step.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    name: String,
    columns: Vec<String>,
    steps: Vec<u64>,
    times: Vec<f64>,
    /// Row after row.
    values: Vec<f64>,
}

impl History {
    pub(super) fn new(name: String, columns: Vec<String>) -> Self {
        Self { name, columns, steps: Vec::new(), times: Vec::new(), values: Vec::new() }
    }

    /// The monitor's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Names of its columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.steps.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// Number of steps done when each row was taken.
    pub fn steps(&self) -> &[u64] {
        &self.steps
    }

    /// Time of each row.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// One row: a value for each column.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, row: usize) -> &[f64] {
        let width = self.columns.len();
        &self.values[row * width..(row + 1) * width]
    }

    /// The last row, if there is any.
    pub fn last(&self) -> Option<&[f64]> {
        self.len().checked_sub(1).map(|row| self.row(row))
    }

    /// The values of one column, row by row; `None` if there is no such column.
    pub fn column(&self, name: &str) -> Option<impl Iterator<Item = f64> + '_> {
        let place = self.columns.iter().position(|column| column == name)?;
        Some((0..self.len()).map(move |row| self.row(row)[place]))
    }

    /// All values, row after row.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(super) fn push(&mut self, step: u64, time: f64, values: &[f64]) {
        debug_assert_eq!(values.len(), self.columns.len());
        self.steps.push(step);
        self.times.push(time);
        self.values.extend_from_slice(values);
    }

    /// Replaces all rows; false, and nothing done, if the numbers do not make whole rows.
    pub(super) fn set_rows(&mut self, steps: Vec<u64>, times: Vec<f64>, values: Vec<f64>) -> bool {
        let fits = times.len() == steps.len() && values.len() == steps.len() * self.columns.len();
        if fits {
            (self.steps, self.times, self.values) = (steps, times, values);
        }
        fits
    }

    /// First line of the file.
    pub(super) fn csv_head(&self) -> String {
        let mut line = "time,step".to_owned();
        for column in &self.columns {
            line.push(',');
            line.push_str(column);
        }
        line.push('\n');
        line
    }

    /// Appends the line of a row to `text`, in as many digits as tell the number from all others.
    pub(super) fn csv_row(&self, row: usize, text: &mut String) {
        // Writing to a string cannot fail.
        let _ = write!(text, "{:?},{}", self.times[row], self.steps[row]);
        for value in self.row(row) {
            let _ = write!(text, ",{value:?}");
        }
        text.push('\n');
    }
}
