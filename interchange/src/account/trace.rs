//! What readers ask of elements, recorded for the test of the tables.

use std::{cell::RefCell, collections::BTreeSet};

thread_local! {
    static ATTRIBUTES: RefCell<BTreeSet<(String, String)>> = const { RefCell::new(BTreeSet::new()) };
    static CHILDREN: RefCell<BTreeSet<(String, String)>> = const { RefCell::new(BTreeSet::new()) };
}

/// Records that an attribute of an element was asked for.
pub(crate) fn attribute(element: &str, name: &str) {
    ATTRIBUTES.with_borrow_mut(|all| all.insert((element.to_owned(), name.to_owned())));
}

/// Records that an element inside another was asked for.
pub(crate) fn child(element: &str, name: &str) {
    CHILDREN.with_borrow_mut(|all| all.insert((element.to_owned(), name.to_owned())));
}

/// Names of elements, with those of their attributes or of elements inside them.
type Asked = BTreeSet<(String, String)>;

/// All attributes and children that were asked for on this thread, which are forgotten.
pub(crate) fn take() -> (Asked, Asked) {
    (ATTRIBUTES.take(), CHILDREN.take())
}
