//! What an error's message is like.

/// A refusal says something, on one line unless it quotes the file.
pub(crate) fn is_told(error: &impl std::fmt::Display) {
    let message = error.to_string();
    assert!(message.chars().count() > 10, "'{message}' says nothing");
    assert!(message.len() < 20_000, "a message of {} bytes", message.len());
}
