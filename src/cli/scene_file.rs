//! Scene files: a scene and its parameters in TOML.

use std::collections::BTreeMap;
use std::path::Path;

use finegrain::scene::Precision;
use serde::Deserialize;
use toml::Spanned;

use super::CommandError;

/// What a scene file may say.
///
/// ```toml
/// scene = "cylinder"
/// method = "sph"
/// precision = "f64"
///
/// [parameters]
/// resolution = 100
/// kernel = "quintic-spline"
/// ```
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Name of a built-in scene.
    pub scene: String,
    /// Method to run it with.
    pub method: Option<String>,
    /// Scalar type.
    pub precision: Option<FilePrecision>,
    /// Parameters of the scene.
    #[serde(default)]
    pub parameters: BTreeMap<String, Spanned<toml::Value>>,
}

/// Scalar type, as files name it.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FilePrecision {
    /// 32-bit floats.
    F32,
    /// Positions in 64 bits, all else in 32.
    Mixed,
    /// 64-bit floats.
    F64,
}

impl From<FilePrecision> for Precision {
    fn from(precision: FilePrecision) -> Self {
        match precision {
            FilePrecision::F32 => Self::F32,
            FilePrecision::Mixed => Self::Mixed,
            FilePrecision::F64 => Self::F64,
        }
    }
}

impl SceneFile {
    /// Reads a file.
    ///
    /// # Errors
    /// If it cannot be read or understood; names the file, the line and the key.
    pub fn read(path: &Path) -> Result<Self, CommandError> {
        let text = std::fs::read_to_string(path)
            .map_err(|cause| format!("cannot read scene file `{}`: {cause}", path.display()))?;
        let file: Self = toml::from_str(&text)
            .map_err(|cause| format!("scene file `{}`: {cause}", path.display()))?;
        for (name, spanned) in &file.parameters {
            let value = spanned.get_ref();
            if !matches!(
                value,
                toml::Value::String(_) | toml::Value::Integer(_) | toml::Value::Float(_)
            ) {
                let line = 1 + text[..spanned.span().start].matches('\n').count();
                return Err(format!(
                    "scene file `{}`, line {line}: parameter {name} = {value} must be a number or a string",
                    path.display()
                )
                .into());
            }
        }
        Ok(file)
    }

    /// Parameters as text, the form in which the command line gives them too.
    pub fn settings(&self) -> Vec<(String, String)> {
        let text = |value: &toml::Value| match value {
            toml::Value::String(text) => text.clone(),
            other => other.to_string(),
        };
        self.parameters.iter().map(|(name, value)| (name.clone(), text(value.get_ref()))).collect()
    }
}
