/* Part of kernel.c: yielding as an initial strain. K stays the elastic one and constant; the plastic strain
 * eps_p of the elements that may yield acts as the load f_p = sum w B^T 2 mu eps_p on their nodes.
 *
 * Von Mises with isotropic hardening: radial return (Wilkins 1964; Simo & Hughes 1998, Computational
 * Inelasticity, ch. 3.3), with Cowper & Symonds' growth of the yield stress with the rate where there is one:
 *   q - 3 mu dp = (Y + H (p + dp)) (1 + (dp / (dt D))^(1/m)).
 * The four Gauss points of an element are the four numbers of a vector. Axisymmetric, two components. */

typedef double quad __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t quad_mask __attribute__((vector_size(32)));

/* A deviator: rr, tt, zz, rz, of a strain twice the last one. */
typedef struct {
    quad rr, tt, zz, rz;
} Deviator;

enum { CORNER = 4, POINTS = 4, GRADIENTS = 12 * POINTS };

static inline quad points(const double *x) { return *(const quad *)x; }

/* Stress deviator of element e if it does not yield in this step. */
static inline Deviator trial(const Plastic *p, int64_t e, const double *u) {
    const double *g = p->gradient + GRADIENTS * e, shear = p->shear[e];
    const int32_t *node = p->node + CORNER * e;
    quad rr = {0.0}, tt = {0.0}, zz = {0.0}, rz = {0.0};
    for (int a = 0; a < CORNER; ++a) {
        const double *x = u + 2 * (int64_t)node[a];
        const quad r = points(g + POINTS * a), z = points(g + POINTS * (4 + a));
        rr += r * x[0];
        tt += points(g + POINTS * (8 + a)) * x[0];
        zz += z * x[1];
        rz += z * x[0] + r * x[1];
    }
    const Deviator *strain = (const Deviator *)p->strain + e;
    const quad mean = (rr + tt + zz) / 3.0;
    return (Deviator){2.0 * shear * (rr - mean - strain->rr), 2.0 * shear * (tt - mean - strain->tt),
                      2.0 * shear * (zz - mean - strain->zz), shear * (rz - strain->rz)};
}

/* Increment of the plastic strain at a point of element e whose trial stress q lies beyond its yield stress. */
static double increment(const Plastic *p, int64_t e, double yield, double q, double dt) {
    const double stiffness = 3.0 * p->shear[e] + p->hardening[e];
    if (p->rate[e] == 0.0) return (q - yield) / stiffness;
    /* In x = (dp / (dt D))^(1/m) the equation is convex and grows: Newton's method from beyond the root. */
    const double unit = dt * p->rate[e], m = p->exponent[e];
    double x = fmin(q / yield - 1.0, pow((q - yield) / (stiffness * unit), 1.0 / m));
    for (int k = 0; k < 60; ++k) {
        const double dp = unit * pow(x, m), now = yield + p->hardening[e] * dp;
        const double miss = 3.0 * p->shear[e] * dp + now * (1.0 + x) - q;
        const double slope = m * dp / x * (3.0 * p->shear[e] + p->hardening[e] * (1.0 + x)) + now;
        const double change = miss / slope;
        x -= change;
        if (change <= 1e-14 * x) break;
    }
    return unit * pow(x, m);
}

/* Adds the load of more plastic strain in element e. */
static void load_nodes(const Plastic *p, int64_t e, const Deviator *more) {
    const double *g = p->gradient + GRADIENTS * e;
    const quad weight = points(p->weight + POINTS * e) * p->shear[e];
    const quad rr = 2.0 * weight * more->rr, tt = 2.0 * weight * more->tt;
    const quad zz = 2.0 * weight * more->zz, rz = weight * more->rz;
    for (int a = 0; a < CORNER; ++a) {
        double *force = p->force + 2 * (int64_t)p->node[CORNER * e + a];
        const quad r = points(g + POINTS * a), z = points(g + POINTS * (4 + a));
        const quad radial = r * rr + points(g + POINTS * (8 + a)) * tt + z * rz, axial = z * zz + r * rz;
        force[0] += (radial[0] + radial[1]) + (radial[2] + radial[3]);
        force[1] += (axial[0] + axial[1]) + (axial[2] + axial[3]);
    }
}

/* Lets the points of element e flow whose stress, squared, is beyond the yield stress. */
static void flow_element(Plastic *p, int64_t e, const Deviator *s, quad squared, quad yield, double dt) {
    Deviator *strain = (Deviator *)p->strain + e, more = {{0.0}};
    for (int k = 0; k < POINTS; ++k) {
        if (squared[k] <= yield[k] * yield[k]) continue;
        const double q = sqrt(squared[k]), dp = increment(p, e, yield[k], q, dt), share = 1.5 * dp / q;
        more.rr[k] = share * s->rr[k];
        more.tt[k] = share * s->tt[k];
        more.zz[k] = share * s->zz[k];
        more.rz[k] = 2.0 * share * s->rz[k];
        p->accumulated[POINTS * e + k] += dp;
        p->work[e] += p->weight[POINTS * e + k] * (q - 3.0 * p->shear[e] * dp) * dp;
    }
    strain->rr += more.rr;
    strain->tt += more.tt;
    strain->zz += more.zz;
    strain->rz += more.rz;
    load_nodes(p, e, &more);
}

/* The plastic strain at the displacements u of the step's start. */
static void flow(Plastic *p, const double *u, double dt) {
    for (int64_t e = 0; e < p->elements; ++e) {
        const Deviator s = trial(p, e, u);
        const quad squared = 1.5 * (s.rr * s.rr + s.tt * s.tt + s.zz * s.zz) + 3.0 * s.rz * s.rz;
        const quad yield = p->yield[e] + p->hardening[e] * points(p->accumulated + POINTS * e);
        const quad_mask beyond = squared > yield * yield;
        if (beyond[0] | beyond[1] | beyond[2] | beyond[3]) flow_element(p, e, &s, squared, yield, dt);
    }
}

/* The impulse of the plastic strain's load over a step. */
static void strain_impulse(const State *s, const Plastic *p) {
    const double dt = s->problem->dt;
    for (int64_t k = 0; k < p->nodes; ++k)
        for (int64_t i = 2 * (int64_t)p->touched[k], d = i; d < i + 2; ++d)
            s->v[d] += dt * s->inverse[d] * p->force[d];
}
