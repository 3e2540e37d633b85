//! `finegrain scenes`.

use std::io::Write;

use finegrain::scene::SCENES;

use super::CommandError;

/// Lists all scenes with their parameters.
pub fn list(out: &mut impl Write) -> Result<(), CommandError> {
    for scene in SCENES {
        writeln!(out, "{}: {}", scene.name, scene.summary)?;
        for method in scene.methods {
            writeln!(out, "  --method {}", method.name)?;
            for parameter in (method.parameters)() {
                let range = parameter.range();
                writeln!(
                    out,
                    "    {:20} {:>18}  {} ({range})",
                    parameter.name,
                    parameter.default().to_string(),
                    parameter.help
                )?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
