//! What is compared: scenes, and the ways to run them.

use finegrain_framework::Schedule;

use crate::scene::Precision;

/// A scene with its parameters, run by several methods and judged by one error.
#[derive(Debug)]
pub struct Comparison {
    /// Its name.
    pub name: &'static str,
    /// Name of the scene.
    pub scene: &'static str,
    /// What is set in all runs.
    pub settings: &'static [(&'static str, &'static str)],
    /// How long, s; to the scene's own end if `None`.
    pub until: Option<f64>,
    /// What the error is that of.
    pub quantity: &'static str,
    /// Names of relative errors: the largest of them counts, without its sign.
    pub errors: &'static [&'static str],
    /// Dimensions of the scene.
    pub dims: u32,
    /// The ways to run it.
    pub lines: &'static [Line],
}

/// A way to run a scene, at several resolutions.
#[derive(Debug)]
pub struct Line {
    /// Name of the method.
    pub method: &'static str,
    /// What is special about it; empty if it is the method with its defaults.
    pub variant: &'static str,
    /// What is set.
    pub settings: &'static [(&'static str, &'static str)],
    /// Scalar type.
    pub precision: Precision,
    /// How workers meet.
    pub schedule: Schedule,
    /// Points across, the fewest first.
    pub resolutions: &'static [u32],
}

impl Line {
    const fn new(method: &'static str, resolutions: &'static [u32]) -> Self {
        let (variant, settings) = ("", [].as_slice());
        let (precision, schedule) = (Precision::F64, Schedule::Lockstep);
        Self { method, variant, settings, precision, schedule, resolutions }
    }

    const fn with(
        self,
        variant: &'static str,
        settings: &'static [(&'static str, &'static str)],
    ) -> Self {
        Self { variant, settings, ..self }
    }

    const fn mixed(self) -> Self {
        Self { variant: "mixed precision", precision: Precision::Mixed, ..self }
    }

    const fn single(self) -> Self {
        Self { variant: "f32", precision: Precision::F32, ..self }
    }

    const fn peer_to_peer(self) -> Self {
        Self { variant: "peer-to-peer", schedule: Schedule::PeerToPeer, ..self }
    }

    /// Method and variant, as people write them.
    pub fn title(&self) -> String {
        let method = self.method.to_uppercase();
        if self.variant.is_empty() { method } else { format!("{method}, {}", self.variant) }
    }
}

const DRAG: &str = "drag coefficient";

/// All comparisons (`finegrain report speed-vs-error`).
pub static COMPARISONS: [Comparison; 8] = [
    Comparison {
        name: "taylor-green",
        scene: "taylor-green",
        settings: &[("reynolds", "100")],
        until: Some(1.0),
        quantity: "velocity at t = 1 s, mean of the absolute error",
        errors: &["velocity_l1"],
        dims: 2,
        lines: &[
            Line::new("sph", &[16, 25, 50, 100, 200]),
            Line::new("sph", &[16, 25, 50, 100, 200]).mixed(),
            Line::new("sph", &[16, 25, 50, 100]).with(
                "quintic spline",
                &[("kernel", "quintic-spline"), ("smoothing_ratio", "1"), ("transport", "4")],
            ),
            Line::new("lbm", &[16, 32, 64, 128, 256]),
            Line::new("lbm", &[16, 32, 64, 128, 256]).with("trt", &[("collision", "trt")]),
            Line::new("lbm", &[16, 32, 64, 128, 256]).single(),
            Line::new("lbm", &[32, 64, 128, 256]).peer_to_peer(),
            Line::new("lbm", &[16, 32, 64, 128]).with("Mach 0.0125", &[("mach", "0.0125")]),
            Line::new("fd", &[16, 32, 64, 128, 256]),
            Line::new("fd", &[16, 32, 64, 128, 256]).with("order 2", &[("order", "2")]),
            Line::new("fd", &[16, 32, 64, 128]).single(),
        ],
    },
    Comparison {
        name: "poiseuille",
        scene: "poiseuille",
        settings: &[],
        until: None,
        quantity: "velocity profile at t = 0.1125 s, L2",
        errors: &["velocity_l2"],
        dims: 2,
        lines: &[
            Line::new("sph", &[16, 25, 50, 100]),
            Line::new("sph", &[16, 25, 50, 100]).mixed(),
            Line::new("lbm", &[8, 16, 32, 64, 128]),
            Line::new("lbm", &[8, 16, 32, 64, 128]).with("bgk", &[("collision", "bgk")]),
            Line::new("lbm", &[8, 16, 32, 64, 128]).single(),
            Line::new("fd", &[8, 16, 32, 64, 128]),
        ],
    },
    Comparison {
        name: "cylinder, Stokes",
        scene: "cylinder",
        settings: &[],
        until: None,
        quantity: DRAG,
        errors: &["drag_k"],
        dims: 2,
        lines: &CYLINDER,
    },
    Comparison {
        name: "cylinder, Re = 1",
        scene: "cylinder",
        settings: &[("viscosity", "1e-6"), ("body_acceleration", "1.5e-7")],
        until: None,
        quantity: DRAG,
        errors: &["drag_k"],
        dims: 2,
        lines: &CYLINDER,
    },
    Comparison {
        name: "cavity, Re = 100",
        scene: "cavity",
        settings: &[("reynolds", "100")],
        until: None,
        quantity: "extrema of the velocity on the centre lines",
        errors: &["u_min", "v_min", "v_max"],
        dims: 2,
        lines: &[
            Line::new("sph", &[16, 25, 50, 100]),
            Line::new("sph", &[16, 25, 50, 100]).mixed(),
            Line::new("lbm", &[16, 32, 64, 128]),
            Line::new("lbm", &[16, 32, 64, 128]).with("trt", &[("collision", "trt")]),
            Line::new("lbm", &[16, 32, 64, 128]).single(),
            Line::new("fd", &[16, 32, 64, 128]),
        ],
    },
    Comparison {
        name: "cavity, Re = 1000",
        scene: "cavity",
        settings: &[("reynolds", "1000")],
        until: None,
        quantity: "extrema of the velocity on the centre lines",
        errors: &["u_min", "v_min", "v_max"],
        dims: 2,
        lines: &[
            Line::new("sph", &[25, 50, 100, 200]),
            Line::new("sph", &[25, 50, 100, 200]).mixed(),
            Line::new("lbm", &[32, 64, 128, 256]),
            Line::new("lbm", &[32, 64, 128, 256]).with("trt", &[("collision", "trt")]),
            Line::new("lbm", &[32, 64, 128, 256]).single(),
            Line::new("fd", &[32, 64, 128, 256]),
        ],
    },
    Comparison {
        name: "channel-cylinder, Re = 20",
        scene: "channel-cylinder",
        settings: &[("reynolds", "20")],
        until: None,
        quantity: DRAG,
        errors: &["drag"],
        dims: 2,
        lines: &[
            Line::new("sph", &[20, 41, 82]),
            Line::new("lbm", &[20, 41, 82, 164]),
            Line::new("lbm", &[20, 41, 82, 164]).single(),
            Line::new("lbm", &[20, 41, 82, 164]).with("cumulant", &[("collision", "cumulant")]),
            // As many spacings above as below the cylinder's centre, which lies out of the middle.
            Line::new("fd", &[41, 82, 123]),
        ],
    },
    Comparison {
        name: "sphere-array",
        scene: "sphere-array",
        settings: &[("solid_fraction", "0.125")],
        until: None,
        quantity: DRAG,
        errors: &["drag_k"],
        dims: 3,
        lines: &[
            Line::new("lbm", &[8, 16, 32, 64]),
            Line::new("lbm", &[8, 16, 32, 64]).with("half-way walls", &[("wall", "half-way")]),
            Line::new("lbm", &[8, 16, 32, 64]).single(),
            Line::new("lbm", &[16, 32, 64]).peer_to_peer(),
        ],
    },
];

const CYLINDER: [Line; 6] = [
    Line::new("sph", &[24, 32, 50, 100]),
    Line::new("sph", &[24, 32, 50, 100]).mixed(),
    Line::new("lbm", &[12, 24, 50, 100, 200]),
    Line::new("lbm", &[12, 24, 50, 100, 200]).with("half-way walls", &[("wall", "half-way")]),
    Line::new("lbm", &[12, 24, 50, 100, 200]).single(),
    Line::new("fd", &[24, 32, 50, 64, 100]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn every_line_sets_what_its_scene_has() {
        for comparison in &COMPARISONS {
            let scene = Scene::find(comparison.scene).unwrap();
            for line in comparison.lines {
                for resolution in line.resolutions {
                    let resolution = resolution.to_string();
                    let settings = comparison.settings.iter().chain(line.settings).copied();
                    let settings = settings.chain([("resolution", resolution.as_str())]);
                    if let Err(why) = scene.set_for(Some(line.method), settings) {
                        panic!("{}, {}: {why}", comparison.name, line.title());
                    }
                }
                assert!(line.resolutions.is_sorted());
            }
        }
    }

    #[test]
    fn no_two_lines_have_the_same_title() {
        for comparison in &COMPARISONS {
            let mut titles: Vec<_> = comparison.lines.iter().map(Line::title).collect();
            titles.sort();
            titles.dedup();
            assert_eq!(titles.len(), comparison.lines.len(), "{}", comparison.name);
        }
    }
}
