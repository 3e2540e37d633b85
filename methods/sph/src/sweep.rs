//! A rate stage of SPH: gathers what the particles of a sub-domain see once, then lets every term of the
//! scene run over it.

use finegrain_framework::space::Cells;
use finegrain_framework::{
    ColumnId, Domain, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real,
};

use crate::fields::Fields;
use crate::gathered::{Gathered, Wanted};
use crate::imposed::Imposed;
use crate::kernel::adaptive::Kernels;
use crate::pairs::{Keeping, Listed, MOST_LISTED, keep};
use crate::quantity::Quantity;
use crate::sums::{Scratch, Sums, Written};
use crate::sweep_part::SweepPart;
use crate::term::{AnyTerm, Term};
use crate::wall::Friction;

/// One sweep over all pairs, in `D` dimensions.
#[derive(Clone, Debug)]
pub(crate) struct Sweep<T, P, const D: usize> {
    name: String,
    gathered: Gathered<T, P>,
    /// Where what is summed up goes.
    outputs: Vec<Rate<T>>,
    sums: Sums<T, D>,
    keeping: Keeping,
}

impl<T: Real, P: Real, const D: usize> Sweep<T, P, D> {
    /// A sweep of `terms`, with the columns that they need. If `bodies_evolve`, the sums for the
    /// fluid are for the particles of bodies, too.
    pub fn new(
        kernels: Kernels<T, D>,
        terms: Vec<AnyTerm<T>>,
        fields: &Fields<T, P>,
        imposed: &Imposed<T, D>,
        bodies_evolve: bool,
        friction: &Friction<T>,
    ) -> Self {
        let reads = terms.iter().flat_map(|term| term.reads(D)).chain([Quantity::WallDepth]);
        let mut writes: Vec<_> = terms.iter().flat_map(|term| term.writes(D)).collect();
        writes.sort_unstable();
        writes.dedup();
        let accelerates = writes.contains(&Quantity::Acceleration(0));
        if accelerates {
            writes.extend(Quantity::vector(Quantity::Reaction, fields.reaction.len()));
        }
        let outputs = writes.into_iter().filter_map(|q| Some((q, fields.rate(q)?)));
        let (quantities, outputs): (Vec<_>, Vec<_>) = outputs.unzip();
        // Named after what it sums up, for error messages.
        let names: Vec<_> = terms.iter().map(AnyTerm::name).collect();
        let wanted = Wanted {
            kernel: terms.iter().any(Term::uses_kernel),
            gradient: terms.iter().any(Term::uses_gradient),
        };
        let sees_velocity = terms.iter().any(Term::sees_velocity_in_bodies);
        // Particles of bodies do not move, and stress in them is not looked at.
        let evolves = |term: &AnyTerm<T>| {
            let of_fluid =
                |q: &Quantity| matches!(q, Quantity::Acceleration(_) | Quantity::StressTerm(_));
            !term.writes(D).iter().all(of_fluid)
        };
        let of_bodies =
            |term: &&AnyTerm<T>| term.acts_on_bodies() || (bodies_evolve && evolves(term));
        let slips = matches!(friction, Friction::None);
        let on_bodies =
            |term: &&AnyTerm<T>| term.pushes_bodies() && !(slips && term.sees_velocity_in_bodies());
        let reacts = accelerates && !fields.reaction.is_empty();
        let imposed_reads = imposed.reads().filter(|_| accelerates);
        let gathered = Gathered::new(fields, reads.chain(imposed_reads).collect(), wanted);
        let sums = Sums {
            kernels,
            of_fluid: terms.iter().filter(|term| !term.acts_on_bodies()).copied().collect(),
            of_bodies: terms.iter().filter(of_bodies).copied().collect(),
            on_bodies: terms.iter().filter(on_bodies).filter(|_| reacts).copied().collect(),
            layout: gathered.layout.clone(),
            outputs: quantities,
            imposed: accelerates.then(|| imposed.clone()),
            friction: if sees_velocity { friction.clone() } else { Friction::AsGiven },
        };
        let name = format!("sph {}", names.join(", "));
        Self { name, gathered, outputs, sums, keeping: Keeping::Nothing }
    }

    /// With lists of neighbours that it writes or reads.
    pub fn keeping(mut self, keeping: Keeping) -> Self {
        self.keeping = keeping;
        self
    }
}

impl<T: Real, P: Real, const D: usize> RateStage<Cells<P>> for Sweep<T, P, D> {
    type Scratch = Scratch<T, D>;

    fn name(&self) -> &str {
        &self.name
    }

    fn writes(&self) -> Vec<ColumnId> {
        self.outputs.iter().map(|rate| rate.id()).collect()
    }

    fn rate(
        &self,
        near: &Near<'_, Cells<P>>,
        rates: &mut Rates<'_, Cells<P>>,
        scratch: &mut Self::Scratch,
        moment: &Moment,
    ) -> Result<(), Fault> {
        let block = near.domain().sub_domain(near.id());
        let mut written: Written<'_, T> = std::array::from_fn(|_| &mut [][..]);
        for (column, &rate) in written.iter_mut().zip(&self.outputs) {
            *column = rates.column(rate).whole();
        }
        let depth = self.gathered.wall_depth().map(|depth| near.state(depth).own().whole());
        if let Keeping::Writes(lists) = self.keeping {
            // Nobody reads what an earlier step wrote.
            rates.notes(lists).clear();
        }
        if depth.is_some_and(|depth| !depth.iter().any(|&depth| self.sums.acts_at(depth))) {
            for column in &mut written[..self.outputs.len()] {
                column.fill(T::zero());
            }
            return Ok(());
        }
        let range = self.sums.kernels.range();
        let activity = near.activity();
        SweepPart::Collect.begin(activity);
        scratch.surroundings.collect(&self.gathered, near, &block, range);
        let time = moment.stage_time;
        let mut sum =
            |scratch, listed| self.sums.write(&mut written, scratch, listed, time, activity);
        match self.keeping {
            Keeping::Reads(lists) => sum(scratch, Listed::Read(&rates.notes(lists))),
            Keeping::Writes(lists) if scratch.surroundings.len() <= MOST_LISTED => {
                let mut list = std::mem::take(&mut scratch.list);
                list.clear();
                sum(scratch, Listed::Written(&mut list));
                keep(&list, &mut rates.notes(lists));
                scratch.list = list;
            }
            Keeping::Nothing | Keeping::Writes(_) => sum(scratch, Listed::Not),
        }
        Ok(())
    }
}
