//! Search for the least squares of the equations.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::equations::Equations;

/// Maximum number of steps of a search; usual ones need ten.
const STEPS: usize = 60;

/// Maximum number of dampings tried in one step.
const TRIALS: usize = 14;

/// Share of the sum of squares by which a step must improve it for the search to continue.
const GAIN: f64 = 1e-7;

/// The least squares.
#[derive(Clone, Debug)]
pub(super) struct Minimum {
    pub(super) unknowns: DVector<f64>,
}

/// Minimises the sum of squares from `unknowns`; `None` if they are not in the range of the curves.
///
/// # Source
/// Levenberg and Marquardt: `(H + λ diag H) step = -g`, with λ divided by 5 after an improvement and multiplied by 5
/// without one.
pub(super) fn minimise(equations: &Equations<'_>, mut unknowns: DVector<f64>) -> Option<Minimum> {
    let mut squares = equations.squares(&unknowns);
    if !squares.is_finite() {
        return None;
    }
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let normal = equations.normal(&unknowns);
        let mut better = None;
        for _ in 0..TRIALS {
            let step = damped(&normal.matrix, damping).map(|factors| factors.solve(&normal.gradient));
            let tried = step.map(|step| &unknowns - step);
            let found = tried.map(|tried| (equations.squares(&tried), tried));
            if let Some((less, tried)) = found
                && less < squares
            {
                better = Some((less, tried));
                damping /= 5.0;
                break;
            }
            damping *= 5.0;
        }
        let Some((less, tried)) = better else { break };
        let gain = squares - less;
        (squares, unknowns) = (less, tried);
        if gain < GAIN * squares {
            break;
        }
    }
    Some(Minimum { unknowns })
}

/// The logarithm of the determinant of the normal matrix at a minimum; `None` if the equations do not determine all
/// unknowns.
pub(super) fn log_determinant(equations: &Equations<'_>, minimum: &Minimum) -> Option<f64> {
    let factors = equations.normal(&minimum.unknowns).matrix.cholesky()?;
    Some(factors.l_dirty().diagonal().iter().map(|entry| 2.0 * entry.ln()).sum())
}

fn damped(matrix: &DMatrix<f64>, damping: f64) -> Option<Cholesky<f64, Dyn>> {
    let mut damped = matrix.clone();
    for index in 0..damped.nrows() {
        damped[(index, index)] *= 1.0 + damping;
    }
    damped.cholesky()
}

/// The covariance of the unknowns at a minimum, for weighted errors of variance 1; `None` if the equations do not
/// determine them.
pub(super) fn covariance(equations: &Equations<'_>, minimum: &Minimum) -> Option<DMatrix<f64>> {
    Some(equations.normal(&minimum.unknowns).matrix.cholesky()?.inverse())
}
