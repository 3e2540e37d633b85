//! Columns: one field stored as one contiguous array over all points.
//!
//! A method declares its fields once, as [`State`] (what is advanced and saved) or
//! [`Rate`] (what rate stages write), and gets back small typed handles. Stages name
//! fields by handle; what they may do with a field follows from the handle's type.

use std::marker::PhantomData;

use bytemuck::Pod;

use crate::format::{Kind, Values};
use crate::memory::{Line, Memory};
use crate::notes::{Note, Notebook, Notes};

/// Element type of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ElementKind {
    /// 32-bit float.
    F32,
    /// 64-bit float.
    F64,
    /// 32-bit unsigned integer.
    U32,
    /// 64-bit unsigned integer.
    U64,
    /// Byte.
    U8,
}

impl ElementKind {
    /// What files call it.
    pub fn file_kind(self) -> Kind {
        match self {
            Self::F32 => Kind::F32,
            Self::F64 => Kind::F64,
            Self::U32 => Kind::U32,
            Self::U64 => Kind::U64,
            Self::U8 => Kind::U8,
        }
    }

    /// Bytes of one element.
    pub fn size(self) -> usize {
        match self {
            Self::F32 | Self::U32 => 4,
            Self::F64 | Self::U64 => 8,
            Self::U8 => 1,
        }
    }
}

/// A type that a column can hold.
pub trait Element: Pod + Send + Sync + std::fmt::Debug {
    /// The run-time name of this type.
    const KIND: ElementKind;
}

macro_rules! elements {
    ($($type:ty => $kind:ident),*) => {
        $(impl Element for $type { const KIND: ElementKind = ElementKind::$kind; })*
    };
}
elements!(f32 => F32, f64 => F64, u32 => U32, u64 => U64, u8 => U8);

/// Index of a column in its [`Columns`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ColumnId(pub(crate) u16);

/// Handle of a state column: rate stages read it, update stages write it.
pub struct State<T>(ColumnId, PhantomData<fn() -> T>);

/// Handle of a rate column: rate stages write it, update stages read it.
pub struct Rate<T>(ColumnId, PhantomData<fn() -> T>);

/// What [`State`] and [`Rate`] have in common.
pub trait Handle: Copy {
    /// Element type of the column.
    type Element: Element;
    /// The column.
    fn id(self) -> ColumnId;
}

macro_rules! handle {
    ($name:ident) => {
        impl<T> Clone for $name<T> {
            fn clone(&self) -> Self {
                *self
            }
        }
        impl<T> Copy for $name<T> {}
        impl<T> std::fmt::Debug for $name<T> {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, concat!(stringify!($name), "({})"), self.0.0)
            }
        }
        impl<T: Element> Handle for $name<T> {
            type Element = T;
            fn id(self) -> ColumnId {
                self.0
            }
        }
    };
}
handle!(State);
handle!(Rate);

/// What a column is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Advanced by update stages; part of every checkpoint and of the state hash.
    State,
    /// Written by update stages but dead at the end of a step (a Runge-Kutta register).
    Register,
    /// Written by rate stages; saved only if [`Columns::keep`] says that its values
    /// live on into the next step.
    Rate,
}

/// One declared column and its memory.
#[derive(Debug)]
pub struct Column {
    name: String,
    role: Role,
    kind: ElementKind,
    kept: bool,
    limit: Option<&'static Limit>,
    lines: Memory,
}

/// How far values of a column may be from zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The largest magnitude.
    pub most: f64,
    /// What it means if there is a larger one.
    pub beyond: &'static str,
}

impl Column {
    /// The declared name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the column is for.
    pub fn role(&self) -> Role {
        self.role
    }

    /// Element type.
    pub fn kind(&self) -> ElementKind {
        self.kind
    }

    /// How far its values may be from zero; `None` if all that are finite are valid.
    pub fn limit(&self) -> Option<&'static Limit> {
        self.limit
    }

    /// The largest magnitude that is valid.
    pub(crate) fn most(&self) -> f64 {
        self.limit.map_or(f64::MAX, |limit| limit.most)
    }

    /// Whether its values live from one step to the next, so that a checkpoint needs them.
    pub fn is_kept(&self) -> bool {
        self.kept
    }

    fn lines_for(kind: ElementKind, points: usize) -> usize {
        (points * kind.size()).div_ceil(size_of::<Line>())
    }
}

/// All columns of a run: structure of arrays over the same points.
#[derive(Debug, Default)]
pub struct Columns {
    points: usize,
    columns: Vec<Column>,
    notebook: Notebook,
}

impl Columns {
    /// At most so many columns can be declared: sets of them are bit masks.
    pub const MOST: usize = 128;

    /// Columns over `points` points; none declared yet.
    pub fn new(points: usize) -> Self {
        Self { points, columns: Vec::new(), notebook: Notebook::default() }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Declares a state column, filled with zeros.
    ///
    /// # Panics
    /// If the name is taken or there are [`Columns::MOST`] columns already.
    pub fn state<T: Element>(&mut self, name: &str) -> State<T> {
        State(self.declare(name, Role::State, T::KIND, true), PhantomData)
    }

    /// Declares a register: a state column whose values are dead at the end of a step.
    ///
    /// # Panics
    /// As [`Columns::state`].
    pub fn register<T: Element>(&mut self, name: &str) -> State<T> {
        State(self.declare(name, Role::Register, T::KIND, false), PhantomData)
    }

    /// Declares a rate column, filled with zeros.
    ///
    /// # Panics
    /// As [`Columns::state`].
    pub fn rate<T: Element>(&mut self, name: &str) -> Rate<T> {
        Rate(self.declare(name, Role::Rate, T::KIND, false), PhantomData)
    }

    /// Declares notes of every sub-domain for itself, empty at first: rate stages write them and later
    /// rate stages of the same step read them ([`Rates::notes`](crate::Rates::notes)). They are never
    /// saved, and a re-sort leaves them with other points: a stage that reads them relies on an earlier
    /// one of its step, or the same scene does not give the same bits after a restart.
    pub fn notes<T: Note>(&mut self) -> Notes<T> {
        self.notebook.declare()
    }

    pub(crate) fn notebook(&self) -> &Notebook {
        &self.notebook
    }

    pub(crate) fn notebook_mut(&mut self) -> &mut Notebook {
        &mut self.notebook
    }

    /// Declares a column of the type of another one, named after it.
    pub(crate) fn declare_like(&mut self, model: ColumnId, prefix: &str, role: Role) -> ColumnId {
        let column = self.column(model);
        let (name, kind) = (format!("{prefix}_{}", column.name), column.kind);
        self.declare(&name, role, kind, role == Role::State)
    }

    /// Copies one column to another of the same type.
    pub(crate) fn copy(&mut self, from: ColumnId, to: ColumnId) {
        let (from, to) = (from.0 as usize, to.0 as usize);
        let [from, to] = self.columns.get_disjoint_mut([from, to]).expect("two columns of these");
        to.lines.copy_from_slice(&from.lines);
    }

    /// Marks a column as living from one step to the next (an integrator that reuses the
    /// last step's rates does this): checkpoints save it, re-sorting carries it along.
    pub fn keep(&mut self, column: ColumnId) {
        self.columns[column.0 as usize].kept = true;
    }

    /// Says how far values of a state column may be from zero: larger ones end the run as those do that are
    /// not finite, and wherever those are looked for
    /// ([`Settings::check_every`](crate::Settings::check_every)). What has lost all sense may take hundreds of
    /// steps more to grow out of the range of floats.
    pub fn limit<T: Element>(&mut self, column: State<T>, limit: &'static Limit) {
        self.columns[column.id().0 as usize].limit = Some(limit);
    }

    fn declare(&mut self, name: &str, role: Role, kind: ElementKind, kept: bool) -> ColumnId {
        assert!(
            self.columns.iter().all(|c| c.name != name),
            "a column named {name:?} is declared twice"
        );
        assert!(self.columns.len() < Self::MOST, "more than {} columns", Self::MOST);
        self.columns.push(Column {
            name: name.to_owned(),
            role,
            kind,
            kept,
            limit: None,
            lines: Memory::new(self.columns.len(), Column::lines_for(kind, self.points)),
        });
        ColumnId((self.columns.len() - 1) as u16)
    }

    /// The declared columns, in order of declaration.
    pub fn iter(&self) -> impl Iterator<Item = (ColumnId, &Column)> {
        (0u16..).map(ColumnId).zip(&self.columns)
    }

    /// The ids of the declared columns, in order of declaration.
    pub(crate) fn ids(&self) -> impl Iterator<Item = ColumnId> + use<> {
        (0..self.columns.len() as u16).map(ColumnId)
    }

    /// The handle of the state column `name`; `None` if there is none of this name and type.
    pub fn find_state<T: Element>(&self, name: &str) -> Option<State<T>> {
        let is_it = |c: &Column| c.name == name && c.role == Role::State && c.kind == T::KIND;
        self.iter().find(|(_, column)| is_it(column)).map(|(id, _)| State(id, PhantomData))
    }

    /// One column's declaration.
    pub fn column(&self, id: ColumnId) -> &Column {
        &self.columns[id.0 as usize]
    }

    /// Values of a column, one per point.
    ///
    /// # Panics
    /// If the handle belongs to other columns (no such column, or of another type).
    pub fn values<H: Handle>(&self, handle: H) -> &[H::Element] {
        let column = &self.columns[handle.id().0 as usize];
        assert_eq!(column.kind, H::Element::KIND, "handle of other columns");
        &bytemuck::cast_slice::<Line, _>(&column.lines)[..self.points]
    }

    /// Values of a column, to set an initial state or for whole-domain work.
    ///
    /// # Panics
    /// As [`Columns::values`].
    pub fn values_mut<H: Handle>(&mut self, handle: H) -> &mut [H::Element] {
        let column = &mut self.columns[handle.id().0 as usize];
        assert_eq!(column.kind, H::Element::KIND, "handle of other columns");
        &mut bytemuck::cast_slice_mut::<Line, _>(&mut column.lines)[..self.points]
    }

    /// Values of a column as raw bytes in memory order (hash, checkpoint).
    pub fn bytes(&self, id: ColumnId) -> &[u8] {
        let column = &self.columns[id.0 as usize];
        &bytemuck::cast_slice::<Line, _>(&column.lines)[..self.points * column.kind.size()]
    }

    /// As [`Columns::bytes`], to be overwritten (restart, re-sort).
    pub fn bytes_mut(&mut self, id: ColumnId) -> &mut [u8] {
        let column = &mut self.columns[id.0 as usize];
        &mut bytemuck::cast_slice_mut::<Line, _>(&mut column.lines)
            [..self.points * column.kind.size()]
    }

    /// Values of a column of any element type, to be written to a file.
    pub fn any_values(&self, id: ColumnId) -> Values<'_> {
        let column = self.column(id);
        values_of(column.kind, &column.lines, self.points)
    }

    /// Exchanges the memory of two columns of one element type.
    pub(crate) fn exchange(&mut self, a: ColumnId, b: ColumnId) {
        let (a, b) = (a.0 as usize, b.0 as usize);
        // Everything that reads columns relies on their memory being as long as their type wants.
        assert_eq!(self.columns[a].kind, self.columns[b].kind);
        let [a, b] = self.columns.get_disjoint_mut([a, b]).expect("two columns of these");
        std::mem::swap(&mut a.lines, &mut b.lines);
    }

    /// Exchanges a column's memory with `spare`, which is first brought to its size:
    /// a whole-domain stage writes the new values into `spare` and then installs them.
    pub(crate) fn exchange_lines(&mut self, id: ColumnId, spare: &mut Memory) {
        let column = &mut self.columns[id.0 as usize];
        assert_eq!(spare.len(), column.lines.len());
        std::mem::swap(&mut column.lines, spare);
    }

    /// Number of lines of a column.
    pub(crate) fn lines(&self, id: ColumnId) -> usize {
        self.columns[id.0 as usize].lines.len()
    }

    /// Address, element type and length of every column's memory, in order.
    pub(crate) fn addresses(&mut self) -> impl Iterator<Item = (*mut u8, ElementKind)> {
        self.columns.iter_mut().map(|c| (c.lines.as_mut_ptr().cast(), c.kind))
    }

    /// Bytes held by all columns.
    pub fn memory(&self) -> usize {
        self.columns.iter().map(|c| c.lines.capacity() * size_of::<Line>()).sum()
    }
}

/// The first `points` elements of type `kind` in `memory`.
pub(crate) fn values_of<W: Pod>(kind: ElementKind, memory: &[W], points: usize) -> Values<'_> {
    match kind {
        ElementKind::F32 => Values::F32(&bytemuck::cast_slice(memory)[..points]),
        ElementKind::F64 => Values::F64(&bytemuck::cast_slice(memory)[..points]),
        ElementKind::U32 => Values::U32(&bytemuck::cast_slice(memory)[..points]),
        ElementKind::U64 => Values::U64(&bytemuck::cast_slice(memory)[..points]),
        ElementKind::U8 => Values::U8(&bytemuck::cast_slice(memory)[..points]),
    }
}

/// A set of columns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ColumnSet(u128);

impl ColumnSet {
    /// Whether `id` is in the set.
    pub fn contains(self, id: ColumnId) -> bool {
        self.0 >> id.0 & 1 == 1
    }

    /// Adds `id`; false if it was there already.
    pub fn insert(&mut self, id: ColumnId) -> bool {
        let was = self.contains(id);
        self.0 |= 1 << id.0;
        !was
    }
}

impl FromIterator<ColumnId> for ColumnSet {
    fn from_iter<I: IntoIterator<Item = ColumnId>>(ids: I) -> Self {
        let mut set = Self::default();
        for id in ids {
            set.insert(id);
        }
        set
    }
}
