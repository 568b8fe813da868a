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
 * their own. Of several processes the first one has them all, and alone solves it.
 *
 * Sub-cycling: every element has a level l, K = sum K_l, and K_l acts at every 2^l-th step only,
 * with 2^l times the impulse (impulse form of the Verlet splitting: Tuckerman, Berne & Martyna
 * 1992, J. Chem. Phys. 97, 1990; per element: Lew, Marsden, Ortiz & West 2003, Arch. Rational
 * Mech. Anal. 167, 85). A node moves with the time step of its fastest element. Each K_l leaves a
 * rigid motion alone, so momentum is kept to round-off whatever the levels. Nodes that can touch have
 * elements of level 0 only.
 */
#ifdef _OPENMP
#include <omp.h>
#else
#define omp_get_thread_num() 0
#define omp_get_num_threads() 1
#endif

#include "structures.c"

#include "contact.c"

#include "tip.c"

#include "film.c"

#include "plastic.c"

#include "voltage.c"

/* Friction on a closed pair of matching nodes, along the radius: the multiplier that leaves the two no relative
 * velocity at the step's end, as far as Coulomb's law lets it grow. */
static void rub(const State *s, Pairs *c, int64_t k, double lambda) {
    const int64_t i = C * (int64_t)c->candidate[k] + RADIAL, j = C * (int64_t)c->opposite[k] + RADIAL;
    const double dt = s->problem->dt, bound = c->friction * lambda, mobility = s->inverse[i] + s->inverse[j];
    if (mobility == 0.0) return; /* on the axis */
    const double stick = -(s->v[i] - s->v[j]) / (dt * mobility);
    const double force = fmax(-bound, fmin(bound, stick));
    const double candidate = dt * force * s->inverse[i], opposite = -dt * force * s->inverse[j];
    s->v[i] += candidate;
    s->v[j] += opposite;
    s->u[i] += dt * candidate;
    s->u[j] += dt * opposite;
    c->rubbed += 0.5 * dt * force * (s->v[i] - s->v[j] + c->sliding[k]);
}

/* Corrects the predicted displacements and velocities of matching nodes. */
static void correct(const State *s, Pairs *c) {
    if (c->tip) return correct_with_tip(s, c);
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
        if (c->friction > 0.0) rub(s, c, k, lambda);
    }
    c->record.impulse += dt * force;
    c->record.work += work;
    record(&c->record, force, s->problem->step);
}

static inline int leads(void) { return omp_get_thread_num() == 0; }

/* Waits for the other threads. */
static inline void meet(const State *s) {
    if (s->parts > 1) {
#pragma omp barrier
    }
}

#include "relaxation.c"

/* What the processor handles at once; of three components the last number of a node's in work space says nothing. */
typedef double Lanes __attribute__((vector_size(8 * LANES)));

static inline Lanes load(const double *x) {
    Lanes value;
    memcpy(&value, x, sizeof value);
    return value;
}

static inline void store(double *x, Lanes value) { memcpy(x, &value, sizeof value); }

#if COMPONENTS == 2
#include "rows.c"
#else
#include "elements.c"
#endif

/* Step number ``step`` without contact. */
static void predict(const State *s, int64_t step, double *reaction) {
    if (s->problem->plastic) {
        if (leads()) strain_impulse(s, s->problem->plastic);
        meet(s);
    }
    move_elastic(s, step, reaction);
}

/* Takes what the supports gave to the parts but the first. */
static void book_supports(const State *s, double *reaction) {
    for (int64_t q = 1; q < s->parts; ++q)
        for (int d = 0; d < C; ++d) {
            reaction[d] += s->support[SPACED * q + d];
            s->support[SPACED * q + d] = 0.0;
        }
}

/* Advances the elastic bodies alone by a number of steps, the ``first`` one counted from an instant at which all
 * levels meet; neither contact nor ledger. */
void drift(State *s, int64_t first, int64_t steps) {
    double reaction[3] = {0.0, 0.0, 0.0};
#pragma omp parallel num_threads(s->parts) if (s->parts > 1)
    for (int64_t n = first; n < first + steps; ++n) {
        predict(s, n, reaction);
        relax(s, n);
    }
    book_supports(s, reaction);
}

/* What contact needs of the velocities before a step. */
static void remember(const State *s) {
    const Problem *p = s->problem;
    const double *v = s->v;
    for (int64_t c = 0; c < p->matched; ++c) {
        const Pairs *q = &p->pairs[c];
        for (int64_t k = 0; k < q->count; ++k)
            q->before[k] = q->normal * (v[C * (int64_t)q->candidate[k] + AXIAL]
                                        - v[C * (int64_t)q->opposite[k] + AXIAL]);
        for (int64_t k = 0; q->friction > 0.0 && k < q->count; ++k)
            q->sliding[k] =
                v[C * (int64_t)q->candidate[k] + RADIAL] - v[C * (int64_t)q->opposite[k] + RADIAL];
    }
    for (int64_t i = 0; i < p->nodes; ++i)
        memcpy(p->before + C * i, v + C * (int64_t)p->global[i], C * sizeof *v);
    if (p->film) openings(p->film, v, p->film->before);
    if (p->plastic) flow(p->plastic, s->u, p->dt);
    if (p->voltage) p->voltage->before = v[C * p->voltage->node + AXIAL];
}

/* Contact and film correct what was predicted. */
static void close_step(const State *s) {
    Problem *p = s->problem;
    const double dt = p->dt;
    double *u = s->u, *v = s->v;
    book_supports(s, p->reaction);
    if (p->voltage) push_tip(s, p->voltage);
    if (p->film) correct_with_film(s, p->film);
    for (int64_t c = 0; c < p->matched; ++c) correct(s, &p->pairs[c]);
    if (p->film) book_film(s, p->film);
    if (p->voltage) book_voltage(s, p->voltage);
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

/* All threads take part; contact is the first one's. */
static void one_step(const State *s) {
    const int64_t step = s->problem->step;
    if (leads()) remember(s);
    meet(s);
    predict(s, step, s->problem->reaction);
    if (leads()) close_step(s);
    meet(s);
    relax(s, step);
}

/* Advances a system that lies in one process by a number of steps. */
void advance(State *s, int64_t steps) {
#pragma omp parallel num_threads(s->parts) if (s->parts > 1)
    for (int64_t n = 0; n < steps; ++n) one_step(s);
}

/* A body that nothing acts on but one contact of matching nodes and, the last one, the film: its mean motion along
 * the last axis follows from the impulses alone, which the ledger checks. */
typedef struct {
    double mass;         /* kg */
    double start;        /* velocity without these, m/s */
    double displacement; /* m */
    int64_t node;        /* of a body that something else acts on: node whose motion is told; -1: none */
} Carried;

/* Nodes of which a weighted mean along the last axis is watched. */
typedef struct {
    int64_t count;
    const int32_t *node;
    const double *share; /* their sum is 1 */
} Watched;

static double mean(const double *x, const Watched *watched) {
    double sum = 0.0;
    for (int64_t i = 0; i < watched->count; ++i)
        sum += watched->share[i] * x[C * (int64_t)watched->node[i] + AXIAL];
    return sum;
}

static double place(const State *s, const Carried *body) {
    return body->node < 0 ? body->displacement : s->u[C * body->node + AXIAL];
}

/* Half a step late. */
static double speed(const State *s, const Carried *body) {
    return body->node < 0 ? 0.0 : s->v[C * body->node + AXIAL];
}

/* Impulse so far that drives a carried body off. */
static double driven(const Problem *p, int c) {
    const double contact = p->pairs[c].record.impulse;
    return c == 1 && p->film ? contact + p->film->impulse : contact;
}

/* What a row of samples has from before its first step, of both contacts and bodies. */
typedef struct {
    double contact[2]; /* impulse so far, N s */
    double driven[2];
    double speed[2];
} Before;

static Before begin_row(const State *s, const Carried *body, const Watched *watched, double *row) {
    const Pairs *pairs = s->problem->pairs;
    row[0] = place(s, &body[0]);
    row[3] = mean(s->u, watched);
    row[5] = place(s, &body[1]);
    row[4] = mean(s->v, watched);
    return (Before){{pairs[0].record.impulse, pairs[1].record.impulse},
                    {driven(s->problem, 0), driven(s->problem, 1)},
                    {speed(s, &body[0]), speed(s, &body[1])}};
}

static void complete_row(const State *s, const Carried *body, const Watched *watched, Before before,
                         double *row) {
    const Pairs *pairs = s->problem->pairs;
    row[4] = 0.5 * (row[4] + mean(s->v, watched));
    for (int c = 0; c < 2; ++c) {
        const double impulse = 0.5 * (before.driven[c] + driven(s->problem, c));
        row[c == 0 ? 2 : 7] = 0.5 * (before.contact[c] + pairs[c].record.impulse);
        row[c == 0 ? 1 : 6] = body[c].node < 0
                                  ? body[c].start + pairs[c].normal * impulse / body[c].mass
                                  : 0.5 * (before.speed[c] + speed(s, &body[c]));
    }
}

static void carry(const State *s, Carried *body) {
    for (int c = 0; c < 2; ++c)
        body[c].displacement += s->problem->dt * (body[c].start + s->problem->pairs[c].normal
                                                  * driven(s->problem, c) / body[c].mass);
}

/* Advances by samples * stride steps with two contacts of matching nodes and writes a row of SAMPLED
 * numbers at the first step of each stride, all at t_n: displacement, velocity and impulse so far of
 * the first carried body, mean displacement and velocity of the watched nodes, and the second body's
 * three. Velocities are the mean of both half steps. */
void run(State *s, Carried *body, const Watched *watched, int64_t samples, int64_t stride, double *rows) {
#pragma omp parallel num_threads(s->parts) if (s->parts > 1)
    for (int64_t j = 0; j < samples; ++j) {
        double *row = rows + SAMPLED * j;
        Before before = {{0.0}};
        if (leads()) before = begin_row(s, body, watched, row);
        for (int64_t n = 0; n < stride; ++n) {
            one_step(s);
            if (leads()) carry(s, body);
            if (leads() && n == 0) complete_row(s, body, watched, before, row);
        }
    }
}

#if COMPONENTS == 3
#include "exchange.c"
#endif

#include "bandwidth.c"

int64_t layout(int32_t what) {
    const size_t size[] = {sizeof(Record), sizeof(Pairs), sizeof(Rigid), sizeof(Contact), sizeof(Problem),
                           sizeof(Part),  sizeof(State), sizeof(Carried), sizeof(Tip),
                           sizeof(Watched), sizeof(Film), sizeof(Plastic), sizeof(Relaxing),
                           sizeof(Voltage)};
    return (int64_t)size[what];
}
