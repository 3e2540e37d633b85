//! The step in place, with one set of columns (esoteric pull, Lehmann 2022).
//!
//! Of each pair of opposite velocities, a site finds what goes forward at itself and what goes backward one
//! site ahead, where it comes from. After the collision each takes the other's place, and the two
//! columns are exchanged: what goes forward is one site ahead then, where it arrives, and what goes
//! backward is still at home. So the slots of a site are its own: those ahead are owned with an
//! offset.
//!
//! What comes out of a body has to be there before: a stage of its own puts it there, by the owners
//! of the places where it is to be found.

use std::marker::PhantomData;

use finegrain_framework::pack::MOST_LANES;
use finegrain_framework::space::Grid;
use finegrain_framework::{ColumnId, Fault, Handle, Moment, Own, Real, State, UpdateStage};

use crate::around::wrap;
use crate::kernel::Slots;
use crate::lattice::Lattice;
use crate::mesh::Mesh;
use crate::row::{Group, Local, Scratch};
use crate::sites::Sites;

/// Where the population of velocity `q` is that leaves a site, as seen from there.
pub(crate) const fn kept(c: [i32; 3], q: usize) -> [i32; 3] {
    if q % 2 == 1 { c } else { [0; 3] }
}

/// Where the population of velocity `q` is that arrives at a site.
const fn found(c: [i32; 3], q: usize) -> [i32; 3] {
    if q % 2 == 1 { [0; 3] } else { [-c[0], -c[1], -c[2]] }
}

/// Offsets in y and z with which columns are owned: those of [`InPlace::shifts`].
pub(crate) fn offsets(velocities: &[[i32; 3]]) -> Vec<[isize; 2]> {
    let of = |(q, &c): (usize, &[i32; 3])| [1, 2].map(|a| found(c, q)[a] as isize);
    let mut offsets: Vec<_> = velocities.iter().enumerate().map(of).collect();
    offsets.sort_unstable();
    offsets.dedup();
    offsets.retain(|offset| *offset != [0; 2]);
    offsets
}

/// Streams and collides.
pub(crate) struct InPlace<T, L, const Q: usize> {
    pub lattice: PhantomData<L>,
    pub slots: [State<T>; Q],
    pub local: Local<T, Q>,
}

impl<T: Real, L: Lattice<Q>, const Q: usize> UpdateStage<Grid> for InPlace<T, L, Q> {
    type Scratch = Scratch<T>;

    fn name(&self) -> &str {
        "lbm stream and collide in place"
    }

    fn shifts(&self) -> Vec<(ColumnId, usize)> {
        let offsets = offsets(&L::VELOCITIES);
        let shift = |q: usize| {
            let [_, y, z] = found(L::VELOCITIES[q], q).map(|c| c as isize);
            let number = offsets.iter().position(|offset| *offset == [y, z])?;
            Some((self.slots[q].id(), number))
        };
        (0..Q).filter_map(shift).collect()
    }

    fn update(
        &self,
        own: &mut Own<'_, Grid>,
        scratch: &mut Scratch<T>,
        moment: &Moment,
    ) -> Result<(), Fault> {
        let Local { collider, sites, .. } = &self.local;
        let [nx, ny, _] = own.domain().shape();
        let time = moment.time + moment.dt;
        let mut columns = own.rows_of_mut(self.slots);
        let mut group: [Group<T>; Q] = [[T::zero(); MOST_LANES]; Q];
        for (j, k) in own.sub_domain().rows() {
            let number = k * ny + j;
            let (runs, singles) = (sites.runs(number), sites.singles(number));
            if runs.is_empty() && singles.is_empty() {
                continue;
            }
            self.local.accelerate(scratch, nx, (j, k), time);
            let mut rows = columns.row(j, k);
            for run in runs {
                let run = run.start as usize..run.end as usize;
                let varying = scratch.varying(run.start, run.end);
                let ahead = const { &ahead(L::VELOCITIES) };
                collider.exchange(Slots { rows: &mut rows, sites: run, ahead }, varying);
            }
            for singles in singles.chunks(MOST_LANES) {
                let place = |x: u32, q: usize| wrap(x as i32 + found(L::VELOCITIES[q], q)[0], nx);
                for (q, arrived) in group.iter_mut().enumerate() {
                    for (f, single) in arrived.iter_mut().zip(singles) {
                        *f = rows[q][place(single.x, q)];
                    }
                }
                let earlier = |_, _| unreachable!("refused by the model");
                self.local.complete::<L>(singles, &mut group, (j, k), time, &earlier);
                self.local.collide(singles, &mut group, scratch);
                for (q, row) in rows.iter_mut().enumerate() {
                    for (f, single) in group[q].iter().zip(singles) {
                        row[place(single.x, q)] = *f;
                    }
                }
            }
        }
        Ok(())
    }
}

/// How far ahead along x a site finds what arrives with each velocity: at itself or the next one, as the first of
/// a pair of velocities never goes back.
const fn ahead<const Q: usize>(velocities: [[i32; 3]; Q]) -> [usize; Q] {
    let mut ahead = [0; Q];
    let mut q = 0;
    while q < Q {
        ahead[q] = found(velocities[q], q)[0] as usize;
        q += 1;
    }
    ahead
}

/// The slots of a pair of velocities at one place, where bodies turn back half-way what the one or the other
/// needs; both, where a mesh that is not periodic ends on either side.
#[derive(Clone, Copy, Debug)]
struct Turn<T> {
    row: u32,
    x: u32,
    /// Number of the first velocity of the pair.
    q: u8,
    /// Of either velocity, if it comes out of a body, what a wall that slides adds.
    sliding: [Option<T>; 2],
}

/// All that bodies turn back half-way, row by row.
#[derive(Debug)]
pub(crate) struct Turns<T>(Vec<Turn<T>>);

impl<T: Real> Turns<T> {
    /// Of the links of all sites, which must be half-way.
    pub fn new(mesh: &Mesh, velocities: &[[i32; 3]], sites: &Sites<T>) -> Self {
        let [_, ny, nz] = mesh.shape;
        let mut all = Vec::new();
        for number in 0..ny * nz {
            for single in sites.singles(number) {
                let here = [single.x as usize, number % ny, number / ny].map(|i| i as i32);
                for link in sites.links(single) {
                    let (q, is_second) = (usize::from(link.q), link.q % 2 == 0);
                    let offset = found(velocities[q], q);
                    let [x, j, k] = [0, 1, 2].map(|a| wrap(here[a] + offset[a], mesh.shape[a]));
                    let mut sliding = [None; 2];
                    sliding[usize::from(is_second)] = Some(link.sliding);
                    let (row, x) = ((k * ny + j) as u32, x as u32);
                    all.push(Turn { row, x, q: link.q - u8::from(is_second), sliding });
                }
            }
        }
        let place = |turn: &Turn<T>| (turn.row, turn.x, turn.q);
        all.sort_by_key(place);
        all.dedup_by(|second, first| {
            let is_same = place(second) == place(first);
            if is_same {
                first.sliding = [0, 1].map(|n| first.sliding[n].or(second.sliding[n]));
            }
            is_same
        });
        Self(all)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Those of a row.
    fn of_row(&self, row: usize) -> &[Turn<T>] {
        let first = self.0.partition_point(|turn| (turn.row as usize) < row);
        let end = self.0.partition_point(|turn| turn.row as usize <= row);
        &self.0[first..end]
    }
}

/// Turns populations back at bodies half-way (Ladd 1994), where the next step finds them.
pub(crate) struct TurnBack<T, const Q: usize> {
    pub slots: [State<T>; Q],
    pub turns: Turns<T>,
}

impl<T: Real, const Q: usize> UpdateStage<Grid> for TurnBack<T, Q> {
    type Scratch = ();

    fn name(&self) -> &str {
        "lbm turn back at bodies"
    }

    fn update(&self, own: &mut Own<'_, Grid>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let ny = own.domain().shape()[1];
        let tile = own.sub_domain();
        let mut columns = self.slots.map(|column| own.rows_mut(column));
        for (j, k) in tile.rows() {
            for turn in self.turns.of_row(k * ny + j) {
                let (x, pair) = (turn.x as usize, [0, 1].map(|n| usize::from(turn.q) + n));
                let entered = pair.map(|q| columns[q].row(j, k)[x]);
                for n in 0..2 {
                    if let Some(sliding) = turn.sliding[n] {
                        columns[pair[n]].row(j, k)[x] = entered[1 - n] + sliding;
                    }
                }
            }
        }
        Ok(())
    }
}
