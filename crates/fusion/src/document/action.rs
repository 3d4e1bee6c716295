//! What a step does: one operation, by its verb.

use super::Error;
use super::table::read;
use crate::operation::{
    Blend, Boolean, Cluster, Compose, Cut, Detail, Files, OptionError, Options, Pose, Remesh, Repair, SetOperation,
    Sharpen,
};
use std::ops::Range;
use toml::de::DeTable;

/// Every verb of a step.
pub(super) const VERBS: [&str; 12] = [
    "blend",
    "cluster",
    "compose",
    "cut",
    "detail",
    "difference",
    "intersection",
    "pose",
    "remesh",
    "repair",
    "sharpen",
    "union",
];

/// What a step does: an operation with its options.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Action {
    /// See [`Blend`].
    Blend(Blend),
    /// See [`Boolean`].
    Boolean(Boolean),
    /// See [`Cluster`].
    Cluster(Cluster),
    /// See [`Compose`].
    Compose(Compose),
    /// See [`Cut`].
    Cut(Cut),
    /// See [`Detail`].
    Detail(Detail),
    /// See [`Pose`].
    Pose(Pose),
    /// See [`Remesh`].
    Remesh(Remesh),
    /// See [`Repair`].
    Repair(Repair),
    /// See [`Sharpen`].
    Sharpen(Sharpen),
}

/// Does the same with the operation, whichever it is.
macro_rules! each {
    ($action:expr, $operation:ident => $does:expr) => {
        match $action {
            Action::Blend($operation) => $does,
            Action::Boolean($operation) => $does,
            Action::Cluster($operation) => $does,
            Action::Compose($operation) => $does,
            Action::Cut($operation) => $does,
            Action::Detail($operation) => $does,
            Action::Pose($operation) => $does,
            Action::Remesh($operation) => $does,
            Action::Repair($operation) => $does,
            Action::Sharpen($operation) => $does,
        }
    };
}

macro_rules! from {
    ($($name:ident)+) => {$(
        impl From<$name> for Action {
            fn from(operation: $name) -> Self {
                Self::$name(operation)
            }
        }
    )+};
}
from! { Blend Boolean Cluster Compose Cut Detail Pose Remesh Repair Sharpen }

impl Action {
    /// The verb, as `do` names it.
    pub fn verb(&self) -> &'static str {
        match self {
            Self::Blend(_) => Blend::NAME,
            Self::Boolean(boolean) => match boolean.operation {
                SetOperation::Union => "union",
                SetOperation::Difference => "difference",
                SetOperation::Intersection => "intersection",
            },
            Self::Cluster(_) => Cluster::NAME,
            Self::Compose(_) => Compose::NAME,
            Self::Cut(_) => Cut::NAME,
            Self::Detail(_) => Detail::NAME,
            Self::Pose(_) => Pose::NAME,
            Self::Remesh(_) => Remesh::NAME,
            Self::Repair(_) => Repair::NAME,
            Self::Sharpen(_) => Sharpen::NAME,
        }
    }

    /// Whether it takes several shapes.
    pub(super) fn takes_several(&self) -> bool {
        matches!(self, Self::Boolean(_) | Self::Compose(_))
    }

    /// Checks every option; see [`Options::validate`].
    pub(super) fn validate(&self) -> Result<(), OptionError> {
        each!(self, operation => operation.validate())
    }

    /// Reads the files that options name; see [`Options::load`].
    pub(super) fn load(&mut self, files: &mut dyn Files) -> Result<(), OptionError> {
        each!(self, operation => operation.load(files))
    }

    /// Its options as one JSON text, always the same for the same options.
    pub(super) fn canonical(&self) -> Result<String, serde_json::Error> {
        each!(self, operation => serde_json::to_string(operation))
    }

    /// The options that are not what they are by themselves.
    pub(super) fn written(&self) -> Result<toml::Table, toml::ser::Error> {
        fn own<O: Options>(operation: &O) -> Result<toml::Table, toml::ser::Error> {
            let ordinary = toml::Table::try_from(O::default())?;
            let mut table = toml::Table::try_from(operation)?;
            table.retain(|key, value| ordinary.get(key) != Some(value));
            Ok(table)
        }
        let mut table = each!(self, operation => own(operation))?;
        if matches!(self, Self::Boolean(_)) {
            table.remove("operation");
        }
        Ok(table)
    }

    /// The options of a verb.
    pub(super) fn read(
        text: &str,
        verb: (&str, Range<usize>),
        whole: Range<usize>,
        table: DeTable<'_>,
    ) -> Result<Self, Error> {
        let boolean = |operation, table| {
            let boolean: Boolean = read(text, whole.clone(), table, &["operation"])?;
            Ok(Self::Boolean(boolean.with_operation(operation)))
        };
        match verb.0 {
            "union" => boolean(SetOperation::Union, table),
            "difference" => boolean(SetOperation::Difference, table),
            "intersection" => boolean(SetOperation::Intersection, table),
            "blend" => read(text, whole, table, &[]).map(Self::Blend),
            "cluster" => read(text, whole, table, &[]).map(Self::Cluster),
            "compose" => read(text, whole, table, &["loops"]).map(Self::Compose),
            "cut" => read(text, whole, table, &[]).map(Self::Cut),
            "detail" => read(text, whole, table, &[]).map(Self::Detail),
            "pose" => read(text, whole, table, &[]).map(Self::Pose),
            "remesh" => read(text, whole, table, &[]).map(Self::Remesh),
            "repair" => read(text, whole, table, &[]).map(Self::Repair),
            "sharpen" => read(text, whole, table, &[]).map(Self::Sharpen),
            other => {
                let told = Error::at(text, verb.1, format!("there is no operation `{other}`"));
                Err(told.instead_of(other, VERBS))
            }
        }
    }
}
