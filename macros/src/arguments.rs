//! Arguments of the attribute.

use overact_codegen::derivation::MotionInput;
use overact_codegen::diagnostic::did_you_mean;
use overact_codegen::{Choice, Columns, Effort, Float, Runtime};
use proc_macro2::Span;
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Ident, LitStr, Token, bracketed};

/// Keys that may follow the path.
const KEYS: [&str; 6] = ["effort", "functions", "from", "columns", "float", "crate"];

/// Arguments of the attribute.
pub(crate) struct Arguments {
    pub(crate) path: LitStr,
    pub(crate) effort: Option<Effort>,
    /// `None` for all functions in all forms.
    pub(crate) functions: Option<Choice>,
    /// The floating-point type of generated code.
    pub(crate) float: Float,
    /// Path of the runtime crate in generated code, if given.
    pub(crate) runtime: Option<Runtime>,
}

impl Parse for Arguments {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let mut arguments = Self {
            path: input.parse()?,
            effort: None,
            functions: None,
            float: Float::default(),
            runtime: None,
        };
        let (mut given, mut from, mut columns) = (Vec::new(), None, None);
        while input.parse::<Option<Token![,]>>()?.is_some() && !input.is_empty() {
            let key = input.call(Ident::parse_any)?;
            let name = key.to_string();
            if !KEYS.contains(&name.as_str()) {
                return Err(syn::Error::new(key.span(), unknown_key(&name)));
            }
            if given.contains(&name) {
                let message = format!("`{name}` is given twice");
                return Err(syn::Error::new(key.span(), message));
            }
            input.parse::<Token![=]>()?;
            match name.as_str() {
                "effort" => {
                    let names = Effort::ALL.map(Effort::name);
                    arguments.effort = Some(one_of(&input.parse()?, &names, Effort::named)?);
                }
                "functions" => arguments.functions = Some(functions(input)?),
                "from" => from = Some(sources(input)?),
                "float" => {
                    let names = Float::ALL.map(Float::name);
                    arguments.float = one_of(&input.parse()?, &names, Float::named)?;
                }
                "columns" => {
                    let names = [Columns::Standard, Columns::Base].map(Columns::name);
                    columns = Some(one_of(&input.parse()?, &names, Columns::named)?);
                }
                _ => arguments.runtime = Some(runtime(&input.parse()?)?),
            }
            given.push(name);
        }
        if let Some(from) = from {
            let functions = arguments.functions.unwrap_or_default();
            arguments.functions = Some(functions.evaluated_from(from));
        }
        if let Some(columns) = columns {
            let functions = arguments.functions.unwrap_or_default();
            arguments.functions = Some(functions.with_columns(columns));
        }
        if input.is_empty() {
            Ok(arguments)
        } else {
            Err(input.error("expected `,`"))
        }
    }
}

fn unknown_key(name: &str) -> String {
    match did_you_mean(name, KEYS) {
        Some(help) => format!("unknown key `{name}`; {help}"),
        None => format!("expected {}", listed(&KEYS, '`')),
    }
}

/// `"a", "b" or "c"`.
fn listed(names: &[&str], quote: char) -> String {
    let quoted: Vec<String> = names
        .iter()
        .map(|name| format!("{quote}{name}{quote}"))
        .collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

/// Parses one of the values of these names.
fn one_of<T>(text: &LitStr, names: &[&str], named: impl Fn(&str) -> Option<T>) -> syn::Result<T> {
    let name = text.value();
    named(&name).ok_or_else(|| {
        let help = did_you_mean(&name, names.iter().copied());
        let help = help.map_or_else(String::new, |help| format!("; {help}"));
        let message = format!("expected {}{help}", listed(names, '"'));
        syn::Error::new(text.span(), message)
    })
}

/// Parses a list of texts, with its location.
fn texts(input: ParseStream<'_>, wanted: &str) -> syn::Result<(Vec<LitStr>, Span)> {
    let list;
    let bracket = bracketed!(list in input);
    let texts = Punctuated::<LitStr, Token![,]>::parse_terminated(&list);
    let texts = texts.map_err(|e| syn::Error::new(e.span(), format!("expected {wanted}")))?;
    Ok((texts.into_iter().collect(), bracket.span.join()))
}

/// Parses names of functions; each unknown name is an error at its location.
fn functions(input: ParseStream<'_>) -> syn::Result<Choice> {
    let wanted = "names of functions in quotes, `[\"control\", \"jacobian\"]`";
    let (names, place) = texts(input, wanted)?;
    let texts: Vec<String> = names.iter().map(LitStr::value).collect();
    if texts.is_empty() {
        let message = "name at least one function, or leave `functions` out for all of them";
        return Err(syn::Error::new(place, message));
    }
    Choice::new(texts.iter().map(String::as_str)).map_err(|unknown| {
        let errors = unknown.into_iter().map(|one| {
            let message = format!("{one}; {}", one.help);
            let span = names.get(one.index).map_or(place, LitStr::span);
            syn::Error::new(span, message)
        });
        all_of(errors).unwrap_or_else(|| syn::Error::new(place, "unknown functions"))
    })
}

/// Parses the inputs from which functions are evaluated.
fn sources(input: ParseStream<'_>) -> syn::Result<Vec<MotionInput>> {
    let (names, place) = texts(input, "a list, `[\"pose\", \"joints\"]`")?;
    if names.is_empty() {
        let message =
            "name at least one of \"pose\", \"joints\" and \"actuators\", or leave `from` out";
        return Err(syn::Error::new(place, message));
    }
    let known = MotionInput::ALL.map(MotionInput::name);
    let found = names
        .iter()
        .map(|name| one_of(name, &known, MotionInput::named));
    let (good, bad): (Vec<_>, Vec<_>) = found.partition(Result::is_ok);
    match all_of(bad.into_iter().filter_map(Result::err)) {
        Some(errors) => Err(errors),
        None => Ok(good.into_iter().flatten().collect()),
    }
}

fn runtime(text: &LitStr) -> syn::Result<Runtime> {
    Runtime::new(&text.value()).map_err(|e| syn::Error::new(text.span(), e.to_string()))
}

fn all_of(errors: impl Iterator<Item = syn::Error>) -> Option<syn::Error> {
    errors.reduce(|mut all, next| {
        all.combine(next);
        all
    })
}
