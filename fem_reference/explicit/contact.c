/* Part of kernel.c: contact of candidates with surfaces and spheres: multipliers by Gauss-Seidel, ledger. */

enum { MAX_SWEEPS = 1000 };
/* Change of a friction in the last sweep, over the largest there may be. */
#define FRICTION_TOLERANCE 1e-6

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

#include "friction.c"

/* Contact forces on the surface nodes, into p->force, from p->u, p->predicted and p->before;
 * takes the rigid bodies through the step. */
void contact_step(Problem *p) {
    const double dt = p->dt;
    for (int32_t b = 0; b < p->rigids; ++b) {
        Rigid *r = &p->rigid[b];
        memcpy(r->before, r->v, sizeof r->v);
        memcpy(r->spun, r->spin, sizeof r->spin);
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
    rub_all(p);
    /* The discrete energy changes by exactly dt lambda times the mean relative velocity. */
    for (int32_t a = 0; a < p->contacts; ++a) {
        Contact *c = &p->contact[a];
        const Rigid *r = c->kind == AGAINST_SPHERE ? &p->rigid[c->rigid] : 0;
        for (int32_t k = 0; k < c->count; ++k)
            if (c->lambda[k] != 0.0)
                c->record.work += 0.5 * dt * c->lambda[k]
                           * (relative(c, k, p->predicted, r ? r->v : 0)
                              + relative(c, k, p->before, r ? r->before : 0));
        if (c->friction > 0.0) book_friction(p, c);
    }
    ++p->step;
}
