//! Elements of all sections: markup, tables and selections.

pub(crate) mod markup;
pub(crate) mod select;
pub(crate) mod table;
