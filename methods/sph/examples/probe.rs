use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::cells::Region;
use finegrain_framework::*;
use finegrain_sph::*;
use std::time::Instant;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    match args[1].as_str() {
        "cyl" => cyl(&args),
        _ => bench(&args),
    }
}

fn bench(args: &[String]) {
    let w: f64 = args[2].parse().unwrap();
    let visc = if args[3] == "morris" { Viscosity::Morris } else { Viscosity::StrainRate };
    let workers: usize = args[4].parse().unwrap();
    let d = 0.0002;
    let lattice = Packing::HexagonalClosePacked.fit([0.025, 0.025, w], d).unwrap();
    let l = lattice.lengths();
    let c = [l[0] / 2.0, l[1] / 2.0, 0.0];
    let body = Shape::Cylinder { axis: Axis::Z, centre: c, radius: 0.005 };
    let start = Start {
        region: Region { lower: vec![0.0; 3], upper: l.to_vec(), periodic: vec![true; 3] },
        spacing: d,
        particle_volume: lattice.volume_per_particle(),
        positions: lattice.positions().collect(),
        velocities: vec![],
    };
    let fluid = Fluid {
        density: 1000.0,
        sound_speed: 4e-3,
        kinematic_viscosity: 1e-6,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let physics = Physics {
        viscosity: Some(visc),
        energy: false,
        body_acceleration: [9.8e-6, 0.0, 0.0],
        bodies: vec![body],
    };
    let t = Instant::now();
    let sph = Sph::<f64>::new(&start, &fluid, &physics, &Scheme::default()).unwrap();
    println!("{} particles, build {:?}", start.positions.len(), t.elapsed());
    let n = start.positions.len();
    let mut sim = Simulation::new(sph.model, Settings { workers, ..Settings::default() }).unwrap();
    let t = Instant::now();
    sim.begin().unwrap();
    println!(
        "begin {:?} dt {:.3e} pace {} subdomains {}",
        t.elapsed(),
        sim.clock().dt(),
        sim.pace_left(),
        sim.domain().partition().len()
    );
    for _ in 0..3 {
        let t = Instant::now();
        sim.advance(4).unwrap();
        let s = t.elapsed().as_secs_f64() / 4.0;
        println!(
            "step {:.4} s  {:.3} us/particle/core  {:.1} Mpairs/s/core pace {}",
            s,
            s / n as f64 * 1e6 * workers as f64,
            160.0 * n as f64 / s / 1e6 / workers as f64,
            sim.pace_left()
        );
    }
    let t = Instant::now();
    let w = sim.whole();
    w.domain.sort(w.columns, w.team).unwrap();
    println!("sort {:?}", t.elapsed());
    println!("{:016x}", sim.state_hash());
}

fn cyl(args: &[String]) {
    let n: f64 = args[2].parse().unwrap();
    let visc = if args[3] == "morris" { Viscosity::Morris } else { Viscosity::StrainRate };
    let background: f64 = args[4].parse().unwrap();
    let beta: f64 = args[5].parse().unwrap();
    let packing = if args[6] == "hex" { Packing::Hexagonal } else { Packing::Square };
    let kernel = if args[7] == "quintic" {
        SmoothingFunction::QuinticSpline
    } else {
        SmoothingFunction::Gaussian
    };
    let ratio: f64 = args[8].parse().unwrap();
    let cfac: f64 = args[9].parse().unwrap();
    let big_l = 0.1;
    let d = big_l / n;
    let lattice = packing.fit([big_l, big_l, 0.0], d).unwrap();
    let l = lattice.lengths();
    let body =
        Shape::Cylinder { axis: Axis::Z, centre: [l[0] / 2.0, l[1] / 2.0, 0.0], radius: 0.02 };
    let start = Start {
        region: Region { lower: vec![0.0; 2], upper: l[..2].to_vec(), periodic: vec![true; 2] },
        spacing: d,
        particle_volume: lattice.volume_per_particle(),
        positions: lattice.positions().collect(),
        velocities: vec![],
    };
    let (nu, f) = (1e-4, 5e-5);
    let fluid = Fluid {
        density: 1000.0,
        sound_speed: cfac,
        kinematic_viscosity: nu,
        state_equation: StateEquation::Linear { background },
    };
    let physics = Physics {
        viscosity: Some(visc),
        energy: false,
        body_acceleration: [f, 0.0, 0.0],
        bodies: vec![body],
    };
    let scheme = Scheme { beta_max: beta, kernel, smoothing_ratio: ratio, ..Scheme::default() };
    let sph = Sph::<f64>::new(&start, &fluid, &physics, &scheme).unwrap();
    let (fields, mass) = (sph.fields.clone(), sph.particle_mass);
    let mut sim =
        Simulation::new(sph.model, Settings { workers: 1, ..Settings::default() }).unwrap();
    let t = Instant::now();
    let end = 40.0;
    let mut k = 0.0;
    let mut next = 4.0;
    while sim.clock().time() < end {
        if let Err(e) = sim.advance(20) {
            println!("{e}");
            return;
        }
        if sim.clock().time() >= next {
            next += 4.0;
            let totals = measure::totals(&mut sim.whole(), &fields, mass);
            let u = totals.flow[0] / (l[0] * l[1]);
            k = f * l[0] * l[1] / (nu * u);
            let vmax = measure::largest_speed(&mut sim.whole(), &fields);
            println!(
                "t {:.2} k {:.4} ({:+.2}%) uy/ux {:.1e} vmax {:.3e} fluid area {:.6} steps {} {:?}",
                sim.clock().time(),
                k,
                100.0 * (k / 30.3506 - 1.0),
                totals.flow[1] / totals.flow[0],
                vmax,
                totals.volume / (l[0] * l[1]),
                sim.clock().step(),
                t.elapsed()
            );
        }
    }
    let _ = k;
}
