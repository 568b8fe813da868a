/* Time loop of the explicit reference: central differences, lumped mass, kinematic contact,
 * sub-cycling by levels.
 *
 * One step, n -> n+1 (Carpenter, Taylor & Katona 1991, Int. J. Numer. Meth. Eng. 32, 103):
 *   predictor   v <- v_{n-1/2} - dt M^-1 K u_n,  u <- u_n + dt v
 *   gap         g = g0 + u_s - u_p   per pair, along the pair's normal
 *   multiplier  lambda = max(0, -g) / (dt^2 (1/m_s + 1/m_p))
 *   corrector   v_{n+1/2} = v + dt M^-1 G^T lambda,  u_{n+1} = u + dt^2 M^-1 G^T lambda
 * The multiplier is the contact force of the pair at t_n.
 *
 * Sub-cycling: every element has a level l, K = sum K_l, and K_l acts at every 2^l-th step only,
 * with 2^l times the impulse (impulse form of the Verlet splitting: Tuckerman, Berne & Martyna
 * 1992, J. Chem. Phys. 97, 1990; per element: Lew, Marsden, Ortiz & West 2003, Arch. Rational
 * Mech. Anal. 167, 85). A node moves with the time step of its fastest element. Each K_l leaves a
 * rigid motion alone, so momentum is kept to round-off whatever the levels.
 */
#include <stdint.h>
#include <string.h>

typedef double pair __attribute__((vector_size(16)));
typedef int64_t pair_mask __attribute__((vector_size(16)));

enum { MAX_INTERVALS = 256 };

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

/* The elements of one level. Rows come in three groups: nodes that also have faster elements
 * (they only receive the impulse), nodes that move with this level, and those of them on the
 * support. Later rows never read the displacement of a row of the second and third group. */
typedef struct {
    int32_t shared;          /* end of the first group */
    int32_t shared_fixed;    /* where in the first group the nodes on the support begin */
    int32_t inner;           /* end of the second group */
    int32_t rows;            /* end of the third group */
    const int32_t *node;     /* (rows) */
    const int32_t *row;      /* (rows + 1) first block of each row */
    const int32_t *column;   /* node of each block: the row's own, then those of later rows */
    const double *block;     /* (4 per block) 2x2, column by column; the upper half of K_l */
} Level;

enum { MAX_LEVELS = 16 };

typedef struct {
    int64_t nodes;
    const double *inverse;   /* (2 nodes) 1/m, zero where fixed */
    double *u;               /* (2 nodes) displacement */
    double *v;               /* (2 nodes) velocity at half steps */
    double *f;               /* (2 nodes) work space, zero between sweeps */
    double dt;               /* of level 0, s */
    int64_t step;            /* steps of level 0 done */
    int32_t levels;
    int32_t contacts;
    double support_impulse;  /* of the support on the bodies along z, N s */
    double *velocity_before; /* (all pairs) work space */
    double body_mass[2];     /* of the spheres, kg */
    double rigid_start[2];   /* their velocities at the start, m/s */
    double rigid[2];         /* their rigid displacements, m: integrals of the impulse */
    int32_t centre[2];       /* the plate's centre nodes */
    Contact contact[2];
    Level level[MAX_LEVELS];
} State;

static inline pair load(const double *x) {
    pair value;
    memcpy(&value, x, sizeof value);
    return value;
}

static inline void store(double *x, pair value) { memcpy(x, &value, sizeof value); }

/* One block above the diagonal, in row i: adds its part to the row's sum and passes its mirror
 * image on to the later row j. */
static inline pair off_diagonal(const double *block, int64_t j, const double *x, pair xi,
                                double *y, pair sum) {
    const pair_mask low = {0, 2}, high = {1, 3};
    const pair first = load(block), second = load(block + 2);
    const pair a = first * xi, b = second * xi;
    store(y + 2 * j,
          load(y + 2 * j) + (__builtin_shuffle(a, b, low) + __builtin_shuffle(a, b, high)));
    return sum + first * x[2 * j] + second * x[2 * j + 1];
}

/* Row i of K_l x for node n, complete once the rows before it have been done: adds the node's own
 * and later neighbours' part to what earlier rows left in y, takes it out of y, and passes on to
 * later rows what they need (K_l is symmetric, only its upper half is stored and read). */
static inline pair row_product(const Level *l, const double *x, double *y, int64_t i, int64_t n) {
    const double *block = l->block + 4 * (int64_t)l->row[i];
    const int32_t *column = l->column + l->row[i];
    const int32_t count = l->row[i + 1] - l->row[i];
    const pair xi = load(x + 2 * n), zero = {0.0, 0.0};
    pair sum = load(y + 2 * n) + load(block) * xi[0] + load(block + 2) * xi[1];
    store(y + 2 * n, zero);
    if (count == 5) { /* inside a structured mesh: worth a loop without tests */
#pragma GCC unroll 4
        for (int p = 1; p < 5; ++p) sum = off_diagonal(block + 4 * p, column[p], x, xi, y, sum);
    } else {
        for (int32_t p = 1; p < count; ++p)
            sum = off_diagonal(block + 4 * p, column[p], x, xi, y, sum);
    }
    return sum;
}

/* result += K x; needs f as work space. */
void stiffness_product(const State *s, const double *x, double *result) {
    for (int32_t k = 0; k < s->levels; ++k) {
        const Level *l = &s->level[k];
        for (int64_t i = 0; i < l->rows; ++i) {
            const int64_t n = l->node[i];
            store(result + 2 * n, load(result + 2 * n) + row_product(l, x, s->f, i, n));
        }
    }
}

/* The impulse of one level, and the motion of its nodes over the time step h of the level. */
static void sweep(State *s, const Level *l, double h) {
    const double *inverse = s->inverse;
    double *u = s->u, *v = s->v, *f = s->f;
    double reaction = 0.0;
    int64_t i = 0;
    for (; i < l->shared; ++i) {
        const int64_t n = l->node[i];
        const pair force = row_product(l, u, f, i, n);
        store(v + 2 * n, load(v + 2 * n) - h * load(inverse + 2 * n) * force);
        if (i >= l->shared_fixed) reaction += force[1];
    }
    for (; i < l->inner; ++i) {
        const int64_t n = l->node[i];
        const pair force = row_product(l, u, f, i, n);
        const pair velocity = load(v + 2 * n) - h * load(inverse + 2 * n) * force;
        store(v + 2 * n, velocity);
        store(u + 2 * n, load(u + 2 * n) + h * velocity);
    }
    for (; i < l->rows; ++i) {
        const int64_t n = l->node[i];
        const pair force = row_product(l, u, f, i, n);
        const pair velocity = load(v + 2 * n) - h * load(inverse + 2 * n) * force;
        store(v + 2 * n, velocity);
        store(u + 2 * n, load(u + 2 * n) + h * velocity);
        reaction += force[1];
    }
    s->support_impulse += h * reaction;
}

/* Corrects the predicted displacements and velocities of a contact's nodes. */
static void correct(const State *s, Contact *c, const double *before) {
    const double dt = s->dt, n = c->normal;
    double force = 0.0, work = 0.0;
    for (int32_t k = 0; k < c->pairs; ++k) {
        const int64_t i = 2 * (int64_t)c->sphere[k] + 1, j = 2 * (int64_t)c->plate[k] + 1;
        const double gap = c->gap[k] + n * (s->u[i] - s->u[j]);
        if (gap >= 0.0) continue;
        const double lambda = -gap * c->compliance[k] / (dt * dt);
        const double sphere = n * dt * lambda * s->inverse[i];
        const double plate = -n * dt * lambda * s->inverse[j];
        s->v[i] += sphere;
        s->v[j] += plate;
        s->u[i] += dt * sphere;
        s->u[j] += dt * plate;
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

/* One step of level 0: velocities to t_{n+1/2}, displacements to t_{n+1}; of higher levels too if
 * theirs begins at t_n. Slower levels come first: they still need u_n of the faster nodes. */
static void advance(State *s) {
    const double dt = s->dt;
    const double *v = s->v;
    double *before = s->velocity_before;
    for (int32_t c = 0; c < s->contacts; ++c) {
        const Contact *contact = &s->contact[c];
        for (int32_t k = 0; k < contact->pairs; ++k)
            *before++ = contact->normal * (v[2 * (int64_t)contact->sphere[k] + 1]
                                           - v[2 * (int64_t)contact->plate[k] + 1]);
    }
    for (int32_t k = s->levels - 1; k >= 0; --k) {
        const int64_t every = (int64_t)1 << k;
        if (s->step % every == 0) sweep(s, &s->level[k], dt * (double)every);
    }
    before = s->velocity_before;
    for (int32_t c = 0; c < s->contacts; ++c) {
        Contact *contact = &s->contact[c];
        correct(s, contact, before);
        before += contact->pairs;
        /* The mean velocity follows from the impulse alone; the ledger checks that. */
        s->rigid[c] += dt * (s->rigid_start[c] + contact->normal * contact->impulse / s->body_mass[c]);
    }
    ++s->step;
}

static double centre(const State *s, const double *x) {
    return 0.5 * (x[2 * (int64_t)s->centre[0] + 1] + x[2 * (int64_t)s->centre[1] + 1]);
}

/* Advances by samples * stride steps and writes a row of 8 at the first step of each stride, all
 * at t_n: rigid displacement, velocity and impulse so far of the outer sphere, displacement and
 * velocity of the plate's centre, and the inner sphere's three. Velocities are the mean of both half
 * steps. */
void run(State *s, int64_t samples, int64_t stride, double *row) {
    for (int64_t j = 0; j < samples; ++j, row += 8) {
        const double last[2] = {s->contact[0].impulse, s->contact[1].impulse};
        row[0] = s->rigid[0];
        row[3] = centre(s, s->u);
        row[5] = s->rigid[1];
        row[4] = centre(s, s->v);
        advance(s);
        row[4] = 0.5 * (row[4] + centre(s, s->v));
        for (int c = 0; c < 2; ++c) {
            const Contact *contact = &s->contact[c];
            const double impulse = 0.5 * (last[c] + contact->impulse);
            row[c == 0 ? 2 : 7] = impulse;
            row[c == 0 ? 1 : 6] = s->rigid_start[c] + contact->normal * impulse / s->body_mass[c];
        }
        for (int64_t n = 1; n < stride; ++n) advance(s);
    }
}

/* The STREAM triad a = b + s c, repeated: what the memory that n numbers fit into delivers. */
void triad(double *restrict a, const double *restrict b, const double *restrict c, int64_t n,
           int64_t repetitions) {
    for (int64_t k = 0; k < repetitions; ++k) {
        for (int64_t i = 0; i < n; ++i) a[i] = b[i] + 0.5 * c[i];
        __asm__ volatile("" : : "r"(a) : "memory"); /* every repetition counts */
    }
}

int64_t state_size(void) { return (int64_t)sizeof(State); }
