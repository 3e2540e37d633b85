//! What each row of sites consists of: runs of sites that only stream and collide, and single sites
//! that need more, with their links.

use std::ops::Range;

use finegrain_framework::Real;
use finegrain_framework::shape::Shape;

use crate::error::LbmError;
use crate::lattice::SOUND_SPEED_SQUARED;
use crate::link::{Cut, Link};
use crate::mesh::Mesh;
use crate::opening::Opening;
use crate::physics::{Physics, Scheme};

/// Surfaces so close on a link, as a fraction of it, are met at once: in a corner rounding must not
/// decide which body it is, or a lid would add mass at one end and not take it at the other.
const TIE: f64 = 1e-9;

/// All rows.
#[derive(Debug, Default)]
pub(crate) struct Sites<T> {
    /// Row `r` has `runs[run_start[r]..run_start[r + 1]]`.
    run_start: Vec<u32>,
    runs: Vec<Run>,
    /// Row `r` has `singles[single_start[r]..single_start[r + 1]]`.
    single_start: Vec<u32>,
    singles: Vec<Single>,
    links: Vec<Link<T>>,
}

/// Sites next to one another that pull from sites of the fluid only, in whole [lines](line) of the cache.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    pub start: u32,
    pub end: u32,
}

impl Run {
    /// The run, with lines at the ends of their row of `nx` sites, which pull from the other end, too, by
    /// themselves, and last: the row is in the cache by then.
    pub fn parts<T>(self, nx: usize) -> impl Iterator<Item = [usize; 2]> {
        let (start, end) = (self.start as usize, self.end as usize);
        let first = if start == 0 { line::<T>() } else { start };
        let last = if end == nx { first.max(end - line::<T>()) } else { end };
        [[first, last], [last, end], [start, first]].into_iter().filter(|[start, end]| start < end)
    }
}

/// Scalars in a line of the cache, where columns begin: packs of runs lie in lines, so that they are
/// written whole and, where that is faster, past the cache.
pub(crate) const fn line<T>() -> usize {
    64 / size_of::<T>()
}

/// Any other site of the fluid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Single {
    pub x: u32,
    first_link: u32,
    links: u8,
    /// Number of its opening from 1, or 0.
    opening: u8,
}

impl Single {
    /// Number of the opening on the plane of which it lies.
    pub fn opening(&self) -> Option<usize> {
        usize::from(self.opening).checked_sub(1)
    }
}

impl<T> Sites<T> {
    /// The runs of row number `row`.
    pub fn runs(&self, row: usize) -> &[Run] {
        &self.runs[self.run_start[row] as usize..self.run_start[row + 1] as usize]
    }

    /// Its single sites.
    pub fn singles(&self, row: usize) -> &[Single] {
        &self.singles[self.single_start[row] as usize..self.single_start[row + 1] as usize]
    }

    /// The links of a single site.
    pub fn links(&self, single: &Single) -> &[Link<T>] {
        let first = single.first_link as usize;
        &self.links[first..first + usize::from(single.links)]
    }
}

/// Of each site the number of the body that it is in, from 1; 0 in the fluid.
pub(crate) fn solid(mesh: &Mesh, physics: &Physics) -> Result<Vec<u8>, LbmError> {
    let mut solid = vec![0; mesh.sites()];
    for (number, body) in (1..).zip(&physics.bodies) {
        let images = images(mesh);
        for z in 0..mesh.shape[2] {
            for y in 0..mesh.shape[1] {
                for x in 0..mesh.shape[0] {
                    let place = &mut solid[mesh.number([x, y, z])];
                    let position = mesh.position([x, y, z].map(|i| i as isize));
                    if *place == 0 && images.iter().any(|&i| contains(&body.shape, position, i)) {
                        *place = number;
                    }
                }
            }
        }
    }
    if solid.iter().all(|&body| body > 0) { Err(LbmError::Full) } else { Ok(solid) }
}

/// Shifts, in m, through which a body is seen in the periodic directions.
fn images(mesh: &Mesh) -> Vec<[f64; 3]> {
    let mut images = vec![[0.0; 3]];
    for a in 0..3 {
        // A plane has no thickness.
        if mesh.periodic[a] && (a < 2 || mesh.shape[a] > 1) {
            let period = mesh.shape[a] as f64 * mesh.spacing;
            for image in images.clone() {
                for shift in [-period, period] {
                    let mut shifted = image;
                    shifted[a] = shift;
                    images.push(shifted);
                }
            }
        }
    }
    images
}

fn contains(shape: &Shape, position: [f64; 3], image: [f64; 3]) -> bool {
    shape.contains(back(position, image))
}

/// A point as it lies to a body of which an image is looked at.
fn back(position: [f64; 3], image: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|a| position[a] - image[a])
}

impl<T: Real> Sites<T> {
    /// Finds runs, single sites and links.
    pub fn new(
        mesh: &Mesh,
        physics: &Physics,
        scheme: &Scheme,
        solid: &[u8],
    ) -> Result<Self, LbmError> {
        let mut sites = Self { run_start: vec![0], single_start: vec![0], ..Self::default() };
        let survey = Survey { mesh, physics, scheme, solid, images: images(mesh) };
        let mut cuts = Vec::new();
        for z in 0..mesh.shape[2] {
            for y in 0..mesh.shape[1] {
                let (mut run, row) = (0..0, mesh.number([0, y, z]));
                for x in 0..mesh.shape[0] {
                    if solid[mesh.number([x, y, z])] > 0 {
                        sites.close(&mut run, row);
                        continue;
                    }
                    let opening = survey.opening([x, y, z])?;
                    survey.cuts([x, y, z], &mut cuts)?;
                    if cuts.is_empty() && opening == 0 {
                        if run.is_empty() {
                            run = x..x;
                        }
                        run.end = x + 1;
                    } else {
                        sites.close(&mut run, row);
                        let links = cuts.iter().map(|cut| Link::new(cut, scheme.wall));
                        sites.single(x, links, opening);
                    }
                }
                sites.close(&mut run, row);
                sites.run_start.push(sites.runs.len() as u32);
                sites.single_start.push(sites.singles.len() as u32);
            }
        }
        Ok(sites)
    }

    /// Ends a run, in the row of which the first site has number `row`; sites before and after its whole
    /// lines become single ones.
    fn close(&mut self, run: &mut Range<usize>, row: usize) {
        let start = (row + run.start).next_multiple_of(line::<T>()) - row;
        let lines = run.end.saturating_sub(start) / line::<T>();
        let whole = if lines > 0 { start..start + lines * line::<T>() } else { run.end..run.end };
        for x in (run.start..whole.start).chain(whole.end..run.end) {
            self.single(x, [], 0);
        }
        if !whole.is_empty() {
            self.runs.push(Run { start: whole.start as u32, end: whole.end as u32 });
        }
        *run = 0..0;
    }

    fn single(&mut self, x: usize, links: impl IntoIterator<Item = Link<T>>, opening: u8) {
        let first_link = self.links.len();
        self.links.extend(links);
        let links = (self.links.len() - first_link) as u8;
        self.singles.push(Single { x: x as u32, first_link: first_link as u32, links, opening });
    }
}

/// What cuts are found from.
struct Survey<'a> {
    mesh: &'a Mesh,
    physics: &'a Physics,
    scheme: &'a Scheme,
    solid: &'a [u8],
    images: Vec<[f64; 3]>,
}

impl Survey<'_> {
    /// The cuts of a site of the fluid.
    fn cuts(&self, site: [usize; 3], cuts: &mut Vec<Cut>) -> Result<(), LbmError> {
        cuts.clear();
        let here = site.map(|i| i as isize);
        for (q, c) in self.scheme.lattice.velocities().iter().enumerate().skip(1) {
            let along = |sign: isize| [0, 1, 2].map(|a| here[a] + sign * c[a] as isize);
            let from = along(-1);
            let is_open = |o: &Opening| o.is_before(self.mesh, from);
            if self.is_fluid(from) || self.physics.openings.iter().any(is_open) {
                continue;
            }
            let (body, fraction) = self.surface(here, from)?;
            let velocity = self.physics.bodies[body].surface_velocity;
            let unit = self.mesh.unit_velocity();
            let sliding: f64 = (0..3).map(|a| f64::from(c[a]) * velocity[a] / unit).sum();
            let weight = self.scheme.lattice.weights()[q];
            cuts.push(Cut {
                q,
                body,
                fraction,
                has_far: self.is_fluid(along(1)),
                sliding: 2.0 * weight * sliding / SOUND_SPEED_SQUARED,
            });
        }
        Ok(())
    }

    /// Number, from 1, of the opening on the plane of which a site of the fluid lies; 0 if none.
    fn opening(&self, site: [usize; 3]) -> Result<u8, LbmError> {
        let mut found = 0;
        let here = site.map(|i| i as isize);
        for (number, opening) in (1..).zip(&self.physics.openings) {
            if !opening.has(self.mesh, site) {
                continue;
            }
            let position = self.mesh.position(here);
            if found > 0 {
                return Err(LbmError::OpeningsMeet { position });
            }
            found = number;
            let mut inside = here;
            inside[opening.axis()] += opening.inward() as isize;
            if !self.is_fluid(inside) {
                return Err(LbmError::OpeningBlocked { position });
            }
        }
        Ok(found)
    }

    fn is_fluid(&self, site: [isize; 3]) -> bool {
        self.mesh.wrap(site).is_some_and(|site| self.solid[self.mesh.number(site)] == 0)
    }

    /// The body that the way between two sites meets first, and where on the way.
    fn surface(&self, here: [isize; 3], from: [isize; 3]) -> Result<(usize, f64), LbmError> {
        let (start, end) = (self.mesh.position(here), self.mesh.position(from));
        let mut first: Option<(usize, f64)> = None;
        for (number, body) in self.physics.bodies.iter().enumerate() {
            for &image in &self.images {
                let crossing = body.shape.crossing(back(start, image), back(end, image));
                // Rounding may put a surface through a site just beyond the end of the way.
                let crossing =
                    crossing.or_else(|| contains(&body.shape, end, image).then_some(1.0));
                if let Some(fraction) = crossing
                    && first.is_none_or(|(_, least)| fraction < least - TIE)
                {
                    first = Some((number, fraction));
                }
            }
        }
        first.ok_or(LbmError::Open { position: end })
    }
}
