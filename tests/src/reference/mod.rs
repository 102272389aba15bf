//! Independent references in double precision.
