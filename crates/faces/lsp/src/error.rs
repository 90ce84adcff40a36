//! Why the server has ended.

/// Why the server has ended before the request to exit.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The editor broke the protocol.
    #[error("the editor does not keep to the protocol: {0}")]
    Protocol(#[from] lsp_server::ProtocolError),
    /// The editor sent what cannot be read.
    #[error("what the editor sends cannot be read: {0}")]
    Json(#[from] serde_json::Error),
    /// What comes cannot be read any more, or nothing can be written.
    #[error("{0}")]
    Stream(String),
    /// The editor has gone without a word.
    #[error("the editor has gone")]
    EditorGone,
    /// The thread that examines documents has ended.
    #[error("documents are not examined any more")]
    BackgroundGone,
}
