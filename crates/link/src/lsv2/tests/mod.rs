//! Tests: conversations as they stand on the line.
