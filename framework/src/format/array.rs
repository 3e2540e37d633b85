use std::io::{self, Write};

use super::values::write_tuples;
use super::{Element, FormatError, Kind, Values};

/// A named field: one number or one 3-vector for each point, borrowed.
#[derive(Debug, Clone, Copy)]
pub struct Array<'a> {
    name: &'a str,
    layout: Layout<'a>,
}

#[derive(Debug, Clone, Copy)]
enum Layout<'a> {
    Scalar(Values<'a>),
    Interleaved(Values<'a>),
    Split([Values<'a>; 3]),
    Plane([Values<'a>; 2]),
    Line(Values<'a>),
}

impl<'a> Array<'a> {
    /// A number for each point.
    pub fn scalar(name: &'a str, values: impl Into<Values<'a>>) -> Self {
        let layout = Layout::Scalar(values.into());
        Self { name, layout }
    }

    /// A vector for each point, stored as `x0 y0 z0 x1 y1 z1 ...`.
    pub fn vector(name: &'a str, values: impl Into<Values<'a>>) -> Self {
        let layout = Layout::Interleaved(values.into());
        Self { name, layout }
    }

    /// A vector for each point, whose components x, y, z are stored apart.
    pub fn split<T: Into<Values<'a>>>(name: &'a str, components: [T; 3]) -> Self {
        let layout = Layout::Split(components.map(Into::into));
        Self { name, layout }
    }

    /// A vector in the plane for each point, whose components x, y are stored apart; the file gets
    /// z = 0, for its vectors have three components.
    pub fn plane<T: Into<Values<'a>>>(name: &'a str, components: [T; 2]) -> Self {
        let layout = Layout::Plane(components.map(Into::into));
        Self { name, layout }
    }

    /// A vector along x for each point; the file gets y = z = 0.
    pub fn line(name: &'a str, values: impl Into<Values<'a>>) -> Self {
        let layout = Layout::Line(values.into());
        Self { name, layout }
    }

    /// The name in the file.
    pub fn name(&self) -> &'a str {
        self.name
    }

    /// Numbers for each point in the file, 1 or 3.
    pub fn components(&self) -> usize {
        match self.layout {
            Layout::Scalar(_) => 1,
            Layout::Interleaved(_) | Layout::Split(_) | Layout::Plane(_) | Layout::Line(_) => 3,
        }
    }

    pub(super) fn kind(&self) -> Kind {
        self.columns()[0].kind()
    }

    /// How many points the array has values for.
    ///
    /// # Errors
    /// If the components disagree about it, or about the kind of numbers.
    pub(super) fn points(&self) -> Result<usize, FormatError> {
        let columns = self.columns();
        let first = columns[0];
        for column in &columns[1..] {
            if column.kind() != first.kind() {
                return Err(FormatError::Kind {
                    array: self.name.to_string(),
                    first: first.kind(),
                    other: column.kind(),
                });
            }
            if column.len() != first.len() {
                return Err(FormatError::Length {
                    array: self.name.to_string(),
                    expected: first.len(),
                    found: column.len(),
                });
            }
        }
        match self.layout {
            Layout::Interleaved(values) if values.len() % 3 != 0 => {
                Err(FormatError::Triples { array: self.name.to_string(), found: values.len() })
            }
            Layout::Interleaved(values) => Ok(values.len() / 3),
            _ => Ok(first.len()),
        }
    }

    /// Bytes that [`Array::write_le`] writes.
    pub(super) fn bytes(&self) -> usize {
        let columns = self.columns();
        let width = match self.layout {
            Layout::Scalar(_) | Layout::Interleaved(_) => 1,
            Layout::Split(_) | Layout::Plane(_) | Layout::Line(_) => 3,
        };
        columns[0].len() * width * columns[0].kind().size()
    }

    /// Writes the values point by point; the array has passed [`Array::points`].
    pub(super) fn write_le(&self, out: &mut impl Write) -> io::Result<()> {
        match self.layout {
            Layout::Scalar(values) | Layout::Interleaved(values) => values.write_le(out),
            Layout::Split(_) | Layout::Plane(_) | Layout::Line(_) => match self.kind() {
                Kind::F32 => self.write_apart::<f32>(out),
                Kind::F64 => self.write_apart::<f64>(out),
                Kind::U8 => self.write_apart::<u8>(out),
                Kind::U32 => self.write_apart::<u32>(out),
                Kind::U64 => self.write_apart::<u64>(out),
            },
        }
    }

    fn write_apart<T: Element>(&self, out: &mut impl Write) -> io::Result<()> {
        let columns: Vec<&[T]> = self.columns().iter().filter_map(T::slice).collect();
        write_tuples(out, &columns, 3)
    }

    fn columns(&self) -> &[Values<'a>] {
        match &self.layout {
            Layout::Scalar(values) | Layout::Interleaved(values) | Layout::Line(values) => {
                std::slice::from_ref(values)
            }
            Layout::Split(components) => components,
            Layout::Plane(components) => components,
        }
    }
}
