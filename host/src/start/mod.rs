//! Initial states.
