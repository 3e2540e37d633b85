//! The hard cases, and the variants that are tried on them.

mod fd;
mod lbm;
mod sph;

/// A scene run for long or at its limits.
#[derive(Clone, Copy, Debug)]
pub struct HardCase {
    /// Its name.
    pub name: &'static str,
    /// The method.
    pub method: &'static str,
    /// The parameter by which the time step can be made longer, where that is tried.
    pub time_step: Option<&'static str>,
    /// The scene.
    pub scene: &'static str,
    /// What is set in all variants.
    pub settings: &'static [(&'static str, &'static str)],
    /// How long, s.
    pub until: f64,
    /// What is tried.
    pub variants: &'static [Variant],
    /// What must hold of the results for them to be right.
    pub signs: &'static [Sign],
}

/// A choice of terms, kernel, integrator or collision.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    /// Its name.
    pub name: &'static str,
    /// What is set.
    pub settings: &'static [(&'static str, &'static str)],
}

/// A result that betrays a run that went wrong without a failure.
#[derive(Clone, Copy, Debug)]
pub struct Sign {
    /// Name of the result.
    pub result: &'static str,
    /// Smallest value of a run that went well.
    pub least: f64,
    /// Largest value of a run that went well.
    pub most: f64,
    /// What it means if the value is another.
    pub symptom: &'static str,
}

/// All hard cases (`finegrain report stability`).
pub fn all() -> impl Iterator<Item = &'static HardCase> {
    const SPH: &[HardCase] = &sph::CASES;
    const LBM: &[HardCase] = &lbm::CASES;
    const FD: &[HardCase] = fd::CASES;
    SPH.iter().chain(LBM).chain(FD)
}

const fn variant(name: &'static str, settings: &'static [(&'static str, &'static str)]) -> Variant {
    Variant { name, settings }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn every_variant_sets_what_its_scene_has() {
        for case in all() {
            let scene = Scene::find(case.scene).unwrap();
            for variant in case.variants {
                let settings = case.settings.iter().chain(variant.settings).copied();
                if let Err(why) = scene.set_for(Some(case.method), settings) {
                    panic!("{}, {}: {why}", case.name, variant.name);
                }
            }
        }
    }
}
