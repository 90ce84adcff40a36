//! Part programs from one language into another, and the proof that both do the same.
