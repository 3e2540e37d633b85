//! Notes that a sub-domain takes in one rate stage are what its later rate stage reads, whoever runs it.

mod models;

use finegrain_framework::space::Grid;
use finegrain_framework::*;
use models::closures::{rate_stage, update_stage};

/// A row of 40 points in tiles of 3: each notes its points with an even value above 10, of which every
/// tile has another number, and adds up what it has noted.
fn sums(settings: Settings) -> Vec<f64> {
    let domain = Grid::builder([1, 40]).tile(3, 1).build();
    let mut columns = Columns::new(domain.points());
    let (value, sum) = (columns.state::<f64>("value"), columns.rate::<f64>("sum"));
    let notes: Notes<Vec<u64>> = columns.notes();
    for (j, value) in columns.values_mut(value).iter_mut().enumerate() {
        *value = (j * j % 23) as f64;
    }
    let note = rate_stage("note", &[], move |near: &Near<'_, Grid>, rates, _| {
        let mut notes = rates.notes(notes);
        notes.clear();
        let values = near.state(value).own();
        for k in 0..near.spans().len() {
            let large = values.span(k).iter().filter(|&&x| x > 10.0 && x % 2.0 == 0.0);
            notes.extend(large.map(|&x| x as u64));
        }
        Ok(())
    });
    let add = rate_stage("add", &[sum.id()], move |_: &Near<'_, Grid>, rates, _| {
        let total = rates.notes(notes).iter().sum::<u64>() as f64;
        let mut sum = rates.column(sum);
        for k in 0..sum.spans() {
            sum.span(k).fill(total);
        }
        Ok(())
    });
    let advance = update_stage("advance", move |own: &mut Own<'_, Grid>, _| {
        let (mut value, sum) = (own.state_mut(value), own.rate(sum));
        for k in 0..value.spans() {
            for (value, sum) in value.span(k).iter_mut().zip(sum.span(k)) {
                *value = (*value + sum) % 29.0;
            }
        }
        Ok(())
    });
    let step =
        Step::builder().stage_at(0.0, &note).stage_at(0.0, &add).stage_at(0.0, &advance).build();
    let model = Model::with_fixed_dt("notes", domain, columns, step, 1.0);
    let mut simulation = Simulation::new(model, settings).unwrap();
    simulation.advance(7).unwrap();
    simulation.columns().values(value).to_vec()
}

/// The same without the framework.
fn expected() -> Vec<f64> {
    let mut values: Vec<f64> = (0..40).map(|j| (j * j % 23) as f64).collect();
    for _ in 0..7 {
        for tile in values.chunks_mut(3) {
            let total: f64 = tile.iter().filter(|&&x| x > 10.0 && x % 2.0 == 0.0).sum();
            tile.iter_mut().for_each(|x| *x = (*x + total) % 29.0);
        }
    }
    values
}

#[test]
fn a_later_stage_reads_what_the_sub_domain_has_noted() {
    for schedule in Schedule::ALL {
        for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 5 }] {
            let settings = Settings { schedule, workers: 3, hand_out, ..Settings::default() };
            assert_eq!(sums(settings), expected(), "{schedule}");
        }
    }
}
