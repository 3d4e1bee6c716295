//! Eigenvectors and singular values of small matrices.

use glam::{DMat3, DVec3};
use nalgebra::{DMatrix, Matrix3, SymmetricEigen, Vector3};

/// Far more than are needed: convergence is cubic.
const MOST_STEPS: usize = 1000;

/// Orthonormal eigenvectors and eigenvalues of a symmetric matrix, smallest eigenvalue first; the axes and zeros where an entry is not
/// finite. The upper triangle is not read.
pub fn eigen3(matrix: DMat3) -> ([DVec3; 3], [f64; 3]) {
    let found = if matrix.is_finite() {
        SymmetricEigen::try_new(Matrix3::from_column_slice(&matrix.to_cols_array()), f64::EPSILON, MOST_STEPS)
    } else {
        None
    };
    let Some(found) = found else { return (DVec3::AXES, [0.0; 3]) };
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| found.eigenvalues[i].total_cmp(&found.eigenvalues[j]));
    (order.map(|i| point(found.eigenvectors.column(i).into())), order.map(|i| found.eigenvalues[i]))
}

/// Orthonormal eigenvectors of a symmetric `n` × `n` matrix in row order, largest eigenvalue first; none where `matrix` has another length or
/// an entry that is not finite. O(n³).
pub fn eigenvectors(matrix: &[f64], n: usize) -> Vec<Vec<f64>> {
    if matrix.len() != n * n || n == 0 || !matrix.iter().all(|x| x.is_finite()) {
        return vec![];
    }
    let square = DMatrix::from_row_slice(n, n, matrix);
    let Some(found) = SymmetricEigen::try_new(square, f64::EPSILON, n * MOST_STEPS) else { return vec![] };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| found.eigenvalues[j].total_cmp(&found.eigenvalues[i]).then(i.cmp(&j)));
    order.into_iter().map(|i| found.eigenvectors.column(i).iter().copied().collect()).collect()
}

/// U·diag(σ)·Vᵀ of a matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Svd {
    /// Orthonormal left vectors, in columns.
    pub left: DMat3,
    /// Singular values, largest first.
    pub values: DVec3,
    /// Orthonormal right vectors, in columns.
    pub right: DMat3,
}

/// Singular values of a matrix; `None` where an entry is not finite.
pub fn svd3(matrix: DMat3) -> Option<Svd> {
    if !matrix.is_finite() {
        return None;
    }
    let given = Matrix3::from_column_slice(&matrix.to_cols_array());
    let found = given.try_svd(true, true, f64::EPSILON, MOST_STEPS)?;
    let (left, right) = (found.u?, found.v_t?.transpose());
    let columns = |m: Matrix3<f64>| DMat3::from_cols_slice(m.as_slice());
    Some(Svd { left: columns(left), values: point(found.singular_values), right: columns(right) })
}

fn point(v: Vector3<f64>) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// By what eigenvectors are: M v = λ v, orthonormal, values ascending and of the matrix's trace.
        #[test]
        fn eigenvectors_are_eigenvectors(x in prop::array::uniform6(-1.0f64..1.0), scale in -200..200) {
            let m = 10f64.powi(scale) * DMat3::from_cols_array(&[x[0], x[1], x[2], x[1], x[3], x[4], x[2], x[4], x[5]]);
            let size = m.to_cols_array().iter().fold(0.0, |s: f64, x| s.max(x.abs()));
            let (axes, values) = eigen3(m);
            prop_assert!(values.is_sorted());
            prop_assert!((values.iter().sum::<f64>() - (m.x_axis.x + m.y_axis.y + m.z_axis.z)).abs() <= 1e-13 * size);
            let rows: Vec<f64> = m.to_cols_array().to_vec();
            for (i, all) in eigenvectors(&rows, 3).iter().rev().enumerate() {
                prop_assert!((m * axes[i] - values[i] * axes[i]).abs().max_element() <= 1e-13 * size);
                for j in 0..3 {
                    prop_assert!((axes[i].dot(axes[j]) - f64::from(u8::from(i == j))).abs() < 1e-13);
                }
                let other = DVec3::from_slice(all);
                prop_assert!((m * other - values[i] * other).abs().max_element() <= 1e-13 * size);
            }
        }

        #[test]
        fn singular_values_take_a_matrix_apart(x in prop::array::uniform9(-1.0f64..1.0)) {
            let m = DMat3::from_cols_array(&x);
            let svd = svd3(m).unwrap();
            let again = svd.left * DMat3::from_diagonal(svd.values) * svd.right.transpose();
            prop_assert!((again - m).to_cols_array().iter().all(|d| d.abs() < 1e-13));
            prop_assert!(svd.values.x >= svd.values.y && svd.values.y >= svd.values.z && svd.values.z >= 0.0);
            for side in [svd.left, svd.right] {
                prop_assert!((side.transpose() * side - DMat3::IDENTITY).to_cols_array().iter().all(|d| d.abs() < 1e-13));
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_answered() {
        let bad = DMat3::from_cols_array(&[f64::NAN; 9]);
        assert_eq!(eigen3(bad), (DVec3::AXES, [0.0; 3]));
        assert_eq!(svd3(bad), None);
        assert!(eigenvectors(&[f64::INFINITY], 1).is_empty() && eigenvectors(&[1.0], 2).is_empty());
    }
}
