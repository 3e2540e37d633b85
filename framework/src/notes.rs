//! Notes: what a sub-domain writes down in one rate stage for its own later ones.
//!
//! A column holds one value a point. What a stage finds out about its sub-domain may be of any size,
//! such as who is near whom; a later stage of the same step that needs it again can look it up instead.
//! Only the sub-domain itself ever sees its notes.

use std::any::Any;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::ops::DerefMut;
use std::sync::{Mutex, TryLockError};

/// Handle of notes of type `T`, of which every sub-domain has its own, see
/// [`Columns::notes`](crate::Columns::notes).
pub struct Notes<T>(usize, PhantomData<fn() -> T>);

impl<T> Clone for Notes<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Notes<T> {}
impl<T> Debug for Notes<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Notes({})", self.0)
    }
}

/// What can be noted.
pub trait Note: Any + Default + Debug + Send {}
impl<T: Any + Default + Debug + Send> Note for T {}

/// The notes of all sub-domains, of one type or another.
trait Pages: Debug + Send + Sync {
    fn resize(&mut self, sub_domains: usize);
    fn as_any(&self) -> &dyn Any;
}

/// Every sub-domain has its own page, and one worker at a time runs a sub-domain: the locks are never
/// contended.
impl<T: Note> Pages for Vec<Mutex<T>> {
    fn resize(&mut self, sub_domains: usize) {
        self.resize_with(sub_domains, Mutex::default);
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// All notes that are declared.
#[derive(Debug, Default)]
pub(crate) struct Notebook(Vec<Box<dyn Pages>>);

impl Notebook {
    /// Of no notes.
    pub const EMPTY: &Self = &Self(Vec::new());

    pub fn declare<T: Note>(&mut self) -> Notes<T> {
        self.0.push(Box::new(Vec::<Mutex<T>>::new()));
        Notes(self.0.len() - 1, PhantomData)
    }

    /// Makes room for so many sub-domains.
    pub fn resize(&mut self, sub_domains: usize) {
        self.0.iter_mut().for_each(|pages| pages.resize(sub_domains));
    }

    /// # Panics
    /// If the handle belongs to other columns, or the page is in use.
    pub fn page<T: Note>(&self, notes: Notes<T>, sub_domain: usize) -> impl DerefMut<Target = T> {
        let pages = self.0.get(notes.0).and_then(|pages| pages.as_any().downcast_ref());
        let pages: &Vec<Mutex<T>> = pages.expect("notes belong to other columns");
        match pages[sub_domain].try_lock() {
            Ok(page) => page,
            // Whoever panicked ended its run; what it left is overwritten before it is read.
            Err(TryLockError::Poisoned(page)) => page.into_inner(),
            Err(TryLockError::WouldBlock) => {
                panic!("the notes of sub-domain {sub_domain} are already borrowed")
            }
        }
    }
}
