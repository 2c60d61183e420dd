//! The path of the runtime crate in generated tokens.

use crate::runtime::Runtime;
use proc_macro2::{Group, TokenStream, TokenTree};

/// Replaces the path `::overact` of the runtime crate in tokens.
#[must_use]
pub fn renamed(tokens: TokenStream, runtime: &Runtime) -> TokenStream {
    if *runtime == Runtime::default() {
        return tokens;
    }
    // It is a path by the invariant of its type.
    let path: TokenStream = runtime.path().parse().unwrap_or_default();
    rename(tokens, &path)
}

fn rename(tokens: TokenStream, path: &TokenStream) -> TokenStream {
    let mut out: Vec<TokenTree> = Vec::new();
    for token in tokens {
        match token {
            TokenTree::Group(group) => {
                let mut inner = Group::new(group.delimiter(), rename(group.stream(), path));
                inner.set_span(group.span());
                out.push(inner.into());
            }
            TokenTree::Ident(name) if name == "overact" && begins_a_path(&out) => {
                out.truncate(out.len() - 2);
                out.extend(path.clone());
            }
            other => out.push(other),
        }
    }
    out.into_iter().collect()
}

/// Keywords that may precede a path.
const WORDS: [&str; 14] = [
    "as", "dyn", "else", "for", "if", "impl", "in", "let", "match", "mut", "return", "use",
    "where", "while",
];

/// Whether the last two tokens are `::` and the token before them ends no part of a path.
fn begins_a_path(tokens: &[TokenTree]) -> bool {
    let is_colon = |token: &TokenTree| matches!(token, TokenTree::Punct(p) if p.as_char() == ':');
    match tokens {
        [before @ .., first, second] if is_colon(first) && is_colon(second) => {
            let is_name = |token: &TokenTree| matches!(token, TokenTree::Ident(name) if !WORDS.iter().any(|word| name == word));
            !before.last().is_some_and(is_name)
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::{Runtime, renamed};
    use quote::quote;

    #[test]
    fn only_the_crate_path_is_replaced() {
        let tokens = quote! {
            #[doc = "::overact"]
            fn overact(a: &::overact::Error) -> [::overact::Parameter; 2] { b::overact(::core::a) }
            impl ::overact::Model for A { use ::overact::Error; }
            fn b() { if ::overact::simd::four() { return ::overact::a; } }
        };
        let wanted = quote! {
            #[doc = "::overact"]
            fn overact(a: &crate::my::Error) -> [crate::my::Parameter; 2] { b::overact(::core::a) }
            impl crate::my::Model for A { use crate::my::Error; }
            fn b() { if crate::my::simd::four() { return crate::my::a; } }
        };
        let path = Runtime::new("crate::my").expect("a path");
        assert_eq!(
            renamed(tokens.clone(), &path).to_string(),
            wanted.to_string()
        );
        assert_eq!(
            renamed(tokens.clone(), &Runtime::default()).to_string(),
            tokens.to_string()
        );
    }
}
