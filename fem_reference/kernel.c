/* Time loop of the explicit reference: central differences, lumped mass, kinematic contact.
 *
 * One step, n -> n+1 (Carpenter, Taylor & Katona 1991, Int. J. Numer. Meth. Eng. 32, 103):
 *   predictor   v <- v_{n-1/2} - dt M^-1 K u_n
 *   gap         g = g0 + (u_s + dt v_s) - (u_p + dt v_p)   per pair, along the pair's normal
 *   multiplier  lambda = max(0, -g) / (dt^2 (1/m_s + 1/m_p))
 *   corrector   v <- v + dt M^-1 G^T lambda,  u_{n+1} = u_n + dt v_{n+1/2}
 * The multiplier is the contact force of the pair at t_n.
 */
#include <stdint.h>
#include <string.h>

typedef double pair2 __attribute__((vector_size(16)));
typedef double quad4 __attribute__((vector_size(32)));
typedef int64_t mask4 __attribute__((vector_size(32)));

enum { MAX_INTERVALS = 256 };
enum { OUTER = 0, PLATE = 1, INNER = 2 };

typedef struct {
    int32_t pairs;
    int32_t reserved;
    const int32_t *sphere;    /* node of each pair */
    const int32_t *plate;
    const double *gap;        /* initial gap, m */
    const double *compliance; /* 1 / (1/m_s + 1/m_p), kg */
    double normal;            /* +1: the sphere lies above the plate, -1: below */
    double impulse;           /* so far, N s, positive */
    double work;              /* done on the bodies by the contact force so far, J */
    double force;             /* of the last step, N */
    int64_t last;             /* last step with a force, -1: none */
    int64_t split;            /* a separation of more steps divides two contacts */
    int64_t intervals;        /* number of contacts so far */
    int64_t first_step[MAX_INTERVALS];
    int64_t last_step[MAX_INTERVALS];
    int32_t outermost;        /* largest index of a pair that carried force */
    int32_t reserved2;
} Contact;

typedef struct {
    int64_t nodes;
    const int64_t *row;      /* (nodes + 1) */
    const int32_t *column;   /* neighbour of each 2x2 block */
    const double *block;     /* (4, per block) column by column */
    const double *inverse;   /* (2 nodes) 1/m, zero where fixed */
    double *u;               /* (2 nodes) */
    double *v;               /* (2 nodes) at half steps */
    double dt;
    int64_t step;            /* steps done */
    int32_t supports;
    int32_t contacts;
    const int32_t *support;  /* nodes whose axial displacement is fixed */
    double support_impulse;  /* of the support on the bodies along z, N s */
    double *velocity_before; /* (all pairs) work space */
    const double *mass;      /* (nodes) kg */
    int64_t first[4];        /* first node of each body, then the number of nodes */
    int32_t centre[2];       /* the plate's centre nodes */
    Contact contact[2];
} State;

static inline pair2 row_product(const State *s, const double *x, int64_t i) {
    quad4 sum = {0.0, 0.0, 0.0, 0.0};
    const mask4 spread = {0, 0, 1, 1};
    for (int64_t p = s->row[i]; p < s->row[i + 1]; ++p) {
        quad4 a, b;
        const double *xj = x + 2 * (int64_t)s->column[p];
        memcpy(&a, s->block + 4 * p, sizeof a);
        b = (quad4){xj[0], xj[1], 0.0, 0.0};
        sum += a * __builtin_shuffle(b, spread);
    }
    return (pair2){sum[0] + sum[2], sum[1] + sum[3]};
}

/* y = K x */
void stiffness_product(const State *s, const double *x, double *y) {
    for (int64_t i = 0; i < s->nodes; ++i) {
        const pair2 f = row_product(s, x, i);
        y[2 * i] = f[0];
        y[2 * i + 1] = f[1];
    }
}

static void correct(const State *s, Contact *c, double *before) {
    const double dt = s->dt, n = c->normal;
    double force = 0.0, work = 0.0;
    for (int32_t k = 0; k < c->pairs; ++k) {
        const int64_t i = 2 * (int64_t)c->sphere[k] + 1, j = 2 * (int64_t)c->plate[k] + 1;
        const double gap = c->gap[k] + n * (s->u[i] + dt * s->v[i] - s->u[j] - dt * s->v[j]);
        if (gap >= 0.0) continue;
        const double lambda = -gap * c->compliance[k] / (dt * dt);
        s->v[i] += n * dt * lambda * s->inverse[i];
        s->v[j] -= n * dt * lambda * s->inverse[j];
        force += lambda;
        /* The discrete energy changes by exactly dt lambda times the mean relative velocity. */
        work += 0.5 * dt * lambda * (n * (s->v[i] - s->v[j]) + before[k]);
        if (k > c->outermost) c->outermost = k;
    }
    c->force = force;
    c->impulse += dt * force;
    c->work += work;
    if (force > 0.0) {
        if (c->last < 0 || s->step - c->last > c->split) {
            if (c->intervals < MAX_INTERVALS) c->first_step[c->intervals] = s->step;
            ++c->intervals;
        }
        c->last = s->step;
        const int64_t at = c->intervals < MAX_INTERVALS ? c->intervals : MAX_INTERVALS;
        c->last_step[at - 1] = s->step;
    }
}

/* Brings the velocities from t_{n-1/2} to t_{n+1/2}. */
static void kick(State *s) {
    const double dt = s->dt;
    double *restrict v = s->v;
    double *before = s->velocity_before;
    for (int32_t c = 0; c < s->contacts; ++c) {
        const Contact *contact = &s->contact[c];
        for (int32_t k = 0; k < contact->pairs; ++k)
            *before++ = contact->normal * (v[2 * (int64_t)contact->sphere[k] + 1]
                                           - v[2 * (int64_t)contact->plate[k] + 1]);
    }
    double reaction = 0.0;
    for (int32_t k = 0; k < s->supports; ++k) reaction += row_product(s, s->u, s->support[k])[1];
    s->support_impulse += dt * reaction;
    for (int64_t i = 0; i < s->nodes; ++i) {
        const pair2 f = row_product(s, s->u, i);
        v[2 * i] -= dt * s->inverse[2 * i] * f[0];
        v[2 * i + 1] -= dt * s->inverse[2 * i + 1] * f[1];
    }
    before = s->velocity_before;
    for (int32_t c = 0; c < s->contacts; ++c) {
        correct(s, &s->contact[c], before);
        before += s->contact[c].pairs;
    }
}

/* Brings the displacements from t_n to t_{n+1}. */
static void drift(State *s) {
    const double dt = s->dt;
    for (int64_t i = 0; i < 2 * s->nodes; ++i) s->u[i] += dt * s->v[i];
    ++s->step;
}

/* Mass average of the axial component of x over the body's nodes. */
static double mean(const State *s, const double *x, int32_t body) {
    double sum = 0.0, mass = 0.0;
    for (int64_t i = s->first[body]; i < s->first[body + 1]; ++i) {
        sum += s->mass[i] * x[2 * i + 1];
        mass += s->mass[i];
    }
    return sum / mass;
}

static double centre(const State *s, const double *x) {
    return 0.5 * (x[2 * (int64_t)s->centre[0] + 1] + x[2 * (int64_t)s->centre[1] + 1]);
}

/* Advances by samples * stride steps and writes a row of 8 at the first step of each stride, all
 * at t_n: displacement, velocity and impulse so far of the outer sphere, displacement and velocity
 * of the plate's centre, and the inner sphere's three. Velocities are the mean of both half steps. */
void run(State *s, int64_t samples, int64_t stride, double *row) {
    for (int64_t j = 0; j < samples; ++j, row += 8) {
        row[0] = mean(s, s->u, OUTER);
        row[3] = centre(s, s->u);
        row[5] = mean(s, s->u, INNER);
        row[1] = mean(s, s->v, OUTER);
        row[4] = centre(s, s->v);
        row[6] = mean(s, s->v, INNER);
        kick(s);
        row[1] = 0.5 * (row[1] + mean(s, s->v, OUTER));
        row[4] = 0.5 * (row[4] + centre(s, s->v));
        row[6] = 0.5 * (row[6] + mean(s, s->v, INNER));
        row[2] = s->contact[0].impulse - 0.5 * s->dt * s->contact[0].force;
        row[7] = s->contact[1].impulse - 0.5 * s->dt * s->contact[1].force;
        drift(s);
        for (int64_t n = 1; n < stride; ++n) {
            kick(s);
            drift(s);
        }
    }
}

int64_t state_size(void) { return (int64_t)sizeof(State); }
