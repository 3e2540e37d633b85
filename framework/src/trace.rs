//! Traces: which worker ran which part of which sub-domain when.

use std::fmt;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use crossbeam_utils::CachePadded;

/// A part of a step of one sub-domain, as one worker ran it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Event {
    /// When it began, ns since the trace did.
    pub begin: u64,
    /// When it ended, ns since the trace began.
    pub end: u64,
    /// Number of the step.
    pub step: u64,
    /// Number of the part, see [`Trace::parts`].
    pub part: u32,
    /// Number of the sub-domain.
    pub sub_domain: u32,
}

impl Event {
    fn duration(&self) -> u64 {
        self.end - self.begin
    }
}

/// What each worker did last: a ring of events a worker, so that recording never allocates.
pub struct Trace {
    began: Instant,
    parts: Vec<String>,
    /// Every worker has its own: the locks are never contended.
    workers: Vec<CachePadded<Mutex<Ring>>>,
    /// Stretches in which the workers were given parts, with the first step; what lies between is
    /// whole-domain work, results and events.
    legs: Mutex<Ring>,
    /// Whole-domain stages inside steps.
    whole: Mutex<Ring>,
}

impl Trace {
    /// An empty trace of `workers` workers that remembers `capacity` events of each, for a step of
    /// these parts.
    pub(crate) fn new(parts: Vec<String>, workers: usize, capacity: usize) -> Self {
        let ring = |_| CachePadded::new(Mutex::new(Ring::new(capacity)));
        Self {
            began: Instant::now(),
            parts,
            workers: (0..workers).map(ring).collect(),
            legs: Mutex::new(Ring::new(capacity)),
            whole: Mutex::new(Ring::new(capacity)),
        }
    }

    /// Time since the trace began, ns.
    #[inline]
    pub(crate) fn now(&self) -> u64 {
        self.began.elapsed().as_nanos() as u64
    }

    pub(crate) fn record(&self, worker: usize, event: Event) {
        lock(&self.workers[worker]).push(event);
    }

    pub(crate) fn record_leg(&self, begin: u64, step: u64) {
        let end = self.now();
        lock(&self.legs).push(Event { begin, end, step, ..Event::default() });
    }

    pub(crate) fn record_whole(&self, begin: u64, step: u64, part: usize) {
        let (end, part) = (self.now(), part as u32);
        lock(&self.whole).push(Event { begin, end, step, part, sub_domain: 0 });
    }

    /// Names of the parts of a step.
    pub fn parts(&self) -> &[String] {
        &self.parts
    }

    /// Number of workers.
    pub fn workers(&self) -> usize {
        self.workers.len()
    }

    /// What a worker did last, in order.
    ///
    /// # Panics
    /// If there is no such worker.
    pub fn events(&self, worker: usize) -> Vec<Event> {
        lock(&self.workers[worker]).in_order()
    }

    /// The last legs, in order: stretches in which the workers were given parts.
    pub fn legs(&self) -> Vec<Event> {
        lock(&self.legs).in_order()
    }

    /// The last whole-domain stages inside steps, in order.
    pub fn whole(&self) -> Vec<Event> {
        lock(&self.whole).in_order()
    }

    /// How the time was spent, as far back as all workers remember.
    pub fn summary(&self) -> Summary {
        let mut events: Vec<_> = (0..self.workers()).map(|worker| self.events(worker)).collect();
        let (mut legs, mut whole) = (self.legs(), self.whole());
        // What only some remember would look like waiting of the others.
        let capacity = lock(&self.legs).capacity;
        let is_full = |events: &&Vec<Event>| events.len() == capacity;
        let all = events.iter().chain([&legs, &whole]);
        let first = all.filter(is_full).map(|events| events[0].begin).max();
        let first = first.or_else(|| legs.first().map(|leg| leg.begin)).unwrap_or(0);
        events.iter_mut().for_each(|events| events.retain(|event| event.begin >= first));
        legs.retain(|leg| leg.end > first);
        whole.retain(|event| event.begin >= first);

        let ends = [&legs, &whole].map(|events| events.last().map_or(first, |last| last.end));
        let last = ends[0].max(ends[1]);
        let in_legs: u64 = legs.iter().map(|leg| leg.end - leg.begin.max(first)).sum();
        let in_whole: u64 = whole.iter().map(Event::duration).sum();
        let workers = events.iter().map(|events| Shares::of(events, in_legs)).collect();
        Summary {
            seconds: seconds(last - first),
            between: seconds(last - first - in_legs - in_whole),
            whole: seconds(in_whole),
            workers,
            stages: self.stages(&events, &whole),
            largest: Largest::of(&events),
        }
    }

    /// For each name of a part, the time that all workers together spent in such parts, s; the time of
    /// whole-domain stages counts for all of them.
    fn stages(&self, events: &[Vec<Event>], whole: &[Event]) -> Vec<(String, f64)> {
        let mut stages: Vec<(String, f64)> = Vec::new();
        let all = events.iter().flatten().map(|event| (event, 1));
        for (event, times) in all.chain(whole.iter().map(|event| (event, self.workers()))) {
            let name = &self.parts[event.part as usize];
            let time = seconds(event.duration()) * times as f64;
            match stages.iter_mut().find(|(known, _)| known == name) {
                Some((_, sum)) => *sum += time,
                None => stages.push((name.clone(), time)),
            }
        }
        stages
    }
}

fn lock(ring: &Mutex<Ring>) -> MutexGuard<'_, Ring> {
    ring.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The last events, in memory that is there from the beginning.
struct Ring {
    events: Vec<Event>,
    capacity: usize,
    /// Where the oldest is, once all places are taken.
    oldest: usize,
}

impl Ring {
    fn new(capacity: usize) -> Self {
        Self { events: Vec::with_capacity(capacity), capacity, oldest: 0 }
    }

    fn push(&mut self, event: Event) {
        if self.events.len() < self.capacity {
            self.events.push(event);
        } else if let Some(oldest) = self.events.get_mut(self.oldest) {
            *oldest = event;
            self.oldest = (self.oldest + 1) % self.capacity;
        }
    }

    fn in_order(&self) -> Vec<Event> {
        [&self.events[self.oldest..], &self.events[..self.oldest]].concat()
    }
}

/// How time was spent, s.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// All of it.
    pub seconds: f64,
    /// Between steps: whole-domain work, results, events.
    pub between: f64,
    /// In whole-domain stages inside steps.
    pub whole: f64,
    /// What each worker did in legs.
    pub workers: Vec<Shares>,
    /// What all workers together spent in each kind of part, by name; whole-domain stages count for all
    /// workers.
    pub stages: Vec<(String, f64)>,
    /// The sub-domain that took longest, if any was run.
    pub largest: Option<Largest>,
}

impl Summary {
    /// The workers' mean time in parts over the longest: 1 if all had as much to do.
    pub fn balance(&self) -> f64 {
        let busy = || self.workers.iter().map(|shares| shares.busy);
        busy().sum::<f64>() / (busy().fold(0.0, f64::max) * self.workers.len() as f64)
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |part: f64, whole: f64| 100.0 * part / whole;
        let [between, whole] = [self.between, self.whole].map(|x| percent(x, self.seconds));
        write!(f, "the last {:.3} s: {between:.2} % between steps", self.seconds)?;
        if self.whole > 0.0 {
            write!(f, ", {whole:.2} % in whole-domain stages")?;
        }
        writeln!(f)?;
        for (worker, shares) in self.workers.iter().enumerate() {
            let Shares { busy, hand_out, waiting, parts } = *shares;
            let all = busy + hand_out + waiting;
            let [busy, hand_out, waiting] = [busy, hand_out, waiting].map(|x| percent(x, all));
            writeln!(
                f,
                "worker {worker}: busy {busy:.2} %, hand-out {hand_out:.2} %, waiting {waiting:.2} %, \
                 {parts} parts"
            )?;
        }
        let all: f64 = self.stages.iter().map(|(_, time)| time).sum();
        for (name, time) in &self.stages {
            writeln!(f, "{:5.2} % in {name}", percent(*time, all))?;
        }
        write!(f, "balance {:.4}", self.balance())?;
        if let Some(Largest { sub_domain, seconds, over_mean }) = self.largest {
            let time = 1e6 * seconds;
            write!(
                f,
                "; largest: sub-domain {sub_domain}, {time:.1} us a part, {over_mean:.2} times the mean"
            )?;
        }
        Ok(())
    }
}

/// What one worker did in legs, s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares {
    /// In parts.
    pub busy: f64,
    /// From one part to the next, if that came at once: within 2 microseconds.
    pub hand_out: f64,
    /// The rest: nothing was ready, or others were not.
    pub waiting: f64,
    /// Number of parts.
    pub parts: usize,
}

impl Shares {
    /// Of a worker that was in legs for `in_legs` ns.
    fn of(events: &[Event], in_legs: u64) -> Self {
        const AT_ONCE: u64 = 2000;
        let busy: u64 = events.iter().map(Event::duration).sum();
        let gaps = events.windows(2).map(|pair| pair[1].begin.saturating_sub(pair[0].end));
        let hand_out: u64 = gaps.filter(|&gap| gap <= AT_ONCE).sum();
        let waiting = in_legs.saturating_sub(busy + hand_out);
        Self {
            busy: seconds(busy),
            hand_out: seconds(hand_out),
            waiting: seconds(waiting),
            parts: events.len(),
        }
    }
}

/// The sub-domain whose parts took longest in the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Largest {
    /// Its number.
    pub sub_domain: u32,
    /// Mean time of its parts, s.
    pub seconds: f64,
    /// The same over that of all sub-domains.
    pub over_mean: f64,
}

impl Largest {
    fn of(events: &[Vec<Event>]) -> Option<Self> {
        let count = events.iter().flatten().map(|event| event.sub_domain + 1).max()?;
        let mut sums = vec![(0u64, 0u64); count as usize];
        for event in events.iter().flatten() {
            let (time, parts) = &mut sums[event.sub_domain as usize];
            *time += event.duration();
            *parts += 1;
        }
        let means = sums.iter().map(|&(time, parts)| seconds(time) / parts.max(1) as f64);
        let present = sums.iter().filter(|(_, parts)| *parts > 0).count();
        let mean = means.clone().sum::<f64>() / present as f64;
        let (sub_domain, longest) = means.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let (sub_domain, over_mean) = (sub_domain as u32, longest / mean);
        Some(Self { sub_domain, seconds: longest, over_mean })
    }
}

fn seconds(nanoseconds: u64) -> f64 {
    1e-9 * nanoseconds as f64
}
