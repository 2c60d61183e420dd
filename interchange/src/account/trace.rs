//! Records which attributes and children readers request, to test the tables.

use std::{cell::RefCell, collections::BTreeSet};

thread_local! {
    static ATTRIBUTES: RefCell<BTreeSet<(String, String)>> = const { RefCell::new(BTreeSet::new()) };
    static CHILDREN: RefCell<BTreeSet<(String, String)>> = const { RefCell::new(BTreeSet::new()) };
}

/// Records a request for an attribute.
pub(crate) fn attribute(element: &str, name: &str) {
    ATTRIBUTES.with_borrow_mut(|all| all.insert((element.to_owned(), name.to_owned())));
}

/// Records a request for a child element.
pub(crate) fn child(element: &str, name: &str) {
    CHILDREN.with_borrow_mut(|all| all.insert((element.to_owned(), name.to_owned())));
}

/// Pairs of an element and its attribute or child.
type RequestedNames = BTreeSet<(String, String)>;

/// Returns and clears the requests for attributes and children on this thread.
pub(crate) fn take() -> (RequestedNames, RequestedNames) {
    (ATTRIBUTES.take(), CHILDREN.take())
}
