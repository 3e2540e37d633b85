use std::collections::HashSet;
use std::io::{self, Read, Write};
use std::path::Path;

use super::{Array, AtomicFile, FormatError, Values, xml};

/// A VTK file in the making: XML that describes the arrays, and behind it their raw bytes. The XML
/// is gathered first, so that everything is checked before a byte is written.
pub(super) struct Document<'a> {
    dataset: &'static str,
    xml: String,
    blocks: Vec<Block<'a>>,
    /// Where the next block begins behind the mark of the raw bytes.
    offset: u64,
}

/// The raw bytes of one array.
pub(super) enum Block<'a> {
    /// The values of an array.
    Array(Array<'a>),
    /// `count` whole numbers of 8 bytes from `first` upwards.
    Counting { first: u64, count: usize },
    /// `count` times the same byte.
    Constant { value: u8, count: usize },
}

impl Block<'_> {
    fn bytes(&self) -> u64 {
        let bytes = match self {
            Self::Array(array) => array.bytes(),
            Self::Counting { count, .. } => count * size_of::<u64>(),
            Self::Constant { count, .. } => *count,
        };
        bytes as u64
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        match *self {
            Self::Array(array) => array.write_le(out),
            Self::Counting { first, count } => write_counting(out, first, count),
            Self::Constant { value, count } => {
                io::copy(&mut io::repeat(value).take(count as u64), out).map(drop)
            }
        }
    }
}

fn write_counting(out: &mut impl Write, first: u64, count: usize) -> io::Result<()> {
    const AT_ONCE: usize = 1024;
    let mut numbers: [u64; AT_ONCE] = std::array::from_fn(|n| first + n as u64);
    for start in (0..count).step_by(AT_ONCE) {
        let some = &numbers[..AT_ONCE.min(count - start)];
        Values::from(some).write_le(out)?;
        numbers.iter_mut().for_each(|number| *number += AT_ONCE as u64);
    }
    Ok(())
}

impl<'a> Document<'a> {
    /// Begins a file that holds one `dataset`, whose opening tag has `attributes`.
    pub(super) fn new(
        dataset: &'static str,
        attributes: &str,
        time: Option<f64>,
    ) -> Result<Self, FormatError> {
        let mut xml = format!(
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"{dataset}\" version=\"1.0\" \
             byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<{dataset}{attributes}>\n"
        );
        if let Some(time) = time {
            let time = xml::number("time", time)?;
            xml += &format!(
                "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" \
                 NumberOfTuples=\"1\" format=\"ascii\">{time}</DataArray>\n</FieldData>\n"
            );
        }
        Ok(Self { dataset, xml, blocks: Vec::new(), offset: 0 })
    }

    /// Appends a line of XML.
    pub(super) fn line(&mut self, line: &str) {
        self.xml += line;
        self.xml.push('\n');
    }

    /// Appends the fields of `points` points.
    pub(super) fn point_data(
        &mut self,
        arrays: &[Array<'a>],
        points: usize,
    ) -> Result<(), FormatError> {
        let mut names = HashSet::new();
        self.line("<PointData>");
        for array in arrays {
            if !names.insert(array.name()) {
                return Err(FormatError::SameName { array: array.name().to_string() });
            }
            self.array(*array, points)?;
        }
        self.line("</PointData>");
        Ok(())
    }

    /// Appends an array with values for `points` points.
    pub(super) fn array(&mut self, array: Array<'a>, points: usize) -> Result<(), FormatError> {
        let found = array.points()?;
        if found != points {
            return Err(FormatError::Length {
                array: array.name().to_string(),
                expected: points,
                found,
            });
        }
        let name = xml::attribute(array.name())?;
        let (kind, components) = (array.kind().vtk_name(), array.components());
        self.block(kind, &name, components, Block::Array(array));
        Ok(())
    }

    /// Appends a block of numbers which VTK calls `kind`; `name` is free of special characters.
    pub(super) fn block(&mut self, kind: &str, name: &str, components: usize, block: Block<'a>) {
        let offset = self.offset;
        // Said of vectors only: some readers make a table of one column of what says 1.
        let width = match components {
            1 => String::new(),
            _ => format!("NumberOfComponents=\"{components}\" "),
        };
        self.line(&format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" {width}format=\"appended\" \
             offset=\"{offset}\"/>"
        ));
        self.offset += size_of::<u64>() as u64 + block.bytes();
        self.blocks.push(block);
    }

    /// Writes the whole file.
    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        out.write_all(self.xml.as_bytes())?;
        let dataset = self.dataset;
        write!(out, "</{dataset}>\n<AppendedData encoding=\"raw\">\n_")?;
        for block in &self.blocks {
            out.write_all(&block.bytes().to_le_bytes())?;
            block.write(out)?;
        }
        out.write_all(b"\n</AppendedData>\n</VTKFile>\n")?;
        out.flush()
    }

    /// Writes the file to `path`, at once.
    pub(super) fn save(&self, path: &Path) -> Result<(), FormatError> {
        save(path, |file| self.write(file))
    }
}

/// Lets `write` fill the file `path`, which replaces any file of this name at once.
pub(super) fn save(
    path: &Path,
    write: impl FnOnce(&mut AtomicFile) -> io::Result<()>,
) -> Result<(), FormatError> {
    AtomicFile::create(path)
        .and_then(|mut file| {
            write(&mut file)?;
            file.commit()
        })
        .map_err(|source| FormatError::File { path: path.to_path_buf(), source })
}
