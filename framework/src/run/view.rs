//! How a snapshot of a series is shown: which copies are positions, scalars and vectors.

use std::path::Path;

use super::dump::Field;
use super::snapshot::Snapshot;
use super::{Dump, RunFailure};
use crate::columns::{ColumnId, Columns};
use crate::format::{Array, FormatError, Vti, Vtu};
use crate::viewable::Geometry;

/// A dump, its columns found.
#[derive(Clone, Debug)]
pub(super) struct View {
    name: String,
    geometry: Geometry,
    /// The columns that a snapshot must copy.
    columns: Vec<ColumnId>,
    /// Places in `columns` of the coordinates; none for an image.
    positions: Vec<usize>,
    fields: Vec<(Field, Vec<usize>)>,
}

impl View {
    /// Finds the columns of `dump`.
    pub fn new(dump: &Dump, geometry: Geometry, columns: &Columns) -> Result<Self, RunFailure> {
        let mut needed = Vec::new();
        let mut place = |id: ColumnId| {
            needed.iter().position(|&known| known == id).unwrap_or_else(|| {
                needed.push(id);
                needed.len() - 1
            })
        };
        let positions = match &geometry {
            Geometry::Points(ids) => ids.iter().map(|&id| place(id)).collect(),
            Geometry::Image { .. } => Vec::new(),
        };
        let mut fields = Vec::new();
        for field in &dump.fields {
            if !(1..=3).contains(&field.columns.len()) {
                return Err(RunFailure::Value {
                    key: format!(
                        "number of components of `{}` in dump `{}`",
                        field.name, dump.name
                    ),
                    value: field.columns.len().to_string(),
                    must: "1 to 3",
                });
            }
            let mut places = Vec::new();
            for column in &field.columns {
                let found = columns.iter().find(|(_, c)| c.name() == column);
                let (id, _) = found.ok_or_else(|| unknown(dump, column, columns))?;
                places.push(place(id));
            }
            fields.push((field.clone(), places));
        }
        Ok(Self { name: dump.name.clone(), geometry, columns: needed, positions, fields })
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub fn columns(&self) -> &[ColumnId] {
        &self.columns
    }

    /// Ending of the files' names.
    pub fn extension(&self) -> &'static str {
        match self.geometry {
            Geometry::Points(_) => "vtu",
            Geometry::Image { .. } => "vti",
        }
    }

    /// Writes a snapshot of [`View::columns`] to the file `path`.
    pub fn save(&self, path: &Path, snapshot: &Snapshot) -> Result<(), FormatError> {
        let fields: Vec<_> = self
            .fields
            .iter()
            .map(|(field, places)| match field.is_vector {
                false => Array::scalar(&field.name, snapshot.values(places[0])),
                true => vector(&field.name, places, snapshot),
            })
            .collect();
        let time = Some(snapshot.time);
        match self.geometry {
            Geometry::Points(_) => {
                let points = vector("position", &self.positions, snapshot);
                Vtu { points, point_data: &fields, time }.save(path)
            }
            Geometry::Image { shape: dimensions, origin, spacing } => {
                Vti { dimensions, origin, spacing, point_data: &fields, time }.save(path)
            }
        }
    }
}

fn vector<'a>(name: &'a str, places: &[usize], snapshot: &'a Snapshot) -> Array<'a> {
    match *places {
        [x] => Array::line(name, snapshot.values(x)),
        [x, y] => Array::plane(name, [x, y].map(|place| snapshot.values(place))),
        [x, y, z] => Array::split(name, [x, y, z].map(|place| snapshot.values(place))),
        _ => unreachable!("1 to 3 components were asked for"),
    }
}

fn unknown(dump: &Dump, column: &str, columns: &Columns) -> RunFailure {
    let known: Vec<_> = columns.iter().map(|(_, column)| column.name()).collect();
    RunFailure::Column {
        dump: dump.name.clone(),
        column: column.to_owned(),
        known: known.join(", "),
    }
}
