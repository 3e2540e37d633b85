use std::io::Write;
use std::path::Path;

use super::document::{Block, Document};
use super::{Array, FormatError, Kind};

/// Number of the cell type "one vertex" in VTK.
const VTK_VERTEX: u8 = 1;

/// Points with fields, to be written as a VTK unstructured grid in which every point is a vertex.
#[derive(Debug, Clone, Copy)]
pub struct Vtu<'a> {
    /// Positions: vectors of `f32` or `f64`, in the units of the scene.
    pub points: Array<'a>,
    /// Fields with a value for each point, of different names.
    pub point_data: &'a [Array<'a>],
    /// Time of the fields, which viewers show.
    pub time: Option<f64>,
}

impl<'a> Vtu<'a> {
    /// Writes the file to `out`; everything is checked before the first byte is written.
    ///
    /// # Errors
    /// If an array is not what this file needs (the error names it), or if `out` fails.
    pub fn write(&self, out: &mut impl Write) -> Result<(), FormatError> {
        Ok(self.document()?.write(out)?)
    }

    /// Writes the file `path`, replacing an older one at once.
    ///
    /// # Errors
    /// If an array is not what this file needs (the error names it), or if the file cannot be
    /// written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), FormatError> {
        self.document()?.save(path.as_ref())
    }

    fn document(&self) -> Result<Document<'a>, FormatError> {
        let points = self.points;
        if points.components() != 3 || !matches!(points.kind(), Kind::F32 | Kind::F64) {
            return Err(FormatError::Positions {
                array: points.name().to_string(),
                components: points.components(),
                kind: points.kind(),
            });
        }
        let count = points.points()?;
        let mut file = Document::new("UnstructuredGrid", "", self.time)?;
        file.line(&format!("<Piece NumberOfPoints=\"{count}\" NumberOfCells=\"{count}\">"));
        file.point_data(self.point_data, count)?;
        file.line("<Points>");
        file.array(points, count)?;
        file.line("</Points>\n<Cells>");
        // Cell i has the one point i, and ends before place i + 1 in the list of cells' points.
        let connectivity = Block::Counting { first: 0, count };
        let offsets = Block::Counting { first: 1, count };
        let value = VTK_VERTEX;
        file.block("Int64", "connectivity", 1, connectivity);
        file.block("Int64", "offsets", 1, offsets);
        file.block("UInt8", "types", 1, Block::Constant { value, count });
        file.line("</Cells>\n</Piece>");
        Ok(file)
    }
}
