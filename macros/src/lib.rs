//! The attribute macro `#[redundant_robot("robot.toml")]`.
use proc_macro::TokenStream;

/// Derives a robot's model from its description.
#[proc_macro_attribute]
pub fn redundant_robot(_attribute: TokenStream, item: TokenStream) -> TokenStream {
    item
}
