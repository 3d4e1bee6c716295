//! Operations by name. A new one is one line in `by_name`.

use crate::failure::Fault;
use fusion::blend::Limit;
use fusion::mesh_core::{TriMesh, Watch, bounds};
use fusion::mesh_io::{self, Model};
use fusion::operation::{
    Blend, Boolean, Cluster, Compose, Cut, Detail, Files, OptionError, Options, Pose, Precision, Remesh, Repair,
    Sharpen,
};
use fusion::{Error, Outcome};
use serde_json::{Map, Value};
use std::fs;
use std::path::Path;

/// A result, and what an operation gives beside it.
pub struct Done {
    /// The result.
    pub outcome: Outcome,
    /// Control nets of clusters, as JSON.
    pub nets: Option<String>,
}

impl From<Outcome> for Done {
    fn from(outcome: Outcome) -> Self {
        Self { outcome, nets: None }
    }
}

/// Runs the operation of a name.
pub fn by_name(
    name: &str,
    options: &Map<String, Value>,
    parts: &[Model],
    precision: Precision,
    watch: &Watch,
) -> Result<Done, Fault> {
    match name {
        Blend::NAME => read::<Blend>(options)?.run(first(parts)?, precision, watch).map(Done::from),
        Boolean::NAME => boolean(&read(options)?, parts, precision, watch),
        Cluster::NAME => cluster(&read(options)?, first(parts)?, precision, watch),
        Compose::NAME => read::<Compose>(options)?.run(parts, precision, watch).map(Done::from),
        Cut::NAME => read::<Cut>(options)?.run(first(parts)?, precision, watch).map(Done::from),
        Detail::NAME => return detail(&read(options)?, parts, precision, watch),
        Pose::NAME => read::<Pose>(options)?.run(first(parts)?, watch).map(Done::from),
        Remesh::NAME => read::<Remesh>(options)?.run(first(parts)?, precision, watch).map(Done::from),
        Repair::NAME => read::<Repair>(options)?.run(first(parts)?, precision, watch).map(Done::from),
        Sharpen::NAME => read::<Sharpen>(options)?.run(first(parts)?, precision, watch).map(Done::from),
        other => return Err(Fault::Internal(format!("there is no operation {other:?}"))),
    }
    .map_err(Fault::from)
}

/// The largest radius at which the chosen curves or seams can be blended.
pub fn max_radius(name: &str, options: &Map<String, Value>, parts: &[Model], watch: &Watch) -> Result<Limit, Fault> {
    match name {
        Blend::NAME => Ok(read::<Blend>(options)?.max_radius(first(parts)?, watch)?),
        _ => Ok(read::<Boolean>(options)?.max_radius(parts, watch)?),
    }
}

/// The options, with the files read that they name.
fn read<O: Options>(options: &Map<String, Value>) -> Result<O, Fault> {
    let read = serde_json::from_value::<O>(Value::Object(options.clone()));
    let mut operation = read.map_err(|e| blamed::<O>(options, &e))?;
    operation.load(&mut FromDisk).map_err(|e| Fault::Unreadable(e.to_string()))?;
    Ok(operation)
}

/// What is wrong with the options, with the one to blame: the first that cannot be read alone.
fn blamed<O: Options>(options: &Map<String, Value>, error: &serde_json::Error) -> Fault {
    let alone = |(key, value): (&String, &Value)| {
        let one = Map::from_iter([(key.clone(), value.clone())]);
        serde_json::from_value::<O>(Value::Object(one)).err().map(|e| format!("{key}: {e}"))
    };
    let reason = options.iter().find_map(alone).unwrap_or_else(|| error.to_string());
    Fault::BadOption(reason)
}

fn first(parts: &[Model]) -> Result<&Model, Fault> {
    parts.first().ok_or_else(|| Fault::Internal("an operation without a mesh".into()))
}

fn boolean(boolean: &Boolean, parts: &[Model], precision: Precision, watch: &Watch) -> Result<Done, Error> {
    let mut outcome = boolean.run(parts, precision, watch)?;
    outcome.report.command = boolean.operation.to_string();
    Ok(outcome.into())
}

fn cluster(cluster: &Cluster, part: &Model, precision: Precision, watch: &Watch) -> Result<Done, Error> {
    let made = cluster.run(part, precision, watch)?;
    Ok(Done { nets: Some(made.nets_to_json()), outcome: made.outcome })
}

/// Parts are counted from 0, the target's own.
fn detail(detail: &Detail, parts: &[Model], precision: Precision, watch: &Watch) -> Result<Done, Fault> {
    let number = |name: &String| name.parse().ok().filter(|&part: &usize| part < parts.len());
    if detail.target().part.is_some() {
        return Err(OptionError::new("target", "is a region of the first mesh").into());
    }
    if let Some(name) = detail.source.iter().filter_map(|s| s.part.as_ref()).find(|name| number(name).is_none()) {
        return Err(OptionError::new("source", format!("there is no part {name:?}")).into());
    }
    let diagonal = bounds(&first(parts)?.mesh).diagonal();
    let place = |part: Option<&str>| part.and_then(|p| number(&p.to_string())).unwrap_or(0);
    let params = detail.params(diagonal, precision.into(), place)?;
    Ok(fusion::detail::detail(parts, &params, watch)?.into())
}

/// Files by their paths, relative to the working directory.
struct FromDisk;

impl Files for FromDisk {
    fn text(&mut self, path: &Path) -> Result<String, String> {
        fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))
    }

    fn mesh(&mut self, path: &Path) -> Result<TriMesh, String> {
        mesh_io::read(path).map(|model| model.mesh).map_err(|e| e.to_string())
    }
}
