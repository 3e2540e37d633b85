//! What is measured along a side of a picture.

/// How numbers are laid out along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal differences look equal.
    #[default]
    Linear,
    /// Equal ratios look equal; ticks at powers of 2, as for numbers of processors.
    Log2,
    /// Equal ratios look equal; ticks at powers of 10 and between them.
    Log10,
}

/// A quantity with its unit, and how it is laid out.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Axis {
    label: String,
    unit: Option<String>,
    pub(super) scale: Scale,
    covering: Option<[f64; 2]>,
}

impl Axis {
    /// A linear axis for a quantity without a unit.
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), unit: None, scale: Scale::Linear, covering: None }
    }

    /// Names the unit.
    pub fn unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// Chooses the layout; linear by default.
    pub fn scale(mut self, scale: Scale) -> Self {
        self.scale = scale;
        self
    }

    /// Shows `low` to `high` at least, whatever the data are.
    pub fn covering(mut self, low: f64, high: f64) -> Self {
        self.covering = Some([low.min(high), low.max(high)]);
        self
    }

    /// Whether a value has a place on the axis.
    pub(super) fn shows(&self, value: f64) -> bool {
        value.is_finite() && (self.scale == Scale::Linear || value > 0.0)
    }

    /// Label and unit; numbers along the axis are to be multiplied by `factor`, if there is one.
    pub(super) fn title(&self, factor: &str) -> String {
        let unit = self.unit.as_deref().unwrap_or_default();
        match [factor, unit].join(" ").trim() {
            "" => self.label.clone(),
            unit => format!("{} ({unit})", self.label),
        }
    }

    /// The part of the axis from the smallest to the largest value that it shows, widened if they
    /// are the same; `None` if it shows none of them.
    pub(super) fn extent(&self, values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
        let covering = self.covering.into_iter().flatten();
        let mut extent: Option<[f64; 2]> = None;
        let mut any = false;
        for value in values.into_iter().inspect(|&v| any |= self.shows(v)).chain(covering) {
            if self.shows(value) {
                let [low, high] = extent.unwrap_or([value; 2]);
                extent = Some([low.min(value), high.max(value)]);
            }
        }
        extent.filter(|_| any).map(|extent| self.widened(extent))
    }

    /// A constant, but for rounding, in the middle of something.
    fn widened(&self, [low, high]: [f64; 2]) -> [f64; 2] {
        let largest = low.abs().max(high.abs());
        if high - low > 1e-9 * largest {
            return [low, high];
        }
        match self.scale {
            Scale::Linear if largest == 0.0 => [-1.0, 1.0],
            Scale::Linear => [low - 0.1 * largest, high + 0.1 * largest],
            Scale::Log2 | Scale::Log10 => [low / 2.0, high * 2.0],
        }
    }

    /// [`Axis::extent`] with a margin, so that no marker lies on the frame; what the axis is to
    /// cover needs none.
    pub(crate) fn padded(&self, values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
        let data = Self { covering: None, ..self.clone() };
        let [low, high] = data.extent(values)?;
        let [low, high] = match self.scale {
            Scale::Linear => {
                let margin = 0.05 * (high - low);
                [low - margin, high + margin]
            }
            Scale::Log2 | Scale::Log10 => {
                let margin = (high / low).powf(0.05);
                [low / margin, high * margin]
            }
        };
        let covering = self.covering.filter(|c| c.iter().all(|&v| self.shows(v)));
        Some(covering.map_or([low, high], |[a, b]| [low.min(a), high.max(b)]))
    }
}
