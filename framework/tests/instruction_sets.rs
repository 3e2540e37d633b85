//! A checkpoint remembers what the run was computed with.

use finegrain_framework::space::Independent;
use finegrain_framework::*;

fn model() -> Model<Independent> {
    let mut columns = Columns::new(4);
    columns.state::<f64>("x");
    Model::with_fixed_dt("rest", Independent::new(4), columns, Step::builder().build(), 0.1)
}

#[test]
fn are_recorded_and_survive_a_restart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("step3.ckpt");
    let mut first = Simulation::new(model(), Settings::default()).unwrap();
    first.advance(3).unwrap();
    assert_eq!(first.instruction_sets(), [lanes::instruction_set()]);
    first.save(&path, 1).unwrap();
    let mut second = Simulation::new(model(), Settings::default()).unwrap();
    second.restore(&path, 1).unwrap();
    // The same one is not named twice.
    assert_eq!(second.instruction_sets(), [lanes::instruction_set()]);
    // The file itself names it, so that another processor can know.
    let bytes = std::fs::read(&path).unwrap();
    let name = lanes::instruction_set().as_bytes();
    assert!(bytes.windows(name.len()).any(|window| window == name));
}
