//! What a signal handler raises, Ctrl-C above all, while the core works.

use std::cell::RefCell;

use pyo3::marker::Ungil;
use pyo3::prelude::*;

use crate::InvalidInput;

thread_local! {
    /// What was raised since the work began.
    static RAISED: RefCell<Option<PyErr>> = const { RefCell::new(None) };
}

/// Answers signals; whether a handler has raised something since the work began.
pub fn interrupted() -> bool {
    if RAISED.with_borrow(Option::is_some) {
        return true;
    }
    // Nothing is borrowed meanwhile: a handler may use the core itself.
    let raised = Python::attach(|py| py.check_signals().err());
    let any = raised.is_some();
    RAISED.set(raised);
    any
}

/// Does work that asks [`interrupted`] without the interpreter, and raises what a handler raised.
///
/// # Errors
/// What a handler raised; else what the work was refused for.
pub fn detached<T, F>(py: Python<'_>, work: F) -> PyResult<T>
where
    T: Send,
    F: Ungil + FnOnce() -> Result<T, InvalidInput>,
{
    RAISED.set(None);
    let done = py.detach(work);
    match RAISED.take() {
        Some(raised) => Err(raised),
        None => Ok(done?),
    }
}
