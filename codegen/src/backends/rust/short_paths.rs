//! Short paths in generated tokens.
//!
//! The code may be in any scope, where `f64` or `Result` may be other types. So it is generated
//! with absolute paths, `::core::primitive::f64`, and placed in a block that imports them. In that
//! block the last name of a path is enough.

use proc_macro2::{Group, Ident, TokenStream, TokenTree};
use quote::quote;

/// The imported paths.
///
/// A longer path comes before its beginnings. Names of types with other meanings for users, such as
/// `Model`, are not imported.
const IMPORTED: [&str; 16] = [
    "core::primitive::bool",
    "core::primitive::f32",
    "core::primitive::f64",
    "core::primitive::str",
    "core::primitive::usize",
    "core::result::Result::Err",
    "core::result::Result::Ok",
    "core::result::Result",
    "overact::ActuatorGroup",
    "overact::Error",
    "overact::guard",
    "overact::math",
    "overact::simd",
    "overact::with_avx2",
    "overact::with_avx512",
    "overact::zeroed_then_fill",
];

/// Items with short paths, and the imports that they need.
pub(super) struct ShortPaths {
    /// `use` items.
    pub(super) imports: TokenStream,
    /// The items.
    pub(super) items: TokenStream,
}

/// Shortens the paths in `items` whose last name is not `taken` by the robot's type.
pub(super) fn shortened(items: TokenStream, taken: &Ident) -> ShortPaths {
    let mut used = [false; IMPORTED.len()];
    let items = shorten(items, taken, &mut used);
    let used = IMPORTED.iter().zip(used).filter(|(_, used)| *used);
    let used: Vec<(&str, &str)> = used
        .filter_map(|(path, _)| path.rsplit_once("::"))
        .collect();
    let imports = used.chunk_by(|a, b| a.0 == b.0).map(import);
    ShortPaths {
        imports: imports.collect(),
        items,
    }
}

/// The import of names from one module or type.
fn import(names: &[(&str, &str)]) -> TokenStream {
    let path = |text: &str| -> TokenStream { text.parse().unwrap_or_default() };
    let module = path(names[0].0);
    match names {
        [(_, name)] => {
            let name = path(name);
            quote!(use ::#module::#name;)
        }
        _ => {
            let names = names.iter().map(|(_, name)| path(name));
            quote!(use ::#module::{#(#names),*};)
        }
    }
}

fn shorten(items: TokenStream, taken: &Ident, used: &mut [bool]) -> TokenStream {
    let tokens: Vec<TokenTree> = items.into_iter().collect();
    let mut out: Vec<TokenTree> = Vec::new();
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        let begins = !ends_path(&out);
        if begins && let Some(import) = imported(&tokens[at..], taken) {
            used[import.index] = true;
            out.push(import.name);
            at += import.tokens;
            continue;
        }
        out.push(match token {
            TokenTree::Group(group) => {
                let inner = shorten(group.stream(), taken, used);
                let mut group_out = Group::new(group.delimiter(), inner);
                group_out.set_span(group.span());
                group_out.into()
            }
            other => other.clone(),
        });
        at += 1;
    }
    out.into_iter().collect()
}

/// Whether a path that starts after these tokens continues theirs, as in `a::b`.
///
/// It does not after a keyword or a lifetime.
fn ends_path(tokens: &[TokenTree]) -> bool {
    const KEYWORDS: [&str; 11] = [
        "as", "dyn", "else", "for", "if", "impl", "in", "let", "match", "mut", "return",
    ];
    let is_quote = |token: &TokenTree| matches!(token, TokenTree::Punct(p) if p.as_char() == '\'');
    match tokens {
        [.., quote, TokenTree::Ident(_)] if is_quote(quote) => false,
        [.., TokenTree::Ident(name)] => !KEYWORDS.iter().any(|keyword| name == keyword),
        _ => false,
    }
}

/// A path at the start of tokens.
struct Import {
    /// Its place in [`IMPORTED`].
    index: usize,
    /// Its last name.
    name: TokenTree,
    /// Number of its tokens.
    tokens: usize,
}

/// The imported path at the start of `tokens`.
fn imported(tokens: &[TokenTree], taken: &Ident) -> Option<Import> {
    let starts_with = |path: &str| {
        let mut count = 0;
        for segment in path.split("::") {
            let [
                TokenTree::Punct(a),
                TokenTree::Punct(b),
                TokenTree::Ident(name),
                ..,
            ] = tokens.get(count..)?
            else {
                return None;
            };
            if a.as_char() != ':' || b.as_char() != ':' || name != segment {
                return None;
            }
            count += 3;
        }
        Some(count)
    };
    let mut paths = IMPORTED.iter().enumerate();
    paths.find_map(|(index, path)| {
        let count = starts_with(path)?;
        let name = tokens[count - 1].clone();
        let is_taken = matches!(&name, TokenTree::Ident(name) if name == taken);
        (!is_taken).then_some(Import {
            index,
            name,
            tokens: count,
        })
    })
}

#[cfg(test)]
mod tests {
    use super::shortened;
    use proc_macro2::{Ident, Span};
    use quote::quote;

    #[test]
    fn paths_are_imported_unless_they_clash_with_the_robot() {
        let items = quote! {
            fn f(a: &'static [::core::primitive::f64; 2], b: &'static ::core::primitive::str) -> ::core::result::Result<[f64; 1], ::overact::Error> {
                if ::overact::simd::four() { return ::core::result::Result::Ok([a::core::b]); }
                ::overact::other::guard(Self::core)
            }
        };
        let of = |name: &str| shortened(items.clone(), &Ident::new(name, Span::call_site()));
        let short = of("DualV");
        let wanted = quote! {
            fn f(a: &'static [f64; 2], b: &'static str) -> Result<[f64; 1], Error> {
                if simd::four() { return Ok([a::core::b]); }
                ::overact::other::guard(Self::core)
            }
        };
        assert_eq!(short.items.to_string(), wanted.to_string());
        let imports = quote! {
            use ::core::primitive::{f64, str};
            use ::core::result::Result::Ok;
            use ::core::result::Result;
            use ::overact::{Error, simd};
        };
        assert_eq!(short.imports.to_string(), imports.to_string());
        let text = of("Error").items.to_string();
        assert!(text.contains(":: overact :: Error"), "{text}");
    }
}
