//! Reports progress to functions of the script.
//!
//! A worker has one thread, and its functions stay on it. They are stored in a thread-local
//! variable, so that callbacks for other threads capture nothing.

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

/// Sets the listeners.
///
/// `progress` receives the completed fraction, from 0 to 1, and the current work. `defect` receives
/// an internal error just before the module traps.
#[wasm_bindgen]
pub fn listen(progress: Function, defect: Function) {
    LISTENERS.set(Some(Listeners { progress, defect }));
    std::panic::set_hook(Box::new(|panic| {
        with_listeners(|all| drop(all.defect.call1(&JsValue::NULL, &panic.to_string().into())));
    }));
}

/// Reports progress; a failing listener is ignored.
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
