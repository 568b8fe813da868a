/* Time loop of the three-dimensional reference: central differences, lumped mass, contact,
 * sub-cycling by levels.
 *
 * One step, n -> n+1 (Carpenter, Taylor & Katona 1991, Int. J. Numer. Meth. Eng. 32, 103):
 *   predictor   v <- v_{n-1/2} - dt M^-1 K u_n,  u <- u_n + dt v
 *   gap         g(u) of every candidate node that can touch, linear in u
 *   multipliers lambda >= 0, g + dt^2 G M^-1 G^T lambda >= 0, complementary (Gauss-Seidel)
 *   corrector   v_{n+1/2} = v + dt M^-1 G^T lambda,  u_{n+1} = u + dt^2 M^-1 G^T lambda
 * Contact sees only the surface nodes that can touch, in a numbering of their own, so that a
 * parallel run solves it redundantly in every process and gets the same forces.
 *
 * Sub-cycling as in ../kernel.c: K = sum K_l, and K_l acts at every 2^l-th step with 2^l times the
 * impulse. Nodes that can touch have elements of level 0 only.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

enum { MAX_INTERVALS = 256, FACET_NODES = 6 };
enum { AGAINST_SURFACE = 0, AGAINST_SPHERE = 1 };

/* A rigid body that moves without turning. */
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
    double *normal;        /* (3 count) from the facet or the sphere's centre to the candidate */
    double *gap;           /* (count) initial gap, m; of a sphere: at the predicted place */
    const double *place;   /* (3 count) kind AGAINST_SPHERE: candidate minus the centre, m */
    double radius;         /* of the sphere, m */
    int32_t rigid;         /* body the sphere belongs to */
    int32_t outermost;     /* last candidate, in the order given, that carried a force; -1: none */
    double *lambda;        /* (count) multipliers of the last step, N */
    double *compliance;    /* (count) diagonal of G M^-1 G^T, 1/kg */
    int32_t *active;       /* (count) work space */
    double impulse[3];     /* on the candidates so far, N s */
    double normal_impulse; /* the same, summed along each candidate's own normal, N s */
    double force[3];       /* on the candidates in the last step, N */
    double work;           /* on all bodies so far, J */
    int64_t last;          /* last step with a force, -1: none */
    int64_t split;         /* a separation of more steps divides two contacts */
    int64_t intervals;
    int64_t first_step[MAX_INTERVALS];
    int64_t last_step[MAX_INTERVALS];
} Contact;

typedef struct {
    int64_t nodes;          /* surface nodes that can touch */
    const int32_t *global;  /* (nodes) their number in the system */
    const double *inverse;  /* (3 nodes) 1/m, zero where fixed */
    double *u;              /* (3 nodes) work space: displacement */
    double *predicted;      /* (3 nodes) velocity after the predictor */
    double *before;         /* (3 nodes) velocity before it */
    double *force;          /* (3 nodes) result, N */
    int32_t contacts;
    int32_t rigids;
    Contact *contact;
    Rigid *rigid;
    double dt;
    double tolerance;       /* of the multipliers, over the largest one */
    int64_t step;           /* steps done */
    int64_t sweeps;         /* Gauss-Seidel sweeps so far */
    int64_t unconverged;    /* steps that reached the largest number of sweeps */
    double reaction[3];     /* impulse of the supports on the bodies so far, N s */
} Problem;

/* The elements of one level. First come the rows of nodes that also have faster elements (they only
 * receive the impulse), then those of nodes that move with this level. */
typedef struct {
    int64_t shared;         /* end of the first group */
    int64_t rows;
    const int32_t *node;    /* (rows) */
    const int64_t *row;     /* (rows + 1) first block of each row */
    const int32_t *column;  /* the row's own node, then those of later rows */
    const double *block;    /* (9 per block) 3x3, row by row; the upper half of K_l */
} Level;

typedef struct {
    int64_t nodes;
    int64_t levels;
    const Level *level;
    const double *inverse;  /* (3 nodes) 1/m, zero where fixed */
    double *u;              /* (3 nodes) displacement */
    double *v;              /* (3 nodes) velocity at half steps */
    double *f;              /* (3 nodes) work space, zero between sweeps */
    Problem *problem;
} State;

enum { MAX_SWEEPS = 1000 };

/* Row i of K_l x, into y at the row's node; complete once the rows before it have been done (see
 * ../kernel.c). */
static inline void row_product(const Level *l, const double *restrict x, double *restrict y,
                               int64_t row) {
    const double *restrict b = l->block + 9 * l->row[row];
    const int32_t *restrict column = l->column + l->row[row];
    const int64_t count = l->row[row + 1] - l->row[row];
    const int64_t i = l->node[row];
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
    y[3 * i] = s0;
    y[3 * i + 1] = s1;
    y[3 * i + 2] = s2;
}

/* y = (K_first + ... + K_{end-1}) x */
void stiffness_product(const State *s, int64_t first, int64_t end, const double *x, double *y) {
    memset(y, 0, 3 * (size_t)s->nodes * sizeof *y);
    for (int64_t k = first; k < end; ++k)
        for (int64_t i = 0; i < s->level[k].rows; ++i) row_product(&s->level[k], x, y, i);
}

static inline double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Relative value of x (per node) and of the rigid body's w, along the candidate's normal. */
static inline double relative(const Contact *c, int32_t k, const double *x, const double *w) {
    const double *n = c->normal + 3 * (int64_t)k;
    double value = dot(n, x + 3 * (int64_t)c->node[k]);
    if (c->kind == AGAINST_SPHERE) return value - dot(n, w);
    const int32_t *facet = c->facet + FACET_NODES * (int64_t)k;
    const double *weight = c->weight + FACET_NODES * (int64_t)k;
    for (int m = 0; m < FACET_NODES; ++m)
        if (weight[m] != 0.0) value -= weight[m] * dot(n, x + 3 * (int64_t)facet[m]);
    return value;
}

/* x += scale * inverse * normal on the candidate's side, and against it on the other. */
static inline void push(const Problem *p, const Contact *c, int32_t k, double scale, double *x,
                        double *w) {
    const double *n = c->normal + 3 * (int64_t)k;
    const int64_t i = 3 * (int64_t)c->node[k];
    for (int d = 0; d < 3; ++d) x[i + d] += scale * p->inverse[i + d] * n[d];
    if (c->kind == AGAINST_SPHERE) {
        const double *mobility = p->rigid[c->rigid].mobility;
        for (int d = 0; d < 3; ++d) w[d] -= scale * dot(mobility + 3 * d, n);
        return;
    }
    for (int m = 0; m < FACET_NODES; ++m) {
        const double weight = c->weight[FACET_NODES * (int64_t)k + m];
        if (weight == 0.0) continue;
        const int64_t j = 3 * (int64_t)c->facet[FACET_NODES * (int64_t)k + m];
        for (int d = 0; d < 3; ++d) x[j + d] -= scale * weight * p->inverse[j + d] * n[d];
    }
}

/* Diagonal of G M^-1 G^T. */
static double diagonal(const Problem *p, const Contact *c, int32_t k) {
    const double *n = c->normal + 3 * (int64_t)k;
    const int64_t i = 3 * (int64_t)c->node[k];
    double sum = 0.0;
    for (int d = 0; d < 3; ++d) sum += p->inverse[i + d] * n[d] * n[d];
    if (c->kind == AGAINST_SPHERE) {
        const double *mobility = p->rigid[c->rigid].mobility;
        for (int d = 0; d < 3; ++d) sum += n[d] * dot(mobility + 3 * d, n);
        return sum;
    }
    for (int m = 0; m < FACET_NODES; ++m) {
        const double weight = c->weight[FACET_NODES * (int64_t)k + m];
        const int64_t j = 3 * (int64_t)c->facet[FACET_NODES * (int64_t)k + m];
        for (int d = 0; d < 3 && weight != 0.0; ++d)
            sum += weight * weight * p->inverse[j + d] * n[d] * n[d];
    }
    return sum;
}

/* The gap of a candidate from a sphere, its normal, and both linearised at the predicted place. */
static void aim_at_sphere(const Problem *p, Contact *c) {
    const Rigid *r = &p->rigid[c->rigid];
    for (int32_t k = 0; k < c->count; ++k) {
        double *n = c->normal + 3 * (int64_t)k;
        const double *u = p->u + 3 * (int64_t)c->node[k];
        for (int d = 0; d < 3; ++d) n[d] = c->place[3 * (int64_t)k + d] + u[d] - r->u[d];
        const double distance = sqrt(dot(n, n));
        for (int d = 0; d < 3; ++d) n[d] /= distance;
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

static void ledger(Problem *p, Contact *c) {
    double total = 0.0;
    const double dt = p->dt;
    memset(c->force, 0, sizeof c->force);
    for (int32_t k = 0; k < c->count; ++k) {
        const double lambda = c->lambda[k];
        if (lambda == 0.0) continue;
        const double *n = c->normal + 3 * (int64_t)k;
        total += lambda;
        for (int d = 0; d < 3; ++d) c->force[d] += lambda * n[d];
        if (k > c->outermost) c->outermost = k;
    }
    for (int d = 0; d < 3; ++d) c->impulse[d] += dt * c->force[d];
    c->normal_impulse += dt * total;
    if (total > 0.0) {
        if (c->last < 0 || p->step - c->last > c->split) {
            if (c->intervals < MAX_INTERVALS) c->first_step[c->intervals] = p->step;
            ++c->intervals;
        }
        c->last = p->step;
        const int64_t at = c->intervals < MAX_INTERVALS ? c->intervals : MAX_INTERVALS;
        c->last_step[at - 1] = p->step;
    }
}

/* Contact forces on the surface nodes, into p->force, from p->u, p->predicted and p->before;
 * takes the rigid bodies through the step. */
void contact_step(Problem *p) {
    const double dt = p->dt;
    for (int32_t b = 0; b < p->rigids; ++b) {
        Rigid *r = &p->rigid[b];
        memcpy(r->before, r->v, sizeof r->v);
        for (int d = 0; d < 3; ++d) r->u[d] += dt * r->v[d];
        memset(r->force, 0, sizeof r->force);
    }
    double rigid_u[3 * (p->rigids > 0 ? p->rigids : 1)];
    for (int32_t b = 0; b < p->rigids; ++b) memcpy(rigid_u + 3 * b, p->rigid[b].u, 3 * sizeof(double));
    solve(p);
    /* The forces from the multipliers, so that action and reaction cancel to round-off. */
    memset(p->force, 0, 3 * (size_t)p->nodes * sizeof *p->force);
    for (int32_t a = 0; a < p->contacts; ++a) {
        Contact *c = &p->contact[a];
        ledger(p, c);
        for (int32_t k = 0; k < c->count; ++k) {
            const double lambda = c->lambda[k];
            if (lambda == 0.0) continue;
            const double *n = c->normal + 3 * (int64_t)k;
            for (int d = 0; d < 3; ++d) {
                p->force[3 * (int64_t)c->node[k] + d] += lambda * n[d];
                if (c->kind == AGAINST_SPHERE) p->rigid[c->rigid].force[d] -= lambda * n[d];
            }
            for (int m = 0; m < FACET_NODES && c->kind == AGAINST_SURFACE; ++m) {
                const double share = lambda * c->weight[FACET_NODES * (int64_t)k + m];
                const int64_t j = 3 * (int64_t)c->facet[FACET_NODES * (int64_t)k + m];
                for (int d = 0; d < 3; ++d) p->force[j + d] -= share * n[d];
            }
        }
    }
    for (int32_t b = 0; b < p->rigids; ++b) {
        Rigid *r = &p->rigid[b];
        for (int d = 0; d < 3; ++d) {
            const double change = dt * dot(r->mobility + 3 * d, r->force);
            r->v[d] += change;
            r->u[d] = rigid_u[3 * b + d] + dt * change;
            /* What a guide takes up. */
            p->reaction[d] += r->mass * change - dt * r->force[d];
        }
    }
    for (int64_t i = 0; i < 3 * p->nodes; ++i) {
        p->predicted[i] += dt * p->inverse[i] * p->force[i];
        if (p->inverse[i] == 0.0) p->reaction[i % 3] -= dt * p->force[i];
    }
    /* The discrete energy changes by exactly dt lambda times the mean relative velocity. */
    for (int32_t a = 0; a < p->contacts; ++a) {
        Contact *c = &p->contact[a];
        const Rigid *r = c->kind == AGAINST_SPHERE ? &p->rigid[c->rigid] : 0;
        for (int32_t k = 0; k < c->count; ++k)
            if (c->lambda[k] != 0.0)
                c->work += 0.5 * dt * c->lambda[k]
                           * (relative(c, k, p->predicted, r ? r->v : 0)
                              + relative(c, k, p->before, r ? r->before : 0));
    }
    ++p->step;
}

/* The impulse of one level, and the motion of its nodes over its time step h. */
static void sweep(const State *s, const Level *l, double h, double *reaction) {
    double *restrict u = s->u, *restrict v = s->v, *restrict f = s->f;
    const double *restrict inverse = s->inverse;
    for (int64_t i = 0; i < l->rows; ++i) {
        row_product(l, u, f, i);
        const int64_t n = 3 * (int64_t)l->node[i];
        for (int d = 0; d < 3; ++d) {
            v[n + d] -= h * inverse[n + d] * f[n + d];
            if (inverse[n + d] == 0.0) reaction[d] += h * f[n + d];
            f[n + d] = 0.0;
        }
        if (i < l->shared) continue;
        /* No later row reads u of this node any more. */
        for (int d = 0; d < 3; ++d) u[n + d] += h * v[n + d];
    }
}

/* Step number ``step`` without contact. Slower levels come first: they still need u_n of the faster
 * nodes. */
static void predict(const State *s, int64_t step, double *reaction) {
    for (int64_t k = s->levels - 1; k >= 0; --k) {
        const int64_t every = (int64_t)1 << k;
        if (step % every == 0) sweep(s, &s->level[k], s->problem->dt * (double)every, reaction);
    }
}

/* Advances the elastic bodies alone by a number of steps, from an instant at which all levels meet;
 * neither contact nor ledger. */
void drift(State *s, int64_t steps) {
    double reaction[3] = {0.0, 0.0, 0.0};
    for (int64_t n = 0; n < steps; ++n) predict(s, n, reaction);
}

/* Advances a system that lies in one process by a number of steps. */
void advance(State *s, int64_t steps) {
    Problem *p = s->problem;
    const double dt = p->dt;
    double *u = s->u, *v = s->v;
    for (int64_t n = 0; n < steps; ++n) {
        for (int64_t i = 0; i < p->nodes; ++i)
            memcpy(p->before + 3 * i, v + 3 * (int64_t)p->global[i], 3 * sizeof *v);
        predict(s, p->step, p->reaction);
        for (int64_t i = 0; i < p->nodes; ++i) {
            const int64_t g = 3 * (int64_t)p->global[i];
            memcpy(p->u + 3 * i, u + g, 3 * sizeof *u);
            memcpy(p->predicted + 3 * i, v + g, 3 * sizeof *v);
        }
        contact_step(p);
        for (int64_t i = 0; i < p->nodes; ++i) {
            const int64_t g = 3 * (int64_t)p->global[i];
            for (int d = 0; d < 3; ++d) {
                const double change = dt * s->inverse[g + d] * p->force[3 * i + d];
                v[g + d] += change;
                u[g + d] += dt * change;
            }
        }
    }
}

int64_t layout(int32_t what) {
    const size_t size[] = {sizeof(Rigid), sizeof(Contact), sizeof(Problem), sizeof(Level),
                           sizeof(State)};
    return (int64_t)size[what];
}
