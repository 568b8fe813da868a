/* Time loop of the explicit reference: central differences, lumped mass, kinematic contact.
 *
 * One step, n -> n+1 (Carpenter, Taylor & Katona 1991, Int. J. Numer. Meth. Eng. 32, 103):
 *   predictor   v <- v_{n-1/2} - dt M^-1 K u_n,  u <- u_n + dt v
 *   gap         g = g0 + u_s - u_p   per pair, along the pair's normal
 *   multiplier  lambda = max(0, -g) / (dt^2 (1/m_s + 1/m_p))
 *   corrector   v_{n+1/2} = v + dt M^-1 G^T lambda,  u_{n+1} = u + dt^2 M^-1 G^T lambda
 * The multiplier is the contact force of the pair at t_n.
 */
#include <stdint.h>
#include <string.h>

typedef double pair __attribute__((vector_size(16)));
typedef int64_t pair_mask __attribute__((vector_size(16)));

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
    const int64_t *row;      /* (nodes + 1) first block of each node */
    const int32_t *column;   /* node of each block: the node itself, then its later neighbours */
    const double *block;     /* (4 per block) 2x2, column by column; the upper half of K */
    const double *inverse;   /* (2 nodes) 1/m, zero where fixed */
    double *u;               /* (2 nodes) displacement */
    double *v;               /* (2 nodes) velocity at half steps */
    double *f;               /* (2 nodes) K u of the last step */
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

/* Row i of K x, complete once the rows before it have been done: adds the node's own and later
 * neighbours' part to what earlier rows left in y, and passes on to later rows what they need
 * (K is symmetric, only its upper half is stored and read). */
static inline pair row_product(const int64_t *restrict row, const int32_t *restrict columns,
                               const double *restrict blocks, const double *x, double *y,
                               int64_t i) {
    const double *block = blocks + 4 * row[i];
    const int32_t *column = columns + row[i];
    const int64_t count = row[i + 1] - row[i];
    const pair xi = load(x + 2 * i);
    pair sum = load(y + 2 * i) + load(block) * xi[0] + load(block + 2) * xi[1];
    if (count == 5) { /* inside a structured mesh: worth a loop without tests */
#pragma GCC unroll 4
        for (int p = 1; p < 5; ++p) sum = off_diagonal(block + 4 * p, column[p], x, xi, y, sum);
    } else {
        for (int64_t p = 1; p < count; ++p)
            sum = off_diagonal(block + 4 * p, column[p], x, xi, y, sum);
    }
    store(y + 2 * i, sum);
    return sum;
}

/* y = K x */
void stiffness_product(const State *s, const double *x, double *y) {
    memset(y, 0, 2 * (size_t)s->nodes * sizeof *y);
    for (int64_t i = 0; i < s->nodes; ++i) row_product(s->row, s->column, s->block, x, y, i);
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

/* One step: velocities to t_{n+1/2}, displacements to t_{n+1}. */
static void advance(State *s) {
    const double dt = s->dt;
    const double *restrict inverse = s->inverse;
    double *restrict u = s->u, *restrict v = s->v, *restrict f = s->f;
    const int64_t nodes = s->nodes;
    const int64_t *row = s->row;
    const int32_t *column = s->column;
    const double *block = s->block;
    double *before = s->velocity_before;
    for (int32_t c = 0; c < s->contacts; ++c) {
        const Contact *contact = &s->contact[c];
        for (int32_t k = 0; k < contact->pairs; ++k)
            *before++ = contact->normal * (v[2 * (int64_t)contact->sphere[k] + 1]
                                           - v[2 * (int64_t)contact->plate[k] + 1]);
    }
    memset(f, 0, 2 * (size_t)nodes * sizeof *f);
    for (int64_t i = 0; i < nodes; ++i) {
        const pair force = row_product(row, column, block, u, f, i);
        /* No later row reads u of this node any more. */
        const pair velocity = load(v + 2 * i) - dt * load(inverse + 2 * i) * force;
        store(v + 2 * i, velocity);
        store(u + 2 * i, load(u + 2 * i) + dt * velocity);
    }
    double reaction = 0.0;
    for (int32_t k = 0; k < s->supports; ++k) reaction += f[2 * (int64_t)s->support[k] + 1];
    s->support_impulse += dt * reaction;
    before = s->velocity_before;
    for (int32_t c = 0; c < s->contacts; ++c) {
        correct(s, &s->contact[c], before);
        before += s->contact[c].pairs;
    }
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
        advance(s);
        row[1] = 0.5 * (row[1] + mean(s, s->v, OUTER));
        row[4] = 0.5 * (row[4] + centre(s, s->v));
        row[6] = 0.5 * (row[6] + mean(s, s->v, INNER));
        row[2] = s->contact[0].impulse - 0.5 * s->dt * s->contact[0].force;
        row[7] = s->contact[1].impulse - 0.5 * s->dt * s->contact[1].force;
        for (int64_t n = 1; n < stride; ++n) advance(s);
    }
}

int64_t state_size(void) { return (int64_t)sizeof(State); }
