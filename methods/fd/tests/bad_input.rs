//! Bad input gets an error that names what and where, and never a panic.

use finegrain_fd::{
    Advection, Body, Boundary, Burgers, Condition, Drift, Face, FdError, FlowEnd, Gas, GasEnd,
    GasState, Heat, Implicit, Mesh, NavierStokes, Order, Side, StaggeredOrder, TimeStepping, Wave,
};
use finegrain_framework::Integrator;
use finegrain_framework::shape::{Axis, Shape};

fn said<M>(result: Result<M, FdError>) -> String {
    match result {
        Ok(_) => panic!("must be refused"),
        Err(error) => error.to_string(),
    }
}

fn heat() -> Heat {
    Heat {
        diffusivity: 1.0,
        order: Order::Fourth,
        integrator: Integrator::Rk4.into(),
        boundary: Boundary::all(Condition::dirichlet(0.0)),
    }
}

fn closed(points: usize) -> Mesh {
    Mesh::new([Side::periodic(32, 0.0, 1.0), Side::ends(points, 0.0, 1.0)])
}

fn of_heat(heat: &Heat, mesh: &Mesh) -> String {
    said(heat.model::<f64>(mesh, 1e-6, &|_| 0.0))
}

#[test]
fn a_time_step_past_the_limit() {
    let (heat, mesh) = (heat(), closed(32));
    let limit = heat.time_step_limit(&mesh).unwrap();
    let text = said(heat.model::<f64>(&mesh, 1.01 * limit, &|_| 0.0));
    let named = format!("at most {limit:e} s");
    assert!(text.contains(&named) && text.contains("rk4") && text.contains("order 4"), "{text}");
    assert!(heat.model::<f64>(&mesh, limit, &|_| 0.0).is_ok());
    let text = said(heat.model::<f64>(&mesh, f64::NAN, &|_| 0.0));
    assert!(text.contains("time_step is NaN"), "{text}");
    let boundary = Boundary::all(Condition::Outflow);
    let wave = Wave { speed: 2.0, order: Order::Eighth, boundary: boundary.clone() };
    let mesh = Mesh::new([Side::periodic(32, 0.0, 1.0)]);
    let text = said(wave.model::<f32>(&mesh, 0.1, &|_| 0.0, &|_| 0.0));
    assert!(text.contains("leapfrog") && text.contains("order 8"), "{text}");
    let advection = Advection { face: Face::Weno5, integrator: Integrator::Euler, boundary };
    let text = said(advection.model::<f64>(&mesh, 1e-6, &|_| [1.0; 3], &|_| 0.0));
    assert!(text.contains("weno5 with euler") && text.contains("not stable"), "{text}");
}

#[test]
fn implicit_steps_take_any_length_but_none_that_is_no_length() {
    let heat = Heat { integrator: Implicit::Bdf2.into(), ..heat() };
    assert_eq!(heat.time_step_limit(&closed(32)), Ok(f64::INFINITY));
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let text = said(heat.model::<f64>(&closed(32), dt, &|_| 0.0));
        assert!(text.contains(&format!("time_step is {dt}")), "{text}");
    }
    let mut open = heat.clone();
    open.boundary.0[1][1] = Condition::Outflow;
    assert!(of_heat(&open, &closed(32)).contains("second derivative"));
    assert!(of_heat(&heat, &closed(9)).contains("9 points along y"));
    if cfg!(feature = "implicit") {
        assert!(heat.model::<f64>(&closed(32), 1e3, &|_| 0.0).is_ok());
    } else {
        let text = of_heat(&heat, &closed(32));
        assert!(
            text.contains("integrator = bdf2") && text.contains("feature `implicit`"),
            "{text}"
        );
    }
    let text = "crank-nicholson".parse::<TimeStepping>().unwrap_err();
    assert!(text.contains("crank-nicolson") && text.contains("rk4"), "{text}");
    assert_eq!("crank-nicolson".parse(), Ok(TimeStepping::from(Implicit::CrankNicolson)));
    assert_eq!("ssp-rk3".parse(), Ok(TimeStepping::from(Integrator::SspRk3)));
}

#[test]
fn numbers_outside_their_range() {
    let heat = Heat { diffusivity: -1.0, ..heat() };
    assert!(of_heat(&heat, &closed(32)).contains("diffusivity is -1"));
    let wave = Wave { speed: 0.0, order: Order::Second, boundary: heat.boundary.clone() };
    assert!(said(wave.time_step_limit(&closed(32))).contains("speed is 0"));
    let burgers = Burgers {
        viscosity: f64::INFINITY,
        face: Face::Weno5,
        integrator: Integrator::SspRk3,
        boundary: heat.boundary,
    };
    assert!(said(burgers.time_step_limit(&closed(32), 1.0)).contains("viscosity is inf"));
}

#[test]
fn meshes_that_do_not_go_with_the_scheme() {
    assert!(of_heat(&heat(), &closed(9)).contains("9 points along y; there must be at least 10"));
    let none = Mesh::new([Side::periodic(0, 0.0, 1.0)]);
    assert!(of_heat(&heat(), &none).contains("0 points along x"));
    let reversed = Mesh::new([Side::periodic(32, 1.0, 0.5)]);
    assert!(of_heat(&heat(), &reversed).contains("along x the mesh goes from 1 m to 0.5 m"));
    let eighth = Heat { order: Order::Eighth, ..heat() };
    assert!(of_heat(&eighth, &closed(64)).contains("no closure of order 8"));
    let boundary = Boundary::all(Condition::Outflow);
    let advection = Advection { face: Face::Weno5, integrator: Integrator::SspRk3, boundary };
    let text = said(advection.model::<f64>(&closed(32), 1e-6, &|_| [1.0; 3], &|_| 0.0));
    assert!(text.contains("along y") && text.contains("middle of cells"), "{text}");
}

#[test]
fn conditions_that_make_no_sense() {
    let with = |condition: Condition| {
        let mut heat = heat();
        heat.boundary.0[1][1] = condition;
        of_heat(&heat, &closed(32))
    };
    let text = with(Condition::robin(-1.0, 0.5, 0.0));
    assert!(text.contains("upper end of y") && text.contains("value is -1"), "{text}");
    assert!(with(Condition::robin(1.0, 0.0, 0.0)).contains("slope is 0"));
    assert!(with(Condition::dirichlet(f64::NAN)).contains("NaN"));
    assert!(with(Condition::Outflow).contains("second derivative"));
    let (velocity, order, integrator) = ([0.0, 1.0, 0.0], Order::Fourth, Integrator::Rk4);
    let mut drift = Drift { velocity, order, integrator, boundary: heat().boundary };
    let text = said(drift.model::<f64>(&closed(32), 1e-6, &|_| 0.0));
    assert!(text.contains("upper end of y") && text.contains("flows in"), "{text}");
    drift.boundary.0[1][1] = Condition::Outflow;
    assert!(drift.model::<f64>(&closed(32), 1e-6, &|_| 0.0).is_ok());
}

#[test]
fn a_start_that_is_not_a_number() {
    let text = said(heat().model::<f64>(&closed(32), 1e-6, &|x| 1.0 / (x[0] - 0.5)));
    assert!(text.contains("initial temperature at [0.5, 0.0, 0.0]"), "{text}");
}

#[test]
fn a_gas_that_is_none() {
    let gas = Gas { heat_ratio: 1.4, courant: 0.4, ends: [[GasEnd::Open; 2]; 2] };
    let air = GasState { density: 1.0, velocity: [0.0; 3], pressure: 1.0 };
    let line = Mesh::new([Side::cells(20, 0.0, 1.0)]);
    let of = |gas: Gas, state: GasState, mesh: &Mesh| said(gas.model::<f64>(mesh, &|_| state));
    let text = of(Gas { courant: 0.6, ..gas }, air, &line);
    assert!(text.contains("courant is 0.6") && text.contains("at most 0.5"), "{text}");
    assert!(of(Gas { heat_ratio: 1.0, ..gas }, air, &line).contains("heat_ratio is 1"));
    let text = of(gas, GasState { pressure: 0.0, ..air }, &line);
    assert!(text.contains("initial pressure at [0.025") && text.contains("above zero"), "{text}");
    let space = Mesh::new([Side::cells(9, 0.0, 1.0); 3]);
    assert!(of(gas, air, &space).contains("directions of a gas is 3"));
}

fn flow() -> NavierStokes {
    NavierStokes {
        viscosity: 0.1,
        acceleration: [0.0; 3],
        ends: [[FlowEnd::REST; 2]; 3],
        bodies: Vec::new(),
        order: StaggeredOrder::Second,
        integrator: Integrator::Rk4,
        courant: 0.8,
    }
}

#[test]
fn bodies_that_do_not_fit() {
    let of = |bodies: &[(Shape, [f64; 3])], order, mesh: &Mesh| {
        let body = |&(shape, surface_velocity)| Body { shape, surface_velocity };
        let flow = NavierStokes { bodies: bodies.iter().map(body).collect(), order, ..flow() };
        said(flow.model::<f64>(mesh, &|_| [0.0; 3]))
    };
    let disc = |x: f64, y: f64, radius: f64| {
        (Shape::Cylinder { axis: Axis::Z, centre: [x, y, 0.0], radius }, [0.0; 3])
    };
    let second = |bodies: &[_]| {
        let mesh = Mesh::new([Side::periodic(32, 0.0, 1.0), Side::cells(32, 0.0, 1.0)]);
        of(bodies, StaggeredOrder::Second, &mesh)
    };
    let text = second(&[disc(0.5, 0.5, 0.2), disc(0.1, 0.1, -0.1)]);
    assert!(text.contains("body 1") && text.contains("not -0.1"), "{text}");
    let (shape, _) = disc(0.5, 0.5, 0.2);
    let text = second(&[(shape, [0.0, f64::NAN, 0.0])]);
    assert!(text.contains("surface_velocity is NaN"), "{text}");
    for y in [0.05, 0.95, 0.21] {
        let text = second(&[disc(0.5, y, 0.2)]);
        assert!(text.contains("body 0") && text.contains("end of y"), "{y}: {text}");
    }
    let mut open = [[FlowEnd::REST; 2]; 3];
    open[1] = [FlowEnd::Inflow, FlowEnd::Outflow];
    let mesh = Mesh::new([Side::periodic(32, 0.0, 1.0), Side::cells(33, 0.0, 33.0 / 32.0)]);
    // In the last layer of cells before the end, and well before it.
    let body =
        |y: f64| NavierStokes { ends: open, bodies: vec![disc(0.5, y, 0.2).0.into()], ..flow() };
    assert!(said(body(0.79).model::<f64>(&mesh, &|_| [0.0; 3])).contains("end of y"));
    assert!(body(0.7).model::<f64>(&mesh, &|_| [0.0; 3]).is_ok());
    let plane = Shape::HalfSpace { point: [0.0, 0.3, 0.0], outward: [0.0, 1.0, 0.0] };
    assert!(second(&[(plane, [0.0; 3])]).contains("end of y"));
    let text = second(&[disc(0.2, 0.5, 0.15), disc(0.53, 0.5, 0.15)]);
    assert!(text.contains("narrower than the mesh resolves"), "{text}");
    let text = second(&[disc(0.5, 0.5, 0.02)]);
    assert!(text.contains("too coarse"), "{text}");
    let box_of = |dims: usize| match dims {
        2 => Mesh::new([Side::periodic(32, 0.0, 1.0); 2]),
        _ => Mesh::new([Side::periodic(32, 0.0, 1.0); 3]),
    };
    for (order, dims) in [(StaggeredOrder::Fourth, 2), (StaggeredOrder::Second, 3)] {
        let text = of(&[disc(0.5, 0.5, 0.2)], order, &box_of(dims));
        assert!(text.contains("two directions and operators of order 2"), "{text}");
    }
}

#[test]
fn a_flow_that_is_none() {
    let flow = flow();
    let of = |flow: NavierStokes, mesh: &Mesh| said(flow.model::<f64>(mesh, &|_| [0.0; 3]));
    let cavity = Mesh::new([Side::cells(16, 0.0, 1.0); 2]);
    assert!(
        of(NavierStokes { viscosity: 0.0, ..flow.clone() }, &cavity).contains("viscosity is 0")
    );
    let text = of(NavierStokes { courant: 1.2, ..flow.clone() }, &cavity);
    assert!(text.contains("courant is 1.2") && text.contains("at most 1"), "{text}");
    let acceleration = [0.0, f64::NAN, 0.0];
    let text = of(NavierStokes { acceleration, ..flow.clone() }, &cavity);
    assert!(text.contains("acceleration is NaN"), "{text}");
    let mut leaking = flow.clone();
    leaking.ends[1][0] = FlowEnd::Wall([1.0, 0.5, 0.0]);
    let text = of(leaking, &cavity);
    assert!(text.contains("lower end of y") && text.contains("along the wall"), "{text}");
    for (ends, said) in [
        ([FlowEnd::REST, FlowEnd::Inflow], "upper end of y: fluid comes in at lower ends"),
        ([FlowEnd::Inflow, FlowEnd::REST], "lower end of y: fluid comes in at lower ends"),
        ([FlowEnd::Outflow, FlowEnd::REST], "lower end of y: fluid leaves at one upper end only"),
    ] {
        let mut closed = flow.clone();
        closed.ends[1] = ends;
        let text = of(closed, &cavity);
        assert!(text.contains(said), "{text}");
    }
    let mut twice = flow.clone();
    twice.ends[0][1] = FlowEnd::Outflow;
    twice.ends[1][1] = FlowEnd::Outflow;
    assert!(of(twice, &cavity).contains("upper end of y: fluid leaves at one upper end only"));
    let text = of(NavierStokes { integrator: Integrator::Leapfrog, ..flow.clone() }, &cavity);
    assert!(text.contains("leapfrog") && text.contains("not stable"), "{text}");
    let few = Mesh::new([Side::cells(16, 0.0, 1.0), Side::periodic(3, 0.0, 1.0)]);
    assert!(of(flow.clone(), &few).contains("3 points along y; there must be at least 4"));
    let ends = Mesh::new([Side::ends(16, 0.0, 1.0); 2]);
    assert!(of(flow.clone(), &ends).contains("middle of cells"));
    let line = Mesh::new([Side::cells(16, 0.0, 1.0)]);
    assert!(of(flow.clone(), &line).contains("directions of a flow is 1"));
    let text = said(flow.model::<f64>(&cavity, &|x| [0.0, 1.0 / (x[1] - 0.5), 0.0]));
    assert!(text.contains("initial velocity_y at [0.03125, 0.5, 0.0]"), "{text}");
}
