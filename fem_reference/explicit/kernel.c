/* Time loop of the explicit reference: central differences, lumped mass, contact, sub-cycling by
 * levels. COMPONENTS of displacement per node is 2 (r, z) or 3 (x, y, z); the file is compiled for each.
 *
 * One step, n -> n+1 (Carpenter, Taylor & Katona 1991, Int. J. Numer. Meth. Eng. 32, 103):
 *   predictor   v <- v_{n-1/2} - dt M^-1 K u_n,  u <- u_n + dt v
 *   gap         g(u) of every candidate node that can touch, linear in u
 *   multipliers lambda >= 0, g + dt^2 G M^-1 G^T lambda >= 0, complementary
 *   corrector   v_{n+1/2} = v + dt M^-1 G^T lambda,  u_{n+1} = u + dt^2 M^-1 G^T lambda
 * The multiplier is the contact force of the candidate at t_n. Where the surface nodes of two bodies
 * match, the pairs are independent of each other: lambda = max(0, -g) / (dt^2 (1/m_s + 1/m_p)).
 * Elsewhere Gauss-Seidel; there contact sees only the surface nodes that can touch, in a numbering of
 * their own, so that a parallel run solves it redundantly in every process and gets the same forces.
 *
 * Sub-cycling: every element has a level l, K = sum K_l, and K_l acts at every 2^l-th step only,
 * with 2^l times the impulse (impulse form of the Verlet splitting: Tuckerman, Berne & Martyna
 * 1992, J. Chem. Phys. 97, 1990; per element: Lew, Marsden, Ortiz & West 2003, Arch. Rational
 * Mech. Anal. 167, 85). A node moves with the time step of its fastest element. Each K_l leaves a
 * rigid motion alone, so momentum is kept to round-off whatever the levels. Nodes that can touch have
 * elements of level 0 only.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { C = COMPONENTS, AXIAL = C - 1, MAX_INTERVALS = 256, FACET_NODES = 6, SAMPLED = 8 };
enum { AGAINST_SURFACE = 0, AGAINST_SPHERE = 1 };

/* What a contact has done so far. */
typedef struct {
    double impulse; /* of the sum of the multipliers so far, N s */
    double work;    /* on all bodies so far, J */
    double force;   /* that sum in the last step, N */
    int64_t last;   /* last step with a force, -1: none */
    int64_t split;  /* a separation of more steps divides two contacts */
    int64_t intervals;
    int64_t first_step[MAX_INTERVALS];
    int64_t last_step[MAX_INTERVALS];
    int64_t outermost; /* last candidate, in the order given, that carried a force; -1: none */
} Record;

/* Matching nodes of two bodies, the first above (+1) or below (-1) the second along the last axis. */
typedef struct {
    int64_t count;
    const int32_t *candidate;
    const int32_t *opposite;
    const double *gap;        /* initial gap, m */
    const double *compliance; /* 1 / (1/m_candidate + 1/m_opposite), kg */
    double *before;           /* (count) work space */
    double normal;
    Record record;
} Pairs;

/* A rigid body that moves without turning; vectors have room for three components. */
typedef struct {
    double mobility[9]; /* 3x3 inverse mass, zero along directions that are guided, 1/kg */
    double mass;        /* kg */
    double u[3];        /* displacement, m */
    double v[3];        /* velocity at half steps, m/s */
    double before[3];
    double force[3];    /* of the contacts in the last step, N */
} Rigid;

typedef struct {
    int32_t kind;
    int32_t count;         /* candidates */
    const int32_t *node;   /* (count) */
    const int32_t *facet;  /* (6 count) nodes of the facet opposite, kind AGAINST_SURFACE */
    const double *weight;  /* (6 count) shape functions there; zero where there is no node */
    double *normal;        /* (C count) from the facet or the sphere's centre to the candidate */
    double *gap;           /* (count) initial gap, m; of a sphere: at the predicted place */
    const double *place;   /* (C count) kind AGAINST_SPHERE: candidate minus the centre, m */
    double radius;         /* of the sphere, m */
    int32_t rigid;         /* body the sphere belongs to */
    int32_t reserved;
    double *lambda;        /* (count) multipliers of the last step, N */
    double *compliance;    /* (count) diagonal of G M^-1 G^T, 1/kg */
    int32_t *active;       /* (count) work space */
    double impulse[3];     /* on the candidates so far, N s */
    double force[3];       /* on the candidates in the last step, N */
    Record record;         /* of forces along each candidate's own normal */
} Contact;

typedef struct {
    int64_t nodes;          /* surface nodes that can touch */
    const int32_t *global;  /* (nodes) their number in the system */
    const double *inverse;  /* (C nodes) 1/m, zero where fixed */
    double *u;              /* (C nodes) work space: displacement */
    double *predicted;      /* (C nodes) velocity after the predictor */
    double *before;         /* (C nodes) velocity before it */
    double *force;          /* (C nodes) result, N */
    int32_t contacts;
    int32_t rigids;
    int64_t matched;
    Contact *contact;
    Rigid *rigid;
    Pairs *pairs;           /* (matched), in the numbering of the system */
    double dt;
    double tolerance;       /* of the multipliers, over the largest one */
    int64_t step;           /* steps done */
    int64_t sweeps;         /* Gauss-Seidel sweeps so far */
    int64_t unconverged;    /* steps that reached the largest number of sweeps */
    double reaction[3];     /* impulse of the supports on the bodies so far, N s */
} Problem;

/* The elements of one level. Rows come in four groups: nodes that also have faster elements (they only
 * receive the impulse), last those of them that are held somewhere; then nodes that move with this level,
 * last those of them that are held. Later rows never read the displacement of a row that moves. */
typedef struct {
    int64_t shared_free; /* ends of the groups */
    int64_t shared;
    int64_t free;
    int64_t rows;
    const int32_t *node;   /* (rows) */
    const int64_t *row;    /* (rows + 1) first block of each row */
    const int32_t *column; /* the row's own node, then those of later rows */
    const double *block;   /* (C^2 per block), the upper half of K_l; row by row, of two components column by column */
} Level;

typedef struct {
    int64_t nodes;
    int64_t levels;
    const Level *level;
    const double *inverse;  /* (C nodes) 1/m, zero where fixed */
    double *u;              /* (C nodes) displacement */
    double *v;              /* (C nodes) velocity at half steps */
    double *f;              /* (C nodes) work space, zero between sweeps */
    Problem *problem;
} State;

enum { MAX_SWEEPS = 1000 };

/* Row i of K_l x for node n, complete once the rows before it have been done: the node's own and later
 * neighbours' part, and what earlier rows left in y, which is taken out of it; passes on to later rows
 * what they need (K_l is symmetric, only its upper half is stored and read). */
#if COMPONENTS == 2
typedef double pair __attribute__((vector_size(16)));
typedef int64_t pair_mask __attribute__((vector_size(16)));

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

static inline pair row_product(const Level *l, const double *x, double *y, int64_t i, int64_t n) {
    const double *block = l->block + 4 * l->row[i];
    const int32_t *column = l->column + l->row[i];
    const int64_t count = l->row[i + 1] - l->row[i];
    const pair xi = load(x + 2 * n), zero = {0.0, 0.0};
    pair sum = load(y + 2 * n) + load(block) * xi[0] + load(block + 2) * xi[1];
    store(y + 2 * n, zero);
    if (count == 5) { /* inside a structured mesh: worth a loop without tests */
#pragma GCC unroll 4
        for (int p = 1; p < 5; ++p) sum = off_diagonal(block + 4 * p, column[p], x, xi, y, sum);
    } else {
        for (int64_t p = 1; p < count; ++p)
            sum = off_diagonal(block + 4 * p, column[p], x, xi, y, sum);
    }
    return sum;
}

typedef pair Vector;

static inline double component(Vector a, int d) { return a[d]; }

/* x += scale * factor * a, component by component */
static inline void add(double *x, double scale, const double *factor, Vector a) {
    store(x, load(x) + scale * load(factor) * a);
}

static inline void shift(double *u, double h, const double *v) { store(u, load(u) + h * load(v)); }
#else
typedef struct {
    double x[C];
} Vector;

static inline double component(Vector a, int d) { return a.x[d]; }

static inline void store(double *x, Vector a) { memcpy(x, a.x, sizeof a.x); }

static inline void add(double *x, double scale, const double *factor, Vector a) {
    for (int d = 0; d < C; ++d) x[d] += scale * factor[d] * a.x[d];
}

static inline void shift(double *u, double h, const double *v) {
    for (int d = 0; d < C; ++d) u[d] += h * v[d];
}

static inline Vector row_product(const Level *l, const double *restrict x, double *restrict y,
                                 int64_t row, int64_t i) {
    const double *restrict b = l->block + 9 * l->row[row];
    const int32_t *restrict column = l->column + l->row[row];
    const int64_t count = l->row[row + 1] - l->row[row];
    const double x0 = x[3 * i], x1 = x[3 * i + 1], x2 = x[3 * i + 2];
    double s0 = y[3 * i] + b[0] * x0 + b[1] * x1 + b[2] * x2;
    double s1 = y[3 * i + 1] + b[3] * x0 + b[4] * x1 + b[5] * x2;
    double s2 = y[3 * i + 2] + b[6] * x0 + b[7] * x1 + b[8] * x2;
    for (int64_t p = 1; p < count; ++p) {
        b += 9;
        const int64_t j = 3 * (int64_t)column[p];
        const double z0 = x[j], z1 = x[j + 1], z2 = x[j + 2];
        s0 += b[0] * z0 + b[1] * z1 + b[2] * z2;
        s1 += b[3] * z0 + b[4] * z1 + b[5] * z2;
        s2 += b[6] * z0 + b[7] * z1 + b[8] * z2;
        y[j] += b[0] * x0 + b[3] * x1 + b[6] * x2;
        y[j + 1] += b[1] * x0 + b[4] * x1 + b[7] * x2;
        y[j + 2] += b[2] * x0 + b[5] * x1 + b[8] * x2;
    }
    for (int d = 0; d < C; ++d) y[3 * i + d] = 0.0;
    return (Vector){{s0, s1, s2}};
}
#endif

/* y = (K_first + ... + K_{end-1}) x */
void stiffness_product(const State *s, int64_t first, int64_t end, const double *x, double *y) {
    memset(y, 0, C * (size_t)s->nodes * sizeof *y);
    for (int64_t k = first; k < end; ++k)
        for (int64_t i = 0; i < s->level[k].rows; ++i) {
            const int64_t n = s->level[k].node[i];
            store(y + C * n, row_product(&s->level[k], x, y, i, n));
        }
}

static inline double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + (C == 3 ? a[2] * b[2] : 0.0);
}

/* Relative value of x (per node) and of the rigid body's w, along the candidate's normal. */
static inline double relative(const Contact *c, int32_t k, const double *x, const double *w) {
    const double *n = c->normal + C * (int64_t)k;
    double value = dot(n, x + C * (int64_t)c->node[k]);
    if (c->kind == AGAINST_SPHERE) return value - dot(n, w);
    const int32_t *facet = c->facet + FACET_NODES * (int64_t)k;
    const double *weight = c->weight + FACET_NODES * (int64_t)k;
    for (int m = 0; m < FACET_NODES; ++m)
        if (weight[m] != 0.0) value -= weight[m] * dot(n, x + C * (int64_t)facet[m]);
    return value;
}

/* x += scale * inverse * normal on the candidate's side, and against it on the other. */
static inline void push(const Problem *p, const Contact *c, int32_t k, double scale, double *x,
                        double *w) {
    const double *n = c->normal + C * (int64_t)k;
    const int64_t i = C * (int64_t)c->node[k];
    for (int d = 0; d < C; ++d) x[i + d] += scale * p->inverse[i + d] * n[d];
    if (c->kind == AGAINST_SPHERE) {
        const double *mobility = p->rigid[c->rigid].mobility;
        for (int d = 0; d < C; ++d) w[d] -= scale * dot(mobility + 3 * d, n);
        return;
    }
    for (int m = 0; m < FACET_NODES; ++m) {
        const double weight = c->weight[FACET_NODES * (int64_t)k + m];
        if (weight == 0.0) continue;
        const int64_t j = C * (int64_t)c->facet[FACET_NODES * (int64_t)k + m];
        for (int d = 0; d < C; ++d) x[j + d] -= scale * weight * p->inverse[j + d] * n[d];
    }
}

/* Diagonal of G M^-1 G^T. */
static double diagonal(const Problem *p, const Contact *c, int32_t k) {
    const double *n = c->normal + C * (int64_t)k;
    const int64_t i = C * (int64_t)c->node[k];
    double sum = 0.0;
    for (int d = 0; d < C; ++d) sum += p->inverse[i + d] * n[d] * n[d];
    if (c->kind == AGAINST_SPHERE) {
        const double *mobility = p->rigid[c->rigid].mobility;
        for (int d = 0; d < C; ++d) sum += n[d] * dot(mobility + 3 * d, n);
        return sum;
    }
    for (int m = 0; m < FACET_NODES; ++m) {
        const double weight = c->weight[FACET_NODES * (int64_t)k + m];
        const int64_t j = C * (int64_t)c->facet[FACET_NODES * (int64_t)k + m];
        for (int d = 0; d < C && weight != 0.0; ++d)
            sum += weight * weight * p->inverse[j + d] * n[d] * n[d];
    }
    return sum;
}

/* The gap of a candidate from a sphere, its normal, and both linearised at the predicted place. */
static void aim_at_sphere(const Problem *p, Contact *c) {
    const Rigid *r = &p->rigid[c->rigid];
    for (int32_t k = 0; k < c->count; ++k) {
        double *n = c->normal + C * (int64_t)k;
        const double *u = p->u + C * (int64_t)c->node[k];
        for (int d = 0; d < C; ++d) n[d] = c->place[C * (int64_t)k + d] + u[d] - r->u[d];
        const double distance = sqrt(dot(n, n));
        for (int d = 0; d < C; ++d) n[d] /= distance;
        /* gap + relative(u) is the true distance at the predicted place */
        c->gap[k] = distance - c->radius - relative(c, k, p->u, r->u);
    }
}

/* Multipliers of all contacts. p->u and the rigid bodies' u serve as work space. */
static void solve(Problem *p) {
    const double dt2 = p->dt * p->dt;
    int64_t listed = 0;
    int32_t size[p->contacts > 0 ? p->contacts : 1];
    for (int32_t a = 0; a < p->contacts; ++a) {
        Contact *c = &p->contact[a];
        memset(c->lambda, 0, (size_t)c->count * sizeof *c->lambda);
        if (c->kind == AGAINST_SPHERE) aim_at_sphere(p, c);
        size[a] = 0;
    }
    for (int sweep = 0;;) {
        /* Everything that penetrates joins the list; nothing new and all quiet: done. */
        int64_t before = listed;
        for (int32_t a = 0; a < p->contacts; ++a) {
            Contact *c = &p->contact[a];
            double *w = c->kind == AGAINST_SPHERE ? p->rigid[c->rigid].u : 0;
            for (int32_t k = 0; k < c->count; ++k) {
                if (c->lambda[k] != 0.0 || c->gap[k] + relative(c, k, p->u, w) >= 0.0) continue;
                int32_t seen = 0;
                for (int32_t q = 0; q < size[a]; ++q) seen |= c->active[q] == k;
                if (seen) continue;
                c->compliance[k] = dt2 * diagonal(p, c, k);
                if (c->compliance[k] <= 0.0) continue; /* both sides fixed: nothing to correct */
                c->active[size[a]++] = k;
                ++listed;
            }
        }
        if (listed == before) return;
        for (;; ++sweep) {
            double largest = 0.0, change = 0.0;
            for (int32_t a = 0; a < p->contacts; ++a) {
                Contact *c = &p->contact[a];
                double *w = c->kind == AGAINST_SPHERE ? p->rigid[c->rigid].u : 0;
                for (int32_t q = 0; q < size[a]; ++q) {
                    const int32_t k = c->active[q];
                    const double gap = c->gap[k] + relative(c, k, p->u, w);
                    double step = -gap / c->compliance[k];
                    if (step < -c->lambda[k]) step = -c->lambda[k];
                    c->lambda[k] += step;
                    push(p, c, k, dt2 * step, p->u, w);
                    if (c->lambda[k] > largest) largest = c->lambda[k];
                    if (fabs(step) > change) change = fabs(step);
                }
            }
            ++p->sweeps;
            if (change <= p->tolerance * largest) break;
            if (sweep >= MAX_SWEEPS) {
                ++p->unconverged;
                return;
            }
        }
    }
}

/* Notes whether a contact is closed at a step. */
static void record(Record *r, double force, int64_t step) {
    r->force = force;
    if (!(force > 0.0)) return;
    if (r->last < 0 || step - r->last > r->split) {
        if (r->intervals < MAX_INTERVALS) r->first_step[r->intervals] = step;
        ++r->intervals;
    }
    r->last = step;
    const int64_t at = r->intervals < MAX_INTERVALS ? r->intervals : MAX_INTERVALS;
    r->last_step[at - 1] = step;
}

static void ledger(Problem *p, Contact *c) {
    double total = 0.0;
    memset(c->force, 0, sizeof c->force);
    for (int32_t k = 0; k < c->count; ++k) {
        const double lambda = c->lambda[k];
        if (lambda == 0.0) continue;
        const double *n = c->normal + C * (int64_t)k;
        total += lambda;
        for (int d = 0; d < C; ++d) c->force[d] += lambda * n[d];
        if (k > c->record.outermost) c->record.outermost = k;
    }
    for (int d = 0; d < C; ++d) c->impulse[d] += p->dt * c->force[d];
    c->record.impulse += p->dt * total;
    record(&c->record, total, p->step);
}

/* Contact forces on the surface nodes, into p->force, from p->u, p->predicted and p->before;
 * takes the rigid bodies through the step. */
void contact_step(Problem *p) {
    const double dt = p->dt;
    for (int32_t b = 0; b < p->rigids; ++b) {
        Rigid *r = &p->rigid[b];
        memcpy(r->before, r->v, sizeof r->v);
        for (int d = 0; d < C; ++d) r->u[d] += dt * r->v[d];
        memset(r->force, 0, sizeof r->force);
    }
    double rigid_u[3 * (p->rigids > 0 ? p->rigids : 1)];
    for (int32_t b = 0; b < p->rigids; ++b) memcpy(rigid_u + 3 * b, p->rigid[b].u, 3 * sizeof(double));
    solve(p);
    /* The forces from the multipliers, so that action and reaction cancel to round-off. */
    memset(p->force, 0, C * (size_t)p->nodes * sizeof *p->force);
    for (int32_t a = 0; a < p->contacts; ++a) {
        Contact *c = &p->contact[a];
        ledger(p, c);
        for (int32_t k = 0; k < c->count; ++k) {
            const double lambda = c->lambda[k];
            if (lambda == 0.0) continue;
            const double *n = c->normal + C * (int64_t)k;
            for (int d = 0; d < C; ++d) {
                p->force[C * (int64_t)c->node[k] + d] += lambda * n[d];
                if (c->kind == AGAINST_SPHERE) p->rigid[c->rigid].force[d] -= lambda * n[d];
            }
            for (int m = 0; m < FACET_NODES && c->kind == AGAINST_SURFACE; ++m) {
                const double share = lambda * c->weight[FACET_NODES * (int64_t)k + m];
                const int64_t j = C * (int64_t)c->facet[FACET_NODES * (int64_t)k + m];
                for (int d = 0; d < C; ++d) p->force[j + d] -= share * n[d];
            }
        }
    }
    for (int32_t b = 0; b < p->rigids; ++b) {
        Rigid *r = &p->rigid[b];
        for (int d = 0; d < C; ++d) {
            const double change = dt * dot(r->mobility + 3 * d, r->force);
            r->v[d] += change;
            r->u[d] = rigid_u[3 * b + d] + dt * change;
            /* What a guide takes up. */
            p->reaction[d] += r->mass * change - dt * r->force[d];
        }
    }
    for (int64_t i = 0; i < C * p->nodes; ++i) {
        p->predicted[i] += dt * p->inverse[i] * p->force[i];
        if (p->inverse[i] == 0.0) p->reaction[i % C] -= dt * p->force[i];
    }
    /* The discrete energy changes by exactly dt lambda times the mean relative velocity. */
    for (int32_t a = 0; a < p->contacts; ++a) {
        Contact *c = &p->contact[a];
        const Rigid *r = c->kind == AGAINST_SPHERE ? &p->rigid[c->rigid] : 0;
        for (int32_t k = 0; k < c->count; ++k)
            if (c->lambda[k] != 0.0)
                c->record.work += 0.5 * dt * c->lambda[k]
                           * (relative(c, k, p->predicted, r ? r->v : 0)
                              + relative(c, k, p->before, r ? r->before : 0));
    }
    ++p->step;
}

/* Corrects the predicted displacements and velocities of matching nodes. */
static void correct(const State *s, Pairs *c) {
    const double dt = s->problem->dt, n = c->normal;
    double force = 0.0, work = 0.0;
    for (int64_t k = 0; k < c->count; ++k) {
        const int64_t i = C * (int64_t)c->candidate[k] + AXIAL, j = C * (int64_t)c->opposite[k] + AXIAL;
        const double gap = c->gap[k] + n * (s->u[i] - s->u[j]);
        if (gap >= 0.0) continue;
        const double lambda = -gap * c->compliance[k] / (dt * dt);
        const double candidate = n * dt * lambda * s->inverse[i];
        const double opposite = -n * dt * lambda * s->inverse[j];
        s->v[i] += candidate;
        s->v[j] += opposite;
        s->u[i] += dt * candidate;
        s->u[j] += dt * opposite;
        force += lambda;
        /* The discrete energy changes by exactly dt lambda times the mean relative velocity. */
        work += 0.5 * dt * lambda * (n * (s->v[i] - s->v[j]) + c->before[k]);
        if (k > c->record.outermost) c->record.outermost = k;
    }
    c->record.impulse += dt * force;
    c->record.work += work;
    record(&c->record, force, s->problem->step);
}

/* Rows of one group: the impulse of their level over its time step h; the motion of those that move;
 * the support's impulse on those that are held. */
static inline __attribute__((always_inline)) void group(const State *s, const Level *l, double h,
                                                        int64_t from, int64_t to, int moves, int held,
                                                        double *reaction) {
    double *u = s->u, *v = s->v, *f = s->f;
    const double *inverse = s->inverse;
    for (int64_t i = from; i < to; ++i) {
        const int64_t n = l->node[i];
        const Vector force = row_product(l, u, f, i, n);
        add(v + C * n, -h, inverse + C * n, force);
        for (int d = 0; held && d < C; ++d)
            if (inverse[C * n + d] == 0.0) reaction[d] += h * component(force, d);
        /* No later row reads u of this node any more. */
        if (moves) shift(u + C * n, h, v + C * n);
    }
}

/* Step number ``step`` without contact. Slower levels come first: they still need u_n of the faster
 * nodes. */
static void predict(const State *s, int64_t step, double *reaction) {
    for (int64_t k = s->levels - 1; k >= 0; --k) {
        const int64_t every = (int64_t)1 << k;
        if (step % every != 0) continue;
        const Level *l = &s->level[k];
        const double h = s->problem->dt * (double)every;
        group(s, l, h, 0, l->shared_free, 0, 0, reaction);
        group(s, l, h, l->shared_free, l->shared, 0, 1, reaction);
        group(s, l, h, l->shared, l->free, 1, 0, reaction);
        group(s, l, h, l->free, l->rows, 1, 1, reaction);
    }
}

/* Advances the elastic bodies alone by a number of steps, from an instant at which all levels meet;
 * neither contact nor ledger. */
void drift(State *s, int64_t steps) {
    double reaction[3] = {0.0, 0.0, 0.0};
    for (int64_t n = 0; n < steps; ++n) predict(s, n, reaction);
}

static void one_step(State *s) {
    Problem *p = s->problem;
    const double dt = p->dt;
    double *u = s->u, *v = s->v;
    for (int64_t c = 0; c < p->matched; ++c) {
        const Pairs *q = &p->pairs[c];
        for (int64_t k = 0; k < q->count; ++k)
            q->before[k] = q->normal * (v[C * (int64_t)q->candidate[k] + AXIAL]
                                        - v[C * (int64_t)q->opposite[k] + AXIAL]);
    }
    for (int64_t i = 0; i < p->nodes; ++i)
        memcpy(p->before + C * i, v + C * (int64_t)p->global[i], C * sizeof *v);
    predict(s, p->step, p->reaction);
    for (int64_t c = 0; c < p->matched; ++c) correct(s, &p->pairs[c]);
    for (int64_t i = 0; i < p->nodes; ++i) {
        const int64_t g = C * (int64_t)p->global[i];
        memcpy(p->u + C * i, u + g, C * sizeof *u);
        memcpy(p->predicted + C * i, v + g, C * sizeof *v);
    }
    contact_step(p);
    for (int64_t i = 0; i < p->nodes; ++i) {
        const int64_t g = C * (int64_t)p->global[i];
        for (int d = 0; d < C; ++d) {
            const double change = dt * s->inverse[g + d] * p->force[C * i + d];
            v[g + d] += change;
            u[g + d] += dt * change;
        }
    }
}

/* Advances a system that lies in one process by a number of steps. */
void advance(State *s, int64_t steps) {
    for (int64_t n = 0; n < steps; ++n) one_step(s);
}

/* A body that nothing acts on but one contact of matching nodes: its mean motion along the last axis
 * follows from the impulse alone, which the ledger checks. */
typedef struct {
    double mass;         /* kg */
    double start;        /* velocity at the start, m/s */
    double displacement; /* m */
} Carried;

static double mean(const double *x, const int32_t *node) {
    return 0.5 * (x[C * (int64_t)node[0] + AXIAL] + x[C * (int64_t)node[1] + AXIAL]);
}

/* Advances by samples * stride steps with two contacts of matching nodes and writes a row of SAMPLED
 * numbers at the first step of each stride, all at t_n: displacement, velocity and impulse so far of
 * the first carried body, mean displacement and velocity of two watched nodes, and the second body's
 * three. Velocities are the mean of both half steps. */
void run(State *s, Carried *body, const int32_t *watched, int64_t samples, int64_t stride, double *row) {
    const Pairs *pairs = s->problem->pairs;
    for (int64_t j = 0; j < samples; ++j, row += SAMPLED) {
        const double last[2] = {pairs[0].record.impulse, pairs[1].record.impulse};
        row[0] = body[0].displacement;
        row[3] = mean(s->u, watched);
        row[5] = body[1].displacement;
        row[4] = mean(s->v, watched);
        for (int64_t n = 0; n < stride; ++n) {
            one_step(s);
            for (int c = 0; c < 2; ++c)
                body[c].displacement += s->problem->dt * (body[c].start + pairs[c].normal
                                                          * pairs[c].record.impulse / body[c].mass);
            if (n > 0) continue;
            row[4] = 0.5 * (row[4] + mean(s->v, watched));
            for (int c = 0; c < 2; ++c) {
                const double impulse = 0.5 * (last[c] + pairs[c].record.impulse);
                row[c == 0 ? 2 : 7] = impulse;
                row[c == 0 ? 1 : 6] = body[c].start + pairs[c].normal * impulse / body[c].mass;
            }
        }
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

int64_t layout(int32_t what) {
    const size_t size[] = {sizeof(Record), sizeof(Pairs), sizeof(Rigid), sizeof(Contact), sizeof(Problem),
                           sizeof(Level),  sizeof(State), sizeof(Carried)};
    return (int64_t)size[what];
}
