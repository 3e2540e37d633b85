//! Which faces of cells are inside bodies, and what must hold there.

use finegrain_framework::shape::Shape;

use super::super::stencil::Layer;
use super::Body;
use crate::error::FdError;
use crate::mesh::{AXES, Mesh, Spread};

/// The face of a cell at its lower end along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Face {
    pub axis: usize,
    /// Number of the cell, x running fastest.
    pub cell: usize,
}

/// A face in a body that the fluid sees: along the normal of the surface its velocity lies on the parabola through
/// that of the wall and two in the fluid.
#[derive(Clone, Debug)]
pub(crate) struct Ghost {
    pub face: Face,
    /// Faces, with the weights of their velocities in what the ghost's and theirs must add up to.
    pub image: Vec<(Face, f64)>,
    /// What they must add up to, m/s.
    pub sum: f64,
}

/// Where in the fluid, in spacings from the surface, velocities decide on those at ghosts: far enough for the nine
/// faces around to be in the fluid, or next to it. From nearer ones, 1 and 2 spacings, errors are smaller but grow in
/// time for some places of a body.
const PROBES: [f64; 2] = [1.5, 2.5];

/// The faces of a plane mesh with bodies.
#[derive(Debug)]
pub(crate) struct Faces {
    pub mesh: Mesh,
    /// Those inside of each body.
    pub inside: Vec<Vec<Face>>,
    /// By axis, of each body: the volume of what belongs to faces inside, less that of the body, m^2.
    pub excess: Vec<[f64; 2]>,
    pub ghosts: Vec<Ghost>,
    /// Sets of cells in bodies between which there are ghosts: on these a force along the gradient of a
    /// pressure changes nothing. The numbers of the ghosts, with the sign of the gradient.
    pub compartments: Vec<Vec<(usize, f64)>>,
}

/// What is nearest to a point.
#[derive(Clone, Copy)]
struct Nearest {
    body: usize,
    /// From the surface, negative inside, m.
    distance: f64,
    /// Out of the body.
    normal: [f64; 3],
}

impl Faces {
    /// # Errors
    /// If a body lies over an end of the mesh or the layer of cells `beyond` one, is too thin for it, or a gap is too
    /// narrow.
    pub fn new(mesh: &Mesh, bodies: &[Body], beyond: Option<Layer>) -> Result<Self, FdError> {
        let mut faces = Self {
            mesh: mesh.clone(),
            inside: vec![Vec::new(); bodies.len()],
            excess: vec![[0.0; 2]; bodies.len()],
            ghosts: Vec::new(),
            compartments: Vec::new(),
        };
        let cells = mesh.points();
        let all: Vec<[Nearest; 2]> = (0..cells)
            .map(|cell| {
                [0, 1].map(|axis| nearest(mesh, bodies, faces.position(Face { axis, cell })))
            })
            .collect();
        let at = |face: Face| all[face.cell][face.axis];
        let is_inside = |face: Face| at(face).distance <= 0.0;
        for axis in 0..2 {
            for face in (0..cells).map(|cell| Face { axis, cell }) {
                let Nearest { body, distance, .. } = at(face);
                // How much of what belongs to the face is in the body, as if the surface were across an axis: over
                // all faces errors cancel.
                let share = (0.5 - distance / mesh.spacing()[axis]).clamp(0.0, 1.0);
                faces.excess[body][axis] += (f64::from(distance <= 0.0) - share) * mesh.cell();
                if distance <= 0.0 {
                    faces.refuse_ends(face, body, beyond)?;
                    faces.inside[body].push(face);
                }
            }
        }
        let mut numbers = vec![[None; 2]; cells];
        let mut wanted: Vec<Face> = Vec::new();
        for axis in 0..2 {
            let fluid = (0..cells).map(|cell| Face { axis, cell }).filter(|&face| !is_inside(face));
            for face in fluid {
                wanted.extend(faces.read_by(face).filter(|&read| is_inside(read)));
            }
        }
        let mut next = 0;
        while next < wanted.len() {
            let face = wanted[next];
            next += 1;
            if numbers[face.cell][face.axis].is_some() {
                continue;
            }
            let Nearest { body, distance, normal } = at(face);
            let position = faces.position(face);
            let spacing = mesh.spacing();
            let [near, far] = PROBES.map(|probe| probe * spacing[0].max(spacing[1]));
            let depth = -distance;
            let weights = [
                depth * (depth + far) / (near * (far - near)),
                -depth * (depth + near) / (far * (far - near)),
            ];
            let mut image = Vec::new();
            for (above, weight) in [near, far].into_iter().zip(weights) {
                let probe = std::array::from_fn(|b| position[b] + (depth + above) * normal[b]);
                if nearest(mesh, bodies, probe).distance < near * (1.0 - 1e-9) {
                    return Err(FdError::Gap { number: body, position: probe });
                }
                let around = faces.around(face.axis, probe, body)?;
                image.extend(around.into_iter().map(|(face, share)| (face, weight * share)));
            }
            wanted.extend(image.iter().map(|&(face, _)| face).filter(|&face| is_inside(face)));
            numbers[face.cell][face.axis] = Some(faces.ghosts.len());
            let wall_velocity = bodies[body].surface_velocity[face.axis];
            let sum = wall_velocity * (depth + near) * (depth + far) / (near * far);
            faces.ghosts.push(Ghost { face, image, sum });
        }
        let number = |face: Face| numbers[face.cell][face.axis];
        faces.compartments = faces.find_compartments(is_inside, number);
        for (number, inside) in faces.inside.iter().enumerate() {
            let is_in_one = |ghost: &(usize, f64)| inside.contains(&faces.ghosts[ghost.0].face);
            if !faces.compartments.iter().any(|all| all.iter().any(is_in_one)) {
                let cause =
                    "it holds no cell with fluid on none of its sides: the mesh is too coarse";
                return Err(FdError::Body { number, cause: cause.to_owned() });
            }
        }
        Ok(faces)
    }

    /// The cells on both sides of a face, the lower one first; that of a wall is missing.
    pub fn cells(&self, face: Face) -> [Option<usize>; 2] {
        [self.moved(face.cell, face.axis, -1), Some(face.cell)]
    }

    fn position(&self, face: Face) -> [f64; 3] {
        let mut position = self.mesh.position(self.point(face.cell));
        position[face.axis] -= 0.5 * self.mesh.spacing()[face.axis];
        position
    }

    fn point(&self, cell: usize) -> [usize; 3] {
        let nx = self.mesh.shape()[0];
        [cell % nx, cell / nx, 0]
    }

    /// The cell so many further along an axis, if there is one.
    fn moved(&self, cell: usize, axis: usize, by: isize) -> Option<usize> {
        let mut point = self.point(cell);
        point[axis] = self.wrapped(axis, point[axis] as isize + by)?;
        Some(point[1] * self.mesh.shape()[0] + point[0])
    }

    fn wrapped(&self, axis: usize, i: isize) -> Option<usize> {
        let side = self.mesh.sides()[axis];
        let n = side.points as isize;
        let wrapped = if side.spread == Spread::Periodic { i.rem_euclid(n) } else { i };
        (0..n).contains(&wrapped).then_some(wrapped as usize)
    }

    /// The other faces that the equation of a face of the fluid reads.
    fn read_by(&self, face: Face) -> impl Iterator<Item = Face> {
        let Face { axis, cell } = face;
        let other = 1 - axis;
        let beside = (0..2).flat_map(move |a| [-1, 1].map(|by| (a, by)));
        let same =
            beside.filter_map(move |(a, by)| Some(Face { axis, cell: self.moved(cell, a, by)? }));
        let cells = [Some(cell), self.moved(cell, axis, -1)].into_iter().flatten();
        let ends = cells.flat_map(move |cell| [Some(cell), self.moved(cell, other, 1)]);
        same.chain(ends.flatten().map(move |cell| Face { axis: other, cell }))
    }

    /// The nine faces around a point, with the weights of quadratic interpolation along both axes.
    fn around(
        &self,
        axis: usize,
        position: [f64; 3],
        number: usize,
    ) -> Result<[(Face, f64); 9], FdError> {
        let (first, spacing) = (self.position(Face { axis, cell: 0 }), self.mesh.spacing());
        let place = [0, 1].map(|a| (position[a] - first[a]) / spacing[a]);
        let weights = place.map(|place| {
            let x = place - place.round();
            [0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)]
        });
        let mut found = [(Face { axis, cell: 0 }, 0.0); 9];
        for (n, found) in found.iter_mut().enumerate() {
            let by = [n % 3, n / 3];
            let mut point = [0; 2];
            for a in 0..2 {
                let i = place[a].round() as isize + by[a] as isize - 1;
                point[a] =
                    self.wrapped(a, i).ok_or(FdError::BodyAtEnd { number, axis: AXES[a] })?;
            }
            let cell = point[1] * self.mesh.shape()[0] + point[0];
            *found = (Face { axis, cell }, weights[0][by[0]] * weights[1][by[1]]);
        }
        Ok(found)
    }

    /// Refuses a body with a face in the first or last layer of cells along an axis with ends.
    fn refuse_ends(&self, face: Face, number: usize, beyond: Option<Layer>) -> Result<(), FdError> {
        for (a, side) in self.mesh.sides().iter().enumerate() {
            let i = self.point(face.cell)[a];
            let last = side.points - 1 - usize::from(beyond.is_some_and(|layer| layer.axis == a));
            if side.spread != Spread::Periodic && (i == 0 || i >= last) {
                return Err(FdError::BodyAtEnd { number, axis: AXES[a] });
            }
        }
        Ok(())
    }

    fn find_compartments(
        &self,
        is_inside: impl Fn(Face) -> bool,
        number: impl Fn(Face) -> Option<usize>,
    ) -> Vec<Vec<(usize, f64)>> {
        let cells = self.mesh.points();
        // Lower and upper faces.
        let faces_of = |cell: usize| {
            [0, 1].into_iter().flat_map(move |axis| {
                let upper = self.moved(cell, axis, 1).map(|cell| Face { axis, cell });
                [Some(Face { axis, cell }), upper]
            })
        };
        let is_within = |cell: usize| faces_of(cell).all(|face| face.is_some_and(&is_inside));
        let mut compartment: Vec<Option<usize>> = vec![None; cells];
        let mut count = 0;
        for start in 0..cells {
            if compartment[start].is_some() || !is_within(start) {
                continue;
            }
            let mut waiting = vec![start];
            while let Some(cell) = waiting.pop() {
                if compartment[cell].replace(count).is_some() {
                    continue;
                }
                let open = faces_of(cell).flatten().filter(|&face| number(face).is_none());
                let beyond = open.flat_map(|face| self.cells(face)).flatten();
                waiting.extend(beyond.filter(|&cell| compartment[cell].is_none()));
            }
            count += 1;
        }
        let mut outlines = vec![Vec::new(); count];
        for (n, ghost) in self.ghosts.iter().enumerate() {
            let sides = self.cells(ghost.face).map(|cell| cell.and_then(|cell| compartment[cell]));
            if sides[0] != sides[1] {
                for (side, sign) in sides.into_iter().zip([-1.0, 1.0]) {
                    if let Some(number) = side {
                        outlines[number].push((n, sign));
                    }
                }
            }
        }
        outlines
    }
}

/// The body nearest to a point, through whatever periodic image.
fn nearest(mesh: &Mesh, bodies: &[Body], position: [f64; 3]) -> Nearest {
    let mut nearest = Nearest { body: 0, distance: f64::INFINITY, normal: [1.0, 0.0, 0.0] };
    for (body, Body { shape, .. }) in bodies.iter().enumerate() {
        let images = |a: usize| {
            let side = mesh.sides()[a];
            let is_seen =
                side.spread == Spread::Periodic && !matches!(shape, Shape::HalfSpace { .. });
            let length = if is_seen { side.upper - side.lower } else { 0.0 };
            [0.0, -length, length].into_iter().take(if is_seen { 3 } else { 1 })
        };
        for shift in images(1).flat_map(|y| images(0).map(move |x| [x, y])) {
            let seen = [position[0] + shift[0], position[1] + shift[1], 0.0];
            let distance = shape.signed_distance(seen);
            if distance < nearest.distance {
                nearest = Nearest { body, distance, normal: shape.normal(seen) };
            }
        }
    }
    nearest
}
