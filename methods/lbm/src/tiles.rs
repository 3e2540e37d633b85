//! The grid of the sites, cut into tiles.

use finegrain_framework::space::Grid;

use crate::in_place;
use crate::lattice::LatticeKind;
use crate::mesh::Mesh;
use crate::physics::Streaming;

/// Sites of a tile: rows next to one another in one plane. Every population is read once a step, so that
/// compact tiles would reuse nothing; long stretches of memory are what it is fastest to walk along, and
/// with tiles one plane thick those who run ahead stay few planes apart, so that these stay in the cache.
const TILE: usize = 4096;

/// The grid of a mesh.
pub(crate) fn grid(mesh: &Mesh, lattice: LatticeKind, streaming: Streaming) -> Grid {
    cut(mesh, lattice, streaming, [(TILE / mesh.shape[0]).max(1), 1])
}

/// The same with tiles of so many rows and planes.
fn cut(
    mesh: &Mesh,
    lattice: LatticeKind,
    streaming: Streaming,
    [rows, planes]: [usize; 2],
) -> Grid {
    let grid = Grid::builder(mesh.shape).origin(mesh.position([0; 3])).spacing([mesh.spacing; 3]);
    let grid = grid.tile(rows, planes);
    match streaming {
        Streaming::TwoGrids => grid.periodic(mesh.periodic),
        // What leaves the mesh is kept at its other end.
        Streaming::InPlace => {
            grid.periodic([true; 3]).shifts(&in_place::offsets(lattice.velocities()))
        }
    }
    .build()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use finegrain_framework::shape::{Axis, Shape};
    use finegrain_framework::{Columns, Schedule, Settings, Simulation, VectorField};

    use super::*;
    use crate::model::{Compiled, Lbm};
    use crate::opening::{Condition, Opening};
    use crate::physics::{Fluid, Physics, Scheme};
    use crate::{Body, Start, Wall};

    /// A box with a post through all planes and a ball in several, both on the edges of most tiles; two walls
    /// beyond the last planes, or rows, of the mesh, one of which slides, and the other ends periodic.
    fn between_walls(lattice: LatticeKind) -> (Mesh, Physics) {
        let is_plane = lattice.dims() == 2;
        let mesh = mesh(lattice, [true, !is_plane, is_plane]);
        let across = if is_plane { 1 } else { 2 };
        let wall = |at: f64, towards: f64| {
            let (mut point, mut outward) = ([0.0; 3], [0.0; 3]);
            (point[across], outward[across]) = (at, towards);
            Shape::HalfSpace { point, outward }
        };
        let end = mesh.shape[across] as f64 * mesh.spacing;
        let post = Shape::Cylinder { axis: Axis::Z, centre: [0.9, 0.6, 0.0], radius: 0.27 };
        // Over the periodic end of rows.
        let ball = Shape::Sphere { centre: [2.1, 1.15, 0.45], radius: 0.26 };
        let belt = Body { shape: post, surface_velocity: [0.2, 0.1, 0.0] };
        let lid = Body { shape: wall(end, -1.0), surface_velocity: [0.3, 0.1, 0.0] };
        let mut bodies = vec![wall(0.0, 1.0).into(), lid, belt];
        if !is_plane {
            bodies.push(ball.into());
        }
        let field = VectorField::new(|[x, y, _], t| [0.1 * (x + t).sin(), 0.1 * y.cos(), 0.05]);
        (mesh, Physics { bodies, acceleration_field: Some(field), ..Physics::default() })
    }

    /// From one row of the mesh to another, through all tiles, around a post.
    fn between_openings(lattice: LatticeKind, outlet: Condition) -> (Mesh, Physics) {
        let mesh = mesh(lattice, [true, false, true]);
        let post = Shape::Cylinder { axis: Axis::Z, centre: [0.9, 0.6, 0.0], radius: 0.27 };
        let inlet = VectorField::new(|[x, ..], t| [0.0, 0.2 * (x + t).sin().powi(2), 0.0]);
        let opening = |is_upper, condition| Opening { axis: Axis::Y, is_upper, condition };
        let openings = vec![opening(false, Condition::Velocity(inlet)), opening(true, outlet)];
        (mesh, Physics { bodies: vec![post.into()], openings, ..Physics::default() })
    }

    fn mesh(lattice: LatticeKind, periodic: [bool; 3]) -> Mesh {
        let depth = if lattice.dims() == 2 { 1 } else { 9 };
        Mesh { shape: [27, 12, depth], corner: [0.0; 3], spacing: 0.1, time_step: 0.01, periodic }
    }

    /// All that lives on after some steps, in tiles of so many rows and planes; in the tiles that a mesh is cut
    /// into by default without.
    fn outcome<T: Compiled>(
        (mesh, physics): &(Mesh, Physics),
        scheme: &Scheme,
        tile: Option<[usize; 2]>,
    ) -> Vec<Vec<u8>> {
        let fluid = Fluid { density: 2.0, kinematic_viscosity: 0.02, largest_speed: 0.5 };
        let start = Start::with_velocity(|[x, y, z]| {
            [0.1 * (TAU * y / 1.2).sin(), 0.1 * (TAU * x / 2.7).cos(), 0.05 * (TAU * z / 0.9).sin()]
        });
        let mut lbm = Lbm::<T>::new(mesh, &fluid, physics, scheme, &start).unwrap();
        if let Some(tile) = tile {
            let streaming = scheme.streaming(physics).unwrap();
            lbm.model.domain = cut(mesh, scheme.lattice, streaming, tile);
        }
        let settings =
            Settings { schedule: Schedule::PeerToPeer, workers: 3, ..Settings::default() };
        let mut simulation = Simulation::new(lbm.model, settings).unwrap();
        simulation.advance(17).unwrap();
        simulation.derive().unwrap();
        let columns: &Columns = simulation.columns();
        columns.iter().map(|(id, _)| columns.bytes(id).to_vec()).collect()
    }

    fn same_in_all_tiles<T: Compiled>(lattice: LatticeKind) {
        let in_place = Scheme { wall: Wall::HalfWay, ..Scheme::on(lattice) };
        let two_grids = Scheme::on(lattice);
        let outlet = Condition::NonReflecting { pressure: 0.01, relaxation: 0.1 };
        for (modelled, scheme) in [
            (between_walls(lattice), in_place),
            (between_walls(lattice), two_grids),
            (between_openings(lattice, Condition::Pressure(0.01)), in_place),
            (between_openings(lattice, outlet), two_grids),
        ] {
            let expected = outcome::<T>(&modelled, &scheme, Some([12, 9]));
            for tile in [None, Some([1, 1]), Some([5, 1]), Some([1, 4]), Some([7, 2])] {
                let found = outcome::<T>(&modelled, &scheme, tile);
                assert!(found == expected, "tiles of {tile:?} on {lattice:?}, {scheme:?}");
            }
        }
    }

    #[test]
    fn tiles_of_any_size_have_the_same_bits() {
        same_in_all_tiles::<f64>(LatticeKind::D2Q9);
        same_in_all_tiles::<f64>(LatticeKind::D3Q19);
        same_in_all_tiles::<f32>(LatticeKind::D3Q27);
    }

    /// One plane thick, and several in a plane that is large enough.
    #[test]
    fn tiles_are_thin() {
        let tiles = |shape| {
            let mesh = Mesh { shape, ..mesh(LatticeKind::D3Q19, [true; 3]) };
            let grid = grid(&mesh, LatticeKind::D3Q19, Streaming::InPlace);
            finegrain_framework::Domain::partition(&grid).len()
        };
        assert_eq!(tiles([27, 12, 9]), 9);
        assert_eq!(tiles([128, 128, 8]), 4 * 8);
        assert_eq!(tiles([5000, 3, 2]), 6);
    }
}
