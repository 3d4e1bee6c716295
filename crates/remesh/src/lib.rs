//! Area-equalizing remeshing, smoothing and fairing with frozen boundaries and features.
