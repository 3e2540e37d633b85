use std::fmt;
use std::io::{self, Write};

use serde::{Deserialize, Serialize};

/// Type of the numbers in a file; all are written little-endian.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Kind {
    /// 4-byte floating point.
    F32,
    /// 8-byte floating point.
    F64,
    /// 1-byte unsigned.
    U8,
    /// 4-byte unsigned.
    U32,
    /// 8-byte unsigned.
    U64,
}

impl Kind {
    /// Bytes of one number.
    pub const fn size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::F32 | Self::U32 => 4,
            Self::F64 | Self::U64 => 8,
        }
    }

    /// What VTK calls it.
    pub(super) const fn vtk_name(self) -> &'static str {
        match self {
            Self::F32 => "Float32",
            Self::F64 => "Float64",
            Self::U8 => "UInt8",
            Self::U32 => "UInt32",
            Self::U64 => "UInt64",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::U8 => "u8",
            Self::U32 => "u32",
            Self::U64 => "u64",
        })
    }
}

/// Borrowed numbers of one of the kinds that files hold.
#[derive(Debug, Clone, Copy)]
pub enum Values<'a> {
    /// See [`Kind::F32`].
    F32(&'a [f32]),
    /// See [`Kind::F64`].
    F64(&'a [f64]),
    /// See [`Kind::U8`].
    U8(&'a [u8]),
    /// See [`Kind::U32`].
    U32(&'a [u32]),
    /// See [`Kind::U64`].
    U64(&'a [u64]),
}

impl Values<'_> {
    /// Type of the numbers.
    pub fn kind(&self) -> Kind {
        match self {
            Self::F32(_) => Kind::F32,
            Self::F64(_) => Kind::F64,
            Self::U8(_) => Kind::U8,
            Self::U32(_) => Kind::U32,
            Self::U64(_) => Kind::U64,
        }
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::F64(values) => values.len(),
            Self::U8(values) => values.len(),
            Self::U32(values) => values.len(),
            Self::U64(values) => values.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Place of the first number that is none, infinite or farther than `most` from zero.
    pub fn first_beyond(&self, most: f64) -> Option<usize> {
        match self {
            Self::F32(values) => values.iter().position(|&x| !is_within(f64::from(x), most)),
            Self::F64(values) => values.iter().position(|&x| !is_within(x, most)),
            Self::U8(_) | Self::U32(_) | Self::U64(_) => None,
        }
    }

    /// Writes the numbers, little-endian.
    ///
    /// # Errors
    /// What `out` says.
    pub fn write_le(&self, out: &mut impl Write) -> io::Result<()> {
        match *self {
            Self::F32(values) => write_tuples(out, &[values], 1),
            Self::F64(values) => write_tuples(out, &[values], 1),
            Self::U8(values) => write_tuples(out, &[values], 1),
            Self::U32(values) => write_tuples(out, &[values], 1),
            Self::U64(values) => write_tuples(out, &[values], 1),
        }
    }
}

fn is_within(x: f64, most: f64) -> bool {
    x.abs() <= most.min(f64::MAX)
}

impl<'a, T: Element> From<&'a [T]> for Values<'a> {
    fn from(values: &'a [T]) -> Self {
        T::values(values)
    }
}

impl<'a, T: Element> From<&'a Vec<T>> for Values<'a> {
    fn from(values: &'a Vec<T>) -> Self {
        T::values(values)
    }
}

/// A number that files hold: `f32`, `f64`, `u8`, `u32` or `u64`.
pub trait Element: Copy + Default + sealed::Sealed {
    /// Its kind.
    const KIND: Kind;

    /// Borrows a slice of it.
    fn values(values: &[Self]) -> Values<'_>;

    /// The slice that was borrowed, if it is of this number.
    fn slice<'a>(values: &Values<'a>) -> Option<&'a [Self]>;

    /// Stores it in the `KIND.size()` bytes of `bytes`, little-endian.
    fn store(self, bytes: &mut [u8]);

    /// The number that [`Element::store`] left in `bytes`, to the bit.
    fn load(bytes: &[u8]) -> Self;
}

mod sealed {
    pub trait Sealed {}
}

macro_rules! elements {
    ($($number:ty => $kind:ident),*) => {$(
        impl sealed::Sealed for $number {}

        impl Element for $number {
            const KIND: Kind = Kind::$kind;

            fn values(values: &[Self]) -> Values<'_> {
                Values::$kind(values)
            }

            fn slice<'a>(values: &Values<'a>) -> Option<&'a [Self]> {
                match *values {
                    Values::$kind(values) => Some(values),
                    _ => None,
                }
            }

            fn store(self, bytes: &mut [u8]) {
                bytes.copy_from_slice(&self.to_le_bytes());
            }

            fn load(bytes: &[u8]) -> Self {
                let mut own = [0; size_of::<Self>()];
                own.copy_from_slice(bytes);
                Self::from_le_bytes(own)
            }
        }
    )*};
}

elements!(f32 => F32, f64 => F64, u8 => U8, u32 => U32, u64 => U64);

/// Writes tuples of `width` numbers, one from each of `columns`, which have the same length; what
/// the columns leave of a tuple is zero.
pub(super) fn write_tuples<T: Element>(
    out: &mut impl Write,
    columns: &[&[T]],
    width: usize,
) -> io::Result<()> {
    /// Tuples at a time: 24 KiB of the largest, which a first-level cache holds.
    const AT_ONCE: usize = 1024;
    let size = T::KIND.size();
    let mut buffer = [0_u8; AT_ONCE * 3 * 8];
    let count = columns.first().map_or(0, |column| column.len());
    for start in (0..count).step_by(AT_ONCE) {
        let end = count.min(start + AT_ONCE);
        let bytes = &mut buffer[..(end - start) * width * size];
        for (place, column) in columns.iter().enumerate() {
            let at = place * size..(place + 1) * size;
            for (tuple, value) in bytes.chunks_exact_mut(width * size).zip(&column[start..end]) {
                value.store(&mut tuple[at.clone()]);
            }
        }
        out.write_all(bytes)?;
    }
    Ok(())
}
