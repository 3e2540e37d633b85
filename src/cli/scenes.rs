//! `finegrain scenes`.

use std::io::Write;

use clap::Args;
use finegrain::scene::{Method, SCENES, Scene};

use super::CommandError;

/// Arguments of `finegrain scenes`.
#[derive(Args)]
pub struct ScenesArguments {
    /// A scene, to see its parameters with their defaults and ranges; all scenes, a line each, without.
    scene: Option<String>,
    /// Only the parameters for this numerical method.
    #[arg(long, requires = "scene")]
    method: Option<String>,
}

/// Lists all scenes, or the parameters of one.
pub fn scenes(arguments: &ScenesArguments, out: &mut impl Write) -> Result<(), CommandError> {
    match &arguments.scene {
        Some(name) => {
            let scene = Scene::find(name)?;
            let methods = match arguments.method.as_deref() {
                Some(name) => std::slice::from_ref(scene.method(Some(name))?),
                None => scene.methods,
            };
            describe(scene, methods, out)?;
        }
        None => {
            for scene in SCENES {
                let methods: Vec<_> = scene.methods.iter().map(|method| method.name).collect();
                writeln!(out, "{:20} {:13} {}", scene.name, methods.join(", "), scene.summary)?;
            }
            writeln!(out, "\nparameters of a scene: finegrain scenes NAME")?;
        }
    }
    Ok(())
}

fn describe(scene: &Scene, methods: &[Method], out: &mut impl Write) -> std::io::Result<()> {
    writeln!(out, "{}: {}", scene.name, scene.summary)?;
    for method in methods {
        writeln!(out, "\n--method {}", method.name)?;
        let parameters = (method.parameters)();
        for parameter in &parameters {
            let (name, default) = (parameter.name, parameter.default().to_string());
            writeln!(out, "  {name:20} {default:>18}  {}", parameter.help)?;
            let condition = parameter
                .only_with
                .filter(|(other, _)| parameters.iter().any(|parameter| parameter.name == *other))
                .map(|(other, values)| format!("; only with {other} = {}", values.join(" or ")));
            let condition = condition.unwrap_or_default();
            writeln!(out, "  {:39}  ({}{condition})", "", parameter.range())?;
        }
    }
    Ok(())
}
