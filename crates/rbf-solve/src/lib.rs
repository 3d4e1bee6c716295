//! Variational implicit functions: radial basis fits with position and gradient constraints.
