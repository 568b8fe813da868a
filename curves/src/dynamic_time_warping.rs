//! Dynamic time warping: pairs the samples of two curves so that their squared distance is least.
//!
//! H. Sakoe, S. Chiba, "Dynamic programming algorithm optimization for spoken word recognition",
//! IEEE Trans. ASSP 26 (1978), 43-49; symmetric steps of equal weight, band of constant width.

/// Optimal pairing of `a` and `b` (same length, not empty): index pairs from (0, 0) to (n-1, n-1).
///
/// Each step advances one index or both by one; |i - j| <= `band`.
pub(super) fn warping_path(a: &[f64], b: &[f64], band: usize) -> Vec<(usize, usize)> {
    let n = a.len();
    let width = 2 * band + 1;
    // Row i holds the cumulated cost of j = i - band ..= i + band.
    let mut cost = vec![f64::INFINITY; n * width];
    let column = |i: usize, j: usize| j + band - i;
    let at = |cost: &[f64], i: usize, j: usize| {
        if i.abs_diff(j) <= band { cost[i * width + column(i, j)] } else { f64::INFINITY }
    };
    for i in 0..n {
        for j in i.saturating_sub(band)..=(i + band).min(n - 1) {
            let before = match (i, j) {
                (0, 0) => 0.0,
                (0, _) => at(&cost, 0, j - 1),
                (_, 0) => at(&cost, i - 1, 0),
                _ => at(&cost, i - 1, j - 1).min(at(&cost, i - 1, j)).min(at(&cost, i, j - 1)),
            };
            cost[i * width + column(i, j)] = before + (a[i] - b[j]).powi(2);
        }
    }
    let (mut i, mut j) = (n - 1, n - 1);
    let mut path = vec![(i, j)];
    while (i, j) != (0, 0) {
        (i, j) = match (i, j) {
            (0, _) => (0, j - 1),
            (_, 0) => (i - 1, 0),
            _ => {
                let both = at(&cost, i - 1, j - 1);
                let (first, second) = (at(&cost, i - 1, j), at(&cost, i, j - 1));
                if both <= first && both <= second {
                    (i - 1, j - 1)
                } else if first <= second {
                    (i - 1, j)
                } else {
                    (i, j - 1)
                }
            }
        };
        path.push((i, j));
    }
    path.reverse();
    path
}
