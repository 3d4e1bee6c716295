//! Options that take one of a few words.

/// A type whose values are words.
pub trait Words: Sized + 'static {
    /// Every word, and what it means.
    const WORDS: &'static [(&'static str, &'static str)];
}

/// What stands in an error: every word that would have been right.
pub(crate) fn expected<T: Words>(what: &str) -> String {
    let words: Vec<&str> = T::WORDS.iter().map(|w| w.0).collect();
    match words.split_last() {
        Some((last, [])) => format!("{what} is {last}"),
        Some((last, others)) => format!("{what} is {} or {last}", others.join(", ")),
        None => what.into(),
    }
}

/// Reads words, and lists them in help and completions.
#[cfg(feature = "clap")]
#[derive(Clone, Debug)]
pub struct WordParser<T>(std::marker::PhantomData<fn() -> T>);

#[cfg(feature = "clap")]
impl<T> Default for WordParser<T> {
    fn default() -> Self {
        Self(std::marker::PhantomData)
    }
}

#[cfg(feature = "clap")]
impl<T> clap::builder::TypedValueParser for WordParser<T>
where
    T: Words + std::str::FromStr<Err = String> + Clone + Send + Sync,
{
    type Value = T;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &std::ffi::OsStr,
    ) -> Result<T, clap::Error> {
        let parse = |text: &str| text.parse::<T>();
        parse.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = clap::builder::PossibleValue> + '_>> {
        let value = |&(word, meaning): &(&'static str, &'static str)| {
            clap::builder::PossibleValue::new(word).help(meaning.trim())
        };
        Some(Box::new(T::WORDS.iter().map(value)))
    }
}
