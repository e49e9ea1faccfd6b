//! Quadratic energies of points that are free, slide or stay: what strips and
//! snakes are made of.
//!
//! `system` is the energy and its sparse matrix, `factor` solves it.

mod factor;
mod system;

pub(crate) use system::{Bounds, System, Term, Var};
