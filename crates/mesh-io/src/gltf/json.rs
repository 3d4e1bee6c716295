//! The JSON part of a glTF file, read leniently: only what is used must be well-formed.

use crate::error::Fault;
use serde_json::Value;

/// A value in the document, with its path for messages.
#[derive(Clone)]
pub(super) struct Node<'a> {
    pub value: &'a Value,
    pub path: String,
}

impl<'a> Node<'a> {
    pub fn root(value: &'a Value) -> Self {
        Self { value, path: String::new() }
    }

    pub fn fault(&self, reason: &str) -> Fault {
        Fault::whole(format!("{}: {reason}", self.path))
    }

    /// A member, `null` where absent.
    pub fn get(&self, key: &str) -> Self {
        let dot = if self.path.is_empty() { "" } else { "." };
        Self { value: self.value.get(key).unwrap_or(&Value::Null), path: format!("{}{dot}{key}", self.path) }
    }

    pub fn is_absent(&self) -> bool {
        self.value.is_null()
    }

    /// An item of an array that must have it.
    pub fn item(&self, index: usize) -> Result<Self, Fault> {
        let value = self.value.get(index).ok_or_else(|| self.fault(&format!("there is no item {index}")))?;
        Ok(Self { value, path: format!("{}[{index}]", self.path) })
    }

    /// The items of an array; none where absent.
    pub fn items(&self) -> Result<Vec<Self>, Fault> {
        match self.value {
            Value::Null => Ok(vec![]),
            Value::Array(items) => (0..items.len()).map(|i| self.item(i)).collect(),
            _ => Err(self.fault("an array should stand here")),
        }
    }

    /// A whole number; `None` where absent. Exporters write `3.0` at times.
    pub fn index(&self) -> Result<Option<usize>, Fault> {
        if self.is_absent() {
            return Ok(None);
        }
        let whole = || self.value.as_f64().filter(|x| *x >= 0.0 && x.fract() == 0.0 && *x < 9e15).map(|x| x as usize);
        let index = self.value.as_u64().and_then(|x| usize::try_from(x).ok()).or_else(whole);
        index.map(Some).ok_or_else(|| self.fault("a whole number should stand here"))
    }

    /// A whole number that must be there.
    pub fn expect_index(&self) -> Result<usize, Fault> {
        self.index()?.ok_or_else(|| self.fault("this number is missing"))
    }

    /// `N` finite numbers; `None` where absent.
    pub fn numbers<const N: usize>(&self) -> Result<Option<[f64; N]>, Fault> {
        if self.is_absent() {
            return Ok(None);
        }
        let numbers: Option<Vec<f64>> = self.value.as_array().and_then(|a| a.iter().map(Value::as_f64).collect());
        let array = numbers.and_then(|n| <[f64; N]>::try_from(n).ok()).filter(|n| n.iter().all(|x| x.is_finite()));
        array.map(Some).ok_or_else(|| self.fault(&format!("{N} numbers should stand here")))
    }

    pub fn text(&self) -> Option<&'a str> {
        self.value.as_str()
    }
}
