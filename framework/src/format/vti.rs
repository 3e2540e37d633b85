use std::io::Write;
use std::path::Path;

use super::document::Document;
use super::{Array, FormatError, xml};

/// A regular grid with fields, to be written as VTK image data.
#[derive(Debug, Clone, Copy)]
pub struct Vti<'a> {
    /// Points along x, y and z, each at least 1; x runs fastest in the fields.
    pub dimensions: [usize; 3],
    /// Position of the first point, in the units of the scene.
    pub origin: [f64; 3],
    /// Distance between neighbouring points along x, y and z, positive, also where there is only
    /// one point.
    pub spacing: [f64; 3],
    /// Fields with a value for each point, of different names.
    pub point_data: &'a [Array<'a>],
    /// Time of the fields, which viewers show.
    pub time: Option<f64>,
}

impl<'a> Vti<'a> {
    /// Writes the file to `out`; everything is checked before the first byte is written.
    ///
    /// # Errors
    /// If an array or the grid is not what this file needs (the error names it), or if `out` fails.
    pub fn write(&self, out: &mut impl Write) -> Result<(), FormatError> {
        Ok(self.document()?.write(out)?)
    }

    /// Writes the file `path`, replacing an older one at once.
    ///
    /// # Errors
    /// If an array or the grid is not what this file needs (the error names it), or if the file
    /// cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), FormatError> {
        self.document()?.save(path.as_ref())
    }

    fn document(&self) -> Result<Document<'a>, FormatError> {
        for spacing in self.spacing {
            require("spacing", spacing, spacing > 0.0, "positive")?;
        }
        for points in self.dimensions {
            require("dimensions", points as f64, points > 0, "at least 1")?;
        }
        let count =
            self.dimensions.iter().try_fold(1, |count: usize, points| count.checked_mul(*points));
        let count = count.ok_or(FormatError::Value {
            key: "dimensions",
            value: self.dimensions.iter().map(|points| *points as f64).product(),
            must: "a number of points that memory can hold",
        })?;
        let [x, y, z] = self.dimensions.map(|points| points - 1);
        let extent = format!("0 {x} 0 {y} 0 {z}");
        let origin = triple("origin", self.origin)?;
        let spacing = triple("spacing", self.spacing)?;
        let attributes =
            format!(" WholeExtent=\"{extent}\" Origin=\"{origin}\" Spacing=\"{spacing}\"");
        let mut file = Document::new("ImageData", &attributes, self.time)?;
        file.line(&format!("<Piece Extent=\"{extent}\">"));
        file.point_data(self.point_data, count)?;
        file.line("</Piece>");
        Ok(file)
    }
}

fn require(
    key: &'static str,
    value: f64,
    holds: bool,
    must: &'static str,
) -> Result<(), FormatError> {
    holds.then_some(()).ok_or(FormatError::Value { key, value, must })
}

fn triple(key: &'static str, numbers: [f64; 3]) -> Result<String, FormatError> {
    let [x, y, z] = numbers.map(|number| xml::number(key, number));
    Ok(format!("{} {} {}", x?, y?, z?))
}
