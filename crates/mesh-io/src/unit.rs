//! Units of length that files name.

/// A unit of length, as 3MF names it.
///
/// ```
/// use mesh_io::Unit;
/// assert_eq!(Unit::from_name("inch").map(Unit::millimeters), Some(25.4));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unit {
    /// A thousandth of a millimetre.
    Micron,
    /// What 3MF means where it names none.
    #[default]
    Millimeter,
    /// Ten millimetres.
    Centimeter,
    /// 25.4 mm.
    Inch,
    /// 304.8 mm.
    Foot,
    /// A thousand millimetres.
    Meter,
}

impl Unit {
    const ALL: [Self; 6] = [Self::Micron, Self::Millimeter, Self::Centimeter, Self::Inch, Self::Foot, Self::Meter];

    /// Its name in 3MF, such as `"inch"`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Micron => "micron",
            Self::Millimeter => "millimeter",
            Self::Centimeter => "centimeter",
            Self::Inch => "inch",
            Self::Foot => "foot",
            Self::Meter => "meter",
        }
    }

    /// The unit of a name in 3MF.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.name() == name)
    }

    /// How many millimetres it is.
    pub fn millimeters(self) -> f64 {
        match self {
            Self::Micron => 1e-3,
            Self::Millimeter => 1.0,
            Self::Centimeter => 10.0,
            Self::Inch => 25.4,
            Self::Foot => 304.8,
            Self::Meter => 1e3,
        }
    }
}
