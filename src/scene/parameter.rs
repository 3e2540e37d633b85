//! Parameters of scenes: declared with default, unit and valid range; set by name.

use std::collections::BTreeMap;

/// What a parameter may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number between two ends, both allowed.
    Number {
        /// Default.
        default: f64,
        /// Smallest allowed.
        least: f64,
        /// Largest allowed.
        most: f64,
    },
    /// A whole number between two ends, both allowed.
    Integer {
        /// Default.
        default: u32,
        /// Smallest allowed.
        least: u32,
        /// Largest allowed.
        most: u32,
    },
    /// One of several names.
    Choice {
        /// Default.
        default: &'static str,
        /// All.
        names: &'static [&'static str],
    },
}

/// A parameter that a scene declares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: &'static str,
    /// What it may be.
    pub kind: Kind,
    /// Its unit; empty for a pure number or a choice.
    pub unit: &'static str,
    /// What it means.
    pub help: &'static str,
    /// Another parameter and the values of that with which alone this one has an effect.
    pub only_with: Option<(&'static str, &'static [&'static str])>,
}

/// A parameter's value.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A whole number.
    Integer(u32),
    /// One of the names.
    Choice(String),
}

/// Why a parameter could not be set.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// There is no such parameter.
    #[error("there is no parameter {name:?}{elsewhere}{}; there are {known}", did_you_mean(near))]
    Unknown {
        /// What was given.
        name: String,
        /// Where there is one, in brackets; empty if nowhere.
        elsewhere: String,
        /// The known name that is nearest, if one is near.
        near: Option<String>,
        /// What there is.
        known: String,
    },
    /// The value is not a number, outside its range or none of the choices.
    #[error("{name} = {value} is not valid: it must be {range}")]
    Invalid {
        /// The parameter.
        name: &'static str,
        /// What was given.
        value: String,
        /// What it may be.
        range: String,
    },
}

impl Parameter {
    /// A number with default and range.
    pub const fn number(
        name: &'static str,
        default: f64,
        [least, most]: [f64; 2],
        unit: &'static str,
        help: &'static str,
    ) -> Self {
        Self { name, kind: Kind::Number { default, least, most }, unit, help, only_with: None }
    }

    /// A whole number with default and range.
    pub const fn integer(
        name: &'static str,
        default: u32,
        [least, most]: [u32; 2],
        help: &'static str,
    ) -> Self {
        Self { name, kind: Kind::Integer { default, least, most }, unit: "", help, only_with: None }
    }

    /// A choice among names, the first being the default.
    pub const fn choice(
        name: &'static str,
        choices: &'static [&'static str],
        help: &'static str,
    ) -> Self {
        let kind = Kind::Choice { default: choices[0], names: choices };
        Self { name, kind, unit: "", help, only_with: None }
    }

    /// The same, but without effect where another parameter of the scene has none of these values.
    #[must_use]
    pub const fn only_with(mut self, other: &'static str, values: &'static [&'static str]) -> Self {
        self.only_with = Some((other, values));
        self
    }

    /// The same with another default number.
    ///
    /// # Panics
    /// If it is none or out of range: a mistake in the scene.
    #[must_use]
    pub const fn with_default(mut self, value: f64) -> Self {
        match &mut self.kind {
            Kind::Number { default, least, most } if *least <= value && value <= *most => {
                *default = value;
            }
            Kind::Integer { default, least, most }
                if *least as f64 <= value
                    && value <= *most as f64
                    && value as u32 as f64 == value =>
            {
                *default = value as u32;
            }
            _ => panic!("the default is no number in the valid range"),
        }
        self
    }

    /// The same with another choice as the default.
    ///
    /// # Panics
    /// If it is none of the choices: a mistake in the scene.
    #[must_use]
    pub fn with_default_choice(mut self, name: &'static str) -> Self {
        match &mut self.kind {
            Kind::Choice { default, names } if names.contains(&name) => *default = name,
            _ => panic!("{name:?} is no choice of {:?}", self.name),
        }
        self
    }

    /// The default.
    pub fn default(&self) -> Value {
        match self.kind {
            Kind::Number { default, .. } => Value::Number(default),
            Kind::Integer { default, .. } => Value::Integer(default),
            Kind::Choice { default, .. } => Value::Choice(default.to_owned()),
        }
    }

    /// What it may be, in words.
    pub fn range(&self) -> String {
        match self.kind {
            Kind::Number { least, most, .. } if most == f64::INFINITY => {
                format!("at least {least:?} {}", self.unit).trim_end().to_owned()
            }
            Kind::Number { least, most, .. } => {
                format!("between {least:?} and {most:?} {}", self.unit).trim_end().to_owned()
            }
            Kind::Integer { least, most, .. } if least == most => format!("{least} only"),
            Kind::Integer { least, most, .. } => {
                format!("a whole number between {least} and {most}")
            }
            Kind::Choice { names, .. } => format!("one of {}", names.join(", ")),
        }
    }

    fn parse(&self, text: &str) -> Result<Value, ParameterError> {
        let value = match self.kind {
            Kind::Number { least, most, .. } => text
                .parse()
                .ok()
                .filter(|x: &f64| x.is_finite() && (least..=most).contains(x))
                .map(Value::Number),
            Kind::Integer { least, most, .. } => {
                text.parse().ok().filter(|n: &u32| (least..=most).contains(n)).map(Value::Integer)
            }
            Kind::Choice { names, .. } => {
                names.contains(&text).then(|| Value::Choice(text.to_owned()))
            }
        };
        value.ok_or_else(|| ParameterError::Invalid {
            name: self.name,
            value: text.to_owned(),
            range: self.range(),
        })
    }
}

/// The values of all parameters of a scene.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(transparent)]
pub struct Parameters(BTreeMap<&'static str, Value>);

impl Parameters {
    /// Defaults, with `settings` (name, value) put over them.
    ///
    /// # Errors
    /// If a name is unknown or a value not valid; the message says what is.
    pub fn new<'a>(
        declared: &[Parameter],
        settings: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Self, ParameterError> {
        let mut values: BTreeMap<_, _> = declared.iter().map(|p| (p.name, p.default())).collect();
        for (name, text) in settings {
            let parameter = declared.iter().find(|p| p.name == name).ok_or_else(|| {
                let known: Vec<_> = declared.iter().map(|p| p.name).collect();
                let near = nearest(name, &known);
                let (name, known) = (name.to_owned(), known.join(", "));
                ParameterError::Unknown { name, elsewhere: String::new(), near, known }
            })?;
            values.insert(parameter.name, parameter.parse(text)?);
        }
        Ok(Self(values))
    }

    /// A number.
    ///
    /// # Panics
    /// If the scene declares no number of this name: a mistake in the scene.
    pub fn number(&self, name: &str) -> f64 {
        match self.0.get(name) {
            Some(Value::Number(x)) => *x,
            Some(Value::Integer(n)) => f64::from(*n),
            other => panic!("parameter {name:?} is {other:?}, not a number"),
        }
    }

    /// A choice.
    ///
    /// # Panics
    /// If the scene declares no choice of this name: a mistake in the scene.
    pub fn choice(&self, name: &str) -> &str {
        match self.0.get(name) {
            Some(Value::Choice(text)) => text,
            other => panic!("parameter {name:?} is {other:?}, not a choice"),
        }
    }

    /// Whether a parameter of the scene has an effect with these values.
    pub fn has_effect(&self, parameter: &Parameter) -> bool {
        parameter.only_with.is_none_or(|(other, values)| {
            let value = self.0.get(other).map(Value::to_string);
            value.is_none_or(|value| values.contains(&value.as_str()))
        })
    }

    /// Those of the `declared` that have an effect with these values.
    pub fn effective(&self, declared: &[Parameter]) -> BTreeMap<&'static str, &Value> {
        let effective = declared.iter().filter(|parameter| self.has_effect(parameter));
        effective
            .filter_map(|parameter| Some((parameter.name, self.0.get(parameter.name)?)))
            .collect()
    }

    /// Names and values, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &Value)> {
        self.0.iter().map(|(&name, value)| (name, value))
    }
}

/// The known name that somebody who wrote `name` may have meant.
pub(super) fn nearest(name: &str, known: &[&str]) -> Option<String> {
    let likeness = |known: &&str| strsim::jaro_winkler(name, known);
    let best = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(best) > 0.85).then(|| (*best).to_owned())
}

/// A question to end an error message with, if something is near.
pub(super) fn did_you_mean(near: &Option<String>) -> String {
    near.as_ref().map_or_else(String::new, |near| format!(" (did you mean {near:?}?)"))
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Number(x) => write!(f, "{x:?}"),
            Self::Integer(n) => write!(f, "{n}"),
            Self::Choice(text) => f.write_str(text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DECLARED: [Parameter; 3] = [
        Parameter::integer("resolution", 50, [8, 2000], "points across"),
        Parameter::choice("kernel", &["gaussian", "quintic-spline"], "smoothing kernel"),
        Parameter::integer("dim", 2, [2, 2], "dimensions"),
    ];

    #[test]
    fn settings_go_over_defaults() {
        let p = Parameters::new(&DECLARED, [("kernel", "quintic-spline")]).unwrap();
        assert_eq!(p.number("resolution"), 50.0);
        assert_eq!(p.choice("kernel"), "quintic-spline");
    }

    #[test]
    fn what_is_wrong_is_named_with_what_would_be_right() {
        let said = |setting| Parameters::new(&DECLARED, [setting]).unwrap_err().to_string();
        assert_eq!(
            said(("resolution", "7")),
            "resolution = 7 is not valid: it must be a whole number between 8 and 2000"
        );
        assert!(said(("resolution", "NaN")).contains("resolution = NaN"));
        assert!(said(("resolution", "24.6")).contains("a whole number"));
        assert_eq!(said(("dim", "3")), "dim = 3 is not valid: it must be 2 only");
        assert!(said(("kernel", "cubic")).contains("one of gaussian, quintic-spline"));
        assert!(said(("resolutoin", "9")).contains("there are resolution, kernel, dim"));
        assert!(said(("resolutoin", "9")).contains("did you mean \"resolution\"?"));
        assert!(!said(("width", "9")).contains("did you mean"));
    }
}
