//! The macros that define operations and the words their options take: one entry holds all there is to say of an option.

/// Defines an operation: its struct with everything that is derived from it, and its `Default`. Each option is one entry:
/// its sentence (help, schema and page print it), how it is typed, its type and its default. `[rolling]` before the struct
/// adds the options of `rolling.rs`. Types are taken apart, since derives would not know an `Option` in a fragment.
macro_rules! operation {
    ([rolling] $($definition:tt)*) => {
        $crate::operation::rolling::with_rolling_options! { { $($definition)* } }
    };
    (
        {
            $(#[$attribute:meta])*
            pub struct $name:ident {
                $($(#[$own:meta])* $field:ident: $type:ident $(<$of:ty>)? = $default:expr;)*
            }
        }
        $($(#[$common:meta])* $shared:ident: $shared_type:ident $(<$shared_of:ty>)? = $shared_default:expr;)*
    ) => {
        $crate::operation::define::operation! {
            $(#[$attribute])*
            pub struct $name {
                $($(#[$own])* $field: $type $(<$of>)? = $default;)*
                $($(#[$common])* $shared: $shared_type $(<$shared_of>)? = $shared_default;)*
            }
        }

        impl From<&$name> for $crate::operation::rolling::Rolling {
            fn from(operation: &$name) -> Self {
                Self { $($shared: operation.$shared.clone(),)* }
            }
        }
    };
    (
        $(#[$attribute:meta])*
        pub struct $name:ident {
            $($(#[$own:meta])* $field:ident: $type:ident $(<$of:ty>)? = $default:expr;)*
        }
    ) => {
        #[derive(Clone, Debug, PartialEq)]
        #[derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema, derive_setters::Setters)]
        #[cfg_attr(feature = "clap", derive(clap::Args))]
        #[cfg_attr(feature = "clap", group(skip))]
        #[serde(default, deny_unknown_fields)]
        #[setters(prefix = "with_", into, strip_option)]
        #[non_exhaustive]
        $(#[$attribute])*
        pub struct $name {
            $($(#[$own])* pub $field: $type $(<$of>)?,)*
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }
    };
}
pub(crate) use operation;

/// Defines an enum whose values are words, the same for every door. `not` words are refused with a hint.
macro_rules! words {
    (
        $(#[$attribute:meta])*
        pub enum $name:ident: $what:literal {
            $($(#[doc = $doc:literal])+ $variant:ident = $word:literal,)+
            $(not $former:literal: $hint:literal,)*
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, schemars::JsonSchema)]
        pub enum $name {
            $($(#[doc = $doc])+ #[schemars(rename = $word)] $variant,)+
        }

        impl $crate::operation::words::Words for $name {
            const WORDS: &'static [(&'static str, &'static str)] = &[$(($word, concat!($($doc),+)),)+];
        }

        impl std::str::FromStr for $name {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                match text {
                    $($word => Ok(Self::$variant),)+
                    $($former => Err($hint.into()),)*
                    _ => Err($crate::operation::words::expected::<Self>($what)),
                }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(match self { $(Self::$variant => $word,)+ })
            }
        }

        $crate::operation::define::as_text! { $name }

        #[cfg(feature = "clap")]
        impl clap::builder::ValueParserFactory for $name {
            type Parser = $crate::operation::words::WordParser<Self>;

            fn value_parser() -> Self::Parser {
                $crate::operation::words::WordParser::default()
            }
        }
    };
}
pub(crate) use words;

/// Reads and writes a type as the text that its `FromStr` and `Display` know.
macro_rules! as_text {
    ($name:ty) => {
        impl serde::Serialize for $name {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }

        impl<'de> serde::Deserialize<'de> for $name {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                <String as serde::Deserialize>::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
            }
        }
    };
}
pub(crate) use as_text;
