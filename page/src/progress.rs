//! How far long work is, told to functions of the script.
//!
//! A worker has one thread, and its functions live on it: they are kept here, so that what asks for a watcher of
//! any thread is given one that holds nothing.

use js_sys::Function;
use std::cell::RefCell;
use wasm_bindgen::prelude::*;

thread_local! {
    static LISTENERS: RefCell<Option<Listeners>> = const { RefCell::new(None) };
}

struct Listeners {
    progress: Function,
    defect: Function,
}

/// From now on `progress` is called with the part of the work that is done, from 0 to 1, and a word on what is
/// being done; `defect` with what went wrong in overact itself, just before the module ends with a trap.
#[wasm_bindgen]
pub fn listen(progress: Function, defect: Function) {
    LISTENERS.set(Some(Listeners { progress, defect }));
    std::panic::set_hook(Box::new(|panic| {
        with_listeners(|all| drop(all.defect.call1(&JsValue::NULL, &panic.to_string().into())));
    }));
}

/// Tells how far the work is. A listener that fails is no reason to stop.
pub(crate) fn tell(part: f64, what: &str) {
    with_listeners(|all| {
        drop(
            all.progress
                .call2(&JsValue::NULL, &part.into(), &what.into()),
        )
    });
}

fn with_listeners(tell: impl FnOnce(&Listeners)) {
    LISTENERS.with_borrow(|all| all.as_ref().map(tell));
}
