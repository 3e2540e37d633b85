//! What a step costs, sub-domain by sub-domain, as a trace measured it: enough to work out how long it
//! would take on more workers.

use crate::domain::Domain;
use crate::simulation::Simulation;
use crate::trace::{Event, Trace};

/// What a step costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Workload {
    /// Every part of a step, in order.
    pub parts: Vec<PartCost>,
    /// The other sub-domains that each one reads, ascending.
    pub neighbours: Vec<Vec<u32>>,
    /// Time a step between legs of the workers, s: whole-domain work after steps, results, events. Some of
    /// it may be done by all workers together.
    pub between: f64,
    /// Steps that workers run without coming back, in the mean.
    pub steps_per_leg: f64,
    /// Size of all fields, bytes.
    pub bytes: usize,
}

/// What a part of a step costs.
#[derive(Clone, Debug, PartialEq)]
pub enum PartCost {
    /// One that workers run: time in each sub-domain, s.
    SubDomains(Vec<f64>),
    /// A whole-domain stage: its time, s.
    Whole(f64),
}

impl Workload {
    /// What the steps of a simulation cost so far, as far back as its trace remembers: the medians. `None`
    /// without a trace (see [`crate::Settings::trace`]), or if it does not know every part of every
    /// sub-domain.
    pub fn of<D: Domain>(simulation: &Simulation<D>) -> Option<Self> {
        let trace = simulation.trace()?;
        let partition = simulation.domain().partition();
        let columns = simulation.columns();
        Some(Self {
            parts: part_costs(trace, partition.len())?,
            neighbours: (0..partition.len()).map(|id| partition.neighbours(id).to_vec()).collect(),
            between: between(trace)?,
            steps_per_leg: steps_per_leg(trace)?,
            bytes: columns.iter().map(|(id, _)| columns.bytes(id).len()).sum(),
        })
    }

    /// Time of a step on one worker without any hand-out, s.
    pub fn seconds(&self) -> f64 {
        let part = |part: &PartCost| match part {
            PartCost::SubDomains(costs) => costs.iter().sum(),
            PartCost::Whole(cost) => *cost,
        };
        self.parts.iter().map(part).sum::<f64>() + self.between
    }
}

fn part_costs(trace: &Trace, sub_domains: usize) -> Option<Vec<PartCost>> {
    let mut samples = vec![Vec::new(); trace.parts().len() * sub_domains];
    for event in (0..trace.workers()).flat_map(|worker| trace.events(worker)) {
        // Cells may have had other sub-domains earlier.
        if (event.sub_domain as usize) < sub_domains {
            let place = event.part as usize * sub_domains + event.sub_domain as usize;
            samples[place].push(seconds(event.begin, event.end));
        }
    }
    let mut whole = vec![Vec::new(); trace.parts().len()];
    for event in trace.whole() {
        whole[event.part as usize].push(seconds(event.begin, event.end));
    }
    let part = |(part, whole): (usize, Vec<f64>)| match median(whole) {
        Some(cost) => Some(PartCost::Whole(cost)),
        None => {
            let samples = &mut samples[part * sub_domains..(part + 1) * sub_domains];
            let costs = samples.iter_mut().map(|samples| median(std::mem::take(samples)));
            costs.collect::<Option<_>>().map(PartCost::SubDomains)
        }
    };
    whole.into_iter().enumerate().map(part).collect()
}

/// Time between legs, but for whole-domain stages inside steps, a step.
fn between(trace: &Trace) -> Option<f64> {
    let legs = trace.legs();
    let (first, last) = (legs.first()?, legs.last()?);
    let steps = last.step - first.step;
    let apart: f64 = legs.windows(2).map(|pair| seconds(pair[0].end, pair[1].begin)).sum();
    let is_inside = |event: &&Event| event.begin >= first.end && event.end <= last.begin;
    let whole = trace.whole();
    let whole: f64 =
        whole.iter().filter(is_inside).map(|event| seconds(event.begin, event.end)).sum();
    (steps > 0).then(|| (apart - whole).max(0.0) / steps as f64)
}

fn steps_per_leg(trace: &Trace) -> Option<f64> {
    let legs = trace.legs();
    let steps = legs.last()?.step - legs.first()?.step;
    (steps > 0).then(|| steps as f64 / (legs.len() - 1) as f64)
}

fn seconds(begin: u64, end: u64) -> f64 {
    1e-9 * end.saturating_sub(begin) as f64
}

fn median(mut samples: Vec<f64>) -> Option<f64> {
    samples.sort_by(f64::total_cmp);
    samples.get(samples.len() / 2).copied()
}
