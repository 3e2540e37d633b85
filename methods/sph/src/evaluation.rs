//! The order in which the pieces of a model are evaluated: it follows from what they read and
//! write.
//!
//! A piece is a term (a sum over neighbours), an update (of a particle's own quantities) or a stage
//! that sums over neighbours in its own way. Terms that can are summed in one sweep over all pairs. A
//! piece comes after those that write what it reads, and all terms that add to one quantity are in
//! one sweep.

use finegrain_framework::space::Cells;
use finegrain_framework::{Real, Stage};

use crate::fields::Fields;
use crate::quantity::Quantity;
use crate::term::{AnyTerm, Term};

/// Something that is evaluated.
pub(crate) enum Piece<T: Real, P: Real> {
    Term(AnyTerm<T>),
    Update(Update<T, P>),
    Alone(Alone<T, P>),
}

/// A rate stage that is not made of terms.
pub(crate) struct Alone<T: Real, P: Real> {
    pub reads: Vec<Quantity>,
    pub writes: Vec<Quantity>,
    /// Makes it once the columns are known.
    pub stage: MakeStage<T, P>,
}

/// Makes a stage from the columns of a model.
pub(crate) type MakeStage<T, P> = Box<dyn FnOnce(&Fields<T, P>) -> Stage<Cells<P>>>;

/// An update of a particle's own quantities.
pub(crate) struct Update<T: Real, P: Real> {
    pub reads: Vec<Quantity>,
    pub writes: Vec<Quantity>,
    /// Whether it overwrites what is already there, in bodies, from sums over the fluid.
    pub amends: bool,
    /// Makes its stage once the columns are known.
    pub stage: MakeStage<T, P>,
}

impl<T: Real, P: Real> Piece<T, P> {
    /// The quantities that it needs.
    pub fn reads(&self, dims: usize) -> Vec<Quantity> {
        match self {
            Self::Term(term) => term.reads(dims),
            Self::Update(update) => update.reads.clone(),
            Self::Alone(alone) => alone.reads.clone(),
        }
    }

    /// The quantities that it computes.
    pub fn writes(&self, dims: usize) -> Vec<Quantity> {
        match self {
            Self::Term(term) => term.writes(dims),
            Self::Update(update) => update.writes.clone(),
            Self::Alone(alone) => alone.writes.clone(),
        }
    }

    /// Whether it needs what `writer` writes.
    fn needs(&self, writer: &Self, dims: usize) -> bool {
        let overlap = |a: Vec<Quantity>, b: Vec<Quantity>| a.iter().any(|q| b.contains(q));
        match (self, writer) {
            // The sums for bodies are over the fluid.
            (Self::Term(term), Self::Update(update)) if update.amends && term.acts_on_bodies() => {
                false
            }
            (Self::Update(update), _) if update.amends => {
                overlap(self.reads(dims), writer.writes(dims))
                    || overlap(self.writes(dims), writer.writes(dims))
            }
            _ => overlap(self.reads(dims), writer.writes(dims)),
        }
    }

    /// Whether it is a sum that adds to what `other` adds to.
    fn is_summed_with(&self, other: &Self, dims: usize) -> bool {
        let both = matches!((self, other), (Self::Term(_), Self::Term(_)));
        both && self.writes(dims).iter().any(|q| other.writes(dims).contains(q))
    }

    /// Whether it is a sum for the fluid.
    pub fn acts_on_fluid(&self) -> bool {
        matches!(self, Self::Term(term) if !term.acts_on_bodies())
    }

    /// The first slot from `slot` on that it may take: updates take the even ones, sweeps the odd.
    fn from(&self, slot: usize) -> usize {
        slot + usize::from((slot % 2 == 1) != !matches!(self, Self::Update(_)))
    }
}

/// Sorts pieces into slots, each an update or the terms of one sweep.
///
/// # Panics
/// If pieces need each other in a circle.
pub(crate) fn slots<T: Real, P: Real>(
    pieces: Vec<Piece<T, P>>,
    dims: usize,
) -> Vec<Vec<Piece<T, P>>> {
    let mut slots: Vec<usize> = pieces.iter().map(|piece| piece.from(0)).collect();
    let mut is_settled = false;
    while !is_settled {
        is_settled = true;
        for i in 0..pieces.len() {
            for j in 0..pieces.len() {
                let least = if i != j && pieces[i].needs(&pieces[j], dims) {
                    slots[j] + 1
                } else if pieces[i].is_summed_with(&pieces[j], dims) {
                    slots[j]
                } else {
                    0
                };
                if slots[i] < least {
                    slots[i] = pieces[i].from(least);
                    is_settled = false;
                }
            }
            assert!(slots[i] <= 2 * pieces.len(), "terms need each other in a circle");
        }
    }
    delay(&pieces, &mut slots, dims);
    let mut sorted: Vec<Vec<Piece<T, P>>> = Vec::new();
    sorted.resize_with(slots.iter().max().map_or(0, |last| last + 1), Vec::new);
    for (piece, slot) in pieces.into_iter().zip(slots) {
        sorted[slot].push(piece);
    }
    sorted
}

/// Moves sums for the fluid that nobody waits for from sweeps that would otherwise look at bodies
/// only to the last sweep, so that the neighbours of the fluid are gathered once less.
fn delay<T: Real, P: Real>(pieces: &[Piece<T, P>], slots: &mut [usize], dims: usize) {
    let is_last = |i: usize| {
        pieces[i].acts_on_fluid() && !pieces.iter().any(|other| other.needs(&pieces[i], dims))
    };
    let Some(last) = (0..pieces.len()).filter(|&i| is_last(i)).map(|i| slots[i]).max() else {
        return;
    };
    for i in 0..pieces.len() {
        let waits = |j: usize| slots[j] != slots[i] || !pieces[j].acts_on_fluid() || is_last(j);
        if is_last(i) && (0..pieces.len()).all(waits) {
            slots[i] = last;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::term::continuity::Continuity;
    use crate::term::momentum::{PressureGradient, StressDivergence};
    use crate::term::strain_rate::StrainRate;

    fn state_equation() -> Piece<f64, f64> {
        Piece::Update(Update {
            reads: Vec::new(),
            writes: vec![Quantity::Volume, Quantity::PressureTerm],
            amends: false,
            stage: Box::new(|_| unreachable!("never made")),
        })
    }

    fn names(slots: &[Vec<Piece<f64, f64>>]) -> Vec<Vec<&'static str>> {
        let name = |piece: &Piece<f64, f64>| match piece {
            Piece::Term(AnyTerm::Continuity(_)) => "continuity",
            Piece::Term(AnyTerm::PressureGradient(_)) => "pressure",
            Piece::Term(AnyTerm::StrainRate(_)) => "strain",
            Piece::Term(AnyTerm::StressDivergence(_)) => "stress",
            Piece::Term(_) => "term",
            Piece::Update(_) => "update",
            Piece::Alone(_) => "alone",
        };
        slots.iter().map(|slot| slot.iter().map(name).collect()).collect()
    }

    #[test]
    fn one_sweep_where_nothing_depends_on_rates_and_two_where_stress_does() {
        let mass = 1.0;
        let inviscid = vec![
            Piece::Term(Continuity { mass, is_corrected: false }.into()),
            Piece::Term(PressureGradient { mass }.into()),
            state_equation(),
        ];
        assert_eq!(names(&slots(inviscid, 2)), [vec!["update"], vec!["continuity", "pressure"]]);
        let strain_rate =
            StrainRate { mass, dynamic_viscosity: 1.0, in_bodies: None, is_corrected: false };
        let viscous = vec![
            Piece::Term(StressDivergence { mass }.into()),
            Piece::Term(Continuity { mass, is_corrected: false }.into()),
            Piece::Term(strain_rate.into()),
            Piece::Term(PressureGradient { mass }.into()),
            state_equation(),
        ];
        let expected =
            [vec!["update"], vec!["continuity", "strain"], vec![], vec!["stress", "pressure"]];
        assert_eq!(names(&slots(viscous, 2)), expected);
    }
}
