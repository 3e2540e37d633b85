//! Stages made of closures, for tests that need many small ones.

use finegrain_framework::*;

struct ByRate<F> {
    name: &'static str,
    writes: Vec<ColumnId>,
    rate: F,
}

impl<D: Domain, F> RateStage<D> for ByRate<F>
where
    F: Fn(&Near<'_, D>, &mut Rates<'_, D>, &Moment) -> Result<(), Fault> + Send + Sync + 'static,
{
    type Scratch = ();

    fn name(&self) -> &str {
        self.name
    }

    fn writes(&self) -> Vec<ColumnId> {
        self.writes.clone()
    }

    fn rate(
        &self,
        near: &Near<'_, D>,
        rates: &mut Rates<'_, D>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        (self.rate)(near, rates, moment)
    }
}

/// A rate stage that does what `rate` does.
pub fn rate_stage<D: Domain, F>(name: &'static str, writes: &[ColumnId], rate: F) -> Stage<D>
where
    F: Fn(&Near<'_, D>, &mut Rates<'_, D>, &Moment) -> Result<(), Fault> + Send + Sync + 'static,
{
    Stage::rate(ByRate { name, writes: writes.to_vec(), rate })
}

struct ByUpdate<F> {
    name: &'static str,
    update: F,
}

impl<D: Domain, F> UpdateStage<D> for ByUpdate<F>
where
    F: Fn(&mut Own<'_, D>, &Moment) -> Result<(), Fault> + Send + Sync + 'static,
{
    type Scratch = ();

    fn name(&self) -> &str {
        self.name
    }

    fn update(&self, own: &mut Own<'_, D>, _: &mut (), moment: &Moment) -> Result<(), Fault> {
        (self.update)(own, moment)
    }
}

/// An update stage that does what `update` does.
pub fn update_stage<D: Domain, F>(name: &'static str, update: F) -> Stage<D>
where
    F: Fn(&mut Own<'_, D>, &Moment) -> Result<(), Fault> + Send + Sync + 'static,
{
    Stage::update(ByUpdate { name, update })
}

struct ByWhole<F>(&'static str, F);

impl<D: Domain, F> WholeStage<D> for ByWhole<F>
where
    F: FnMut(&mut Whole<'_, D>) -> Result<(), Fault> + Send,
{
    fn name(&self) -> &str {
        self.0
    }

    fn run(&mut self, whole: &mut Whole<'_, D>) -> Result<(), Fault> {
        (self.1)(whole)
    }
}

/// A whole-domain stage of a step that does what `run` does.
pub fn whole_in_step<D: Domain, F>(name: &'static str, run: F) -> Stage<D>
where
    F: FnMut(&mut Whole<'_, D>) -> Result<(), Fault> + Send + 'static,
{
    Stage::whole(ByWhole(name, run))
}

/// A whole-domain stage that does what `run` does.
pub fn whole_stage<D: Domain, F>(name: &'static str, run: F) -> Box<dyn WholeStage<D>>
where
    F: FnMut(&mut Whole<'_, D>) -> Result<(), Fault> + Send + 'static,
{
    Box::new(ByWhole(name, run))
}

struct ByPace<F>(F);

impl<D: Domain, F> Pacing<D> for ByPace<F>
where
    F: FnMut(&mut Whole<'_, D>) -> Result<Pace, Fault> + Send,
{
    fn pace(&mut self, whole: &mut Whole<'_, D>) -> Result<Pace, Fault> {
        (self.0)(whole)
    }
}

/// Time step control that does what `pace` does.
pub fn pacing<D: Domain, F>(pace: F) -> Box<dyn Pacing<D>>
where
    F: FnMut(&mut Whole<'_, D>) -> Result<Pace, Fault> + Send + 'static,
{
    Box::new(ByPace(pace))
}
