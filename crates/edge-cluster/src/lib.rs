//! Edge clusters of polyhedra blended by tensor-product and S-patches.
