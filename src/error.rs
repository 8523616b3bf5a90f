//! Why an input was refused.

/// An input that the theory or the code cannot accept: which, what it was, and what was expected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{field} = {value}: expected {expected}")]
pub struct InvalidInput {
    /// The quantity refused.
    pub field: String,
    /// Its value, as text.
    pub value: String,
    /// What would have been accepted.
    pub expected: String,
}

impl InvalidInput {
    pub(crate) fn new(field: &str, value: impl ToString, expected: &str) -> Self {
        Self { field: field.to_owned(), value: value.to_string(), expected: expected.to_owned() }
    }
}
