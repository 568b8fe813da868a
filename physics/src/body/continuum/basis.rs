//! Lagrange basis of arbitrary order on Gauss-Lobatto nodes, and Gauss quadrature, on [-1, 1].

/// Legendre polynomial P_n and its derivative at `x`, by the three-term recurrence.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut current) = (1.0, x);
    if n == 0 {
        return (1.0, 0.0);
    }
    for k in 2..=n {
        let k = k as f64;
        (previous, current) = (current, ((2.0 * k - 1.0) * x * current - (k - 1.0) * previous) / k);
    }
    (current, n as f64 * (x * current - previous) / (x * x - 1.0))
}

/// Points and weights of Gauss-Legendre quadrature with `n` points (exact to degree 2n - 1).
pub(super) fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|i| {
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            for _ in 0..50 {
                let (p, dp) = legendre(n, x);
                x -= p / dp;
                if (p / dp).abs() < 1e-16 {
                    break;
                }
            }
            let (_, dp) = legendre(n, x);
            (x, 2.0 / ((1.0 - x * x) * dp * dp))
        })
        .collect()
}

/// The `order + 1` Gauss-Lobatto points: -1, 1 and the zeros of P'_order, ascending.
fn gauss_lobatto(order: usize) -> Vec<f64> {
    let n = order as f64;
    (0..=order)
        .map(|i| {
            if i == 0 {
                return -1.0;
            }
            if i == order {
                return 1.0;
            }
            // Newton on P'_n; P'' follows from Legendre's equation.
            let mut x = -(std::f64::consts::PI * i as f64 / n).cos();
            for _ in 0..50 {
                let (p, dp) = legendre(order, x);
                let ddp = (2.0 * x * dp - n * (n + 1.0) * p) / (1.0 - x * x);
                x -= dp / ddp;
                if (dp / ddp).abs() < 1e-16 {
                    break;
                }
            }
            x
        })
        .collect()
}

/// Lagrange basis of one order in one dimension.
#[derive(Debug, Clone)]
pub(super) struct Basis {
    /// Nodes on [-1, 1], ascending. Shape (order + 1).
    pub nodes: Vec<f64>,
}

impl Basis {
    pub fn new(order: usize) -> Self {
        Self { nodes: gauss_lobatto(order) }
    }

    /// Values of all basis functions at `x`. Shape (order + 1).
    pub fn values(&self, x: f64) -> Vec<f64> {
        let node = |j: usize| self.nodes[j];
        (0..self.nodes.len())
            .map(|i| {
                (0..self.nodes.len())
                    .filter(|&j| j != i)
                    .map(|j| (x - node(j)) / (node(i) - node(j)))
                    .product()
            })
            .collect()
    }

    /// Derivatives of all basis functions at `x`. Shape (order + 1).
    pub fn derivatives(&self, x: f64) -> Vec<f64> {
        let n = self.nodes.len();
        let node = |j: usize| self.nodes[j];
        (0..n)
            .map(|i| {
                (0..n)
                    .filter(|&k| k != i)
                    .map(|k| {
                        let rest: f64 = (0..n)
                            .filter(|&j| j != i && j != k)
                            .map(|j| (x - node(j)) / (node(i) - node(j)))
                            .product();
                        rest / (node(i) - node(k))
                    })
                    .sum()
            })
            .collect()
    }
}

/// Values and derivatives of the tensor-product basis at one quadrature point of the square [-1, 1]^2.
///
/// Node (i, j) of an element of order p has the index `i (p + 1) + j`; i runs along xi, j along eta.
#[derive(Debug, Clone)]
pub(super) struct QuadraturePoint {
    pub weight: f64,
    /// Shape ((p + 1)^2).
    pub value: Vec<f64>,
    /// Derivative along xi. Shape ((p + 1)^2).
    pub d_xi: Vec<f64>,
    /// Derivative along eta. Shape ((p + 1)^2).
    pub d_eta: Vec<f64>,
}

/// The tensor-product basis at (p + 1)^2 Gauss points: exact for degree 2p + 1 in each direction,
/// that is for mass and stiffness with the weight r on rectangles.
pub(super) fn tabulate(order: usize) -> Vec<QuadraturePoint> {
    let basis = Basis::new(order);
    let rule = gauss_legendre(order + 1);
    let product =
        |a: &[f64], b: &[f64]| -> Vec<f64> { a.iter().flat_map(|x| b.iter().map(move |y| x * y)).collect() };
    let mut points = Vec::with_capacity(rule.len() * rule.len());
    for &(xi, weight_xi) in &rule {
        for &(eta, weight_eta) in &rule {
            let (value_xi, value_eta) = (basis.values(xi), basis.values(eta));
            points.push(QuadraturePoint {
                weight: weight_xi * weight_eta,
                value: product(&value_xi, &value_eta),
                d_xi: product(&basis.derivatives(xi), &value_eta),
                d_eta: product(&value_xi, &basis.derivatives(eta)),
            });
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn gauss_rule_is_exact_to_degree_2n_minus_1() {
        for n in 1..=12 {
            let degree = 2 * n - 2;
            let sum: f64 = gauss_legendre(n).iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
            assert_relative_eq!(sum, 2.0 / (degree as f64 + 1.0), max_relative = 1e-13);
        }
    }

    #[test]
    fn lobatto_nodes_of_order_4_are_sqrt_3_over_7() {
        let nodes = gauss_lobatto(4);
        let inner = (3.0f64 / 7.0).sqrt();
        for (node, expected) in nodes.iter().zip([-1.0, -inner, 0.0, inner, 1.0]) {
            assert!((node - expected).abs() < 1e-15, "{node} {expected}");
        }
    }

    #[test]
    fn basis_reproduces_a_polynomial_of_its_order_and_the_derivative() {
        for order in 1..=6 {
            let basis = Basis::new(order);
            let power = order as i32;
            let x: f64 = 0.37;
            let sum = |weights: Vec<f64>| -> f64 {
                weights.iter().zip(&basis.nodes).map(|(w, s)| w * s.powi(power)).sum()
            };
            assert_relative_eq!(sum(basis.values(x)), x.powi(power), max_relative = 1e-12);
            assert_relative_eq!(
                sum(basis.derivatives(x)),
                f64::from(power) * x.powi(power - 1),
                max_relative = 1e-12
            );
        }
    }
}
