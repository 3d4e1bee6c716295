//! Rational B-spline curves and rolling-ball blend profiles
