/* Part of kernel.c: contact of a body that is one node, whose tip yields, with the nodes opposite.
 *
 * The tip has no mass; it yields by G lambda. At the end of a step it touches where the gap is
 *   g + G lambda_{n+1} = 0,   lambda_{n+1} = 2 lambda_n - lambda_{n-1} + O(dt^2),
 * which with g = g* + dt^2 M^-1 lambda_n (g* predicted) is the problem of complementarity
 *   lambda_n >= 0,   H lambda_n >= G lambda_{n-1} - g*,   H = 2 G + dt^2 M^-1.
 * Without G this is the kinematic contact of rigid faces. An oscillator that hangs on such a tip is stable
 * at every step (Jury's conditions) and loses a share of the order (omega dt)^3 per radian. */

enum { MOST_EXCHANGES = 100 };
/* How deep in the tip a node may stay, over what it yields at most. */
static const double SLACK = 1e-12;

/* Cholesky's factor of H over the closed nodes, row by row. */
static void factorise(Tip *t, int64_t count) {
    for (int64_t a = 0; a < t->closings; ++a) {
        double *row = t->factor + count * a;
        for (int64_t b = 0; b <= a; ++b) {
            const double *other = t->factor + count * b;
            double rest = t->matrix[count * t->closed[a] + t->closed[b]];
            for (int64_t m = 0; m < b; ++m) rest -= row[m] * other[m];
            row[b] = a == b ? sqrt(rest) : rest / other[b];
        }
    }
    t->factored = 1;
}

/* Multipliers with which the closed nodes reach what is wanted; the others have none. */
static void reach(Tip *t, int64_t count) {
    double x[count];
    if (!t->factored) factorise(t, count);
    for (int64_t a = 0; a < t->closings; ++a) {
        const double *row = t->factor + count * a;
        x[a] = t->wanted[t->closed[a]];
        for (int64_t m = 0; m < a; ++m) x[a] -= row[m] * x[m];
        x[a] /= row[a];
    }
    memset(t->lambda, 0, (size_t)count * sizeof *t->lambda);
    for (int64_t a = t->closings - 1; a >= 0; --a) {
        for (int64_t m = a + 1; m < t->closings; ++m) x[a] -= t->factor[count * m + a] * x[m];
        x[a] /= t->factor[count * a + a];
        t->lambda[t->closed[a]] = x[a];
    }
}

/* Closes and opens nodes until none pulls and none lies inside the tip by more than `slack`: all at a time, after a
 * round per node one at a time, the first, which ends for certain (Murty 1974, Linear Algebra Appl. 9, 65). */
static void exchange(Problem *p, Tip *t, int64_t count, double slack) {
    int32_t next[count];
    for (int64_t round = 0; round < MOST_EXCHANGES * count; ++round) {
        reach(t, count);
        int64_t kept = 0, changes = 0, q = 0;
        for (int32_t k = 0; k < count; ++k) {
            const int was = q < t->closings && t->closed[q] == k;
            int is = was;
            if (changes == 0 || round < count) {
                double missing = t->wanted[k];
                for (int64_t a = 0; a < t->closings && !was; ++a)
                    missing -= t->matrix[count * k + t->closed[a]] * t->lambda[t->closed[a]];
                is = was ? t->lambda[k] > 0.0 : missing > slack;
            }
            if (is) next[kept++] = k;
            changes += is != was;
            q += was;
        }
        if (changes == 0) return;
        memcpy(t->closed, next, (size_t)kept * sizeof *next);
        t->closings = kept;
        t->factored = 0;
    }
    ++p->unconverged;
}

/* Corrects the predicted displacements and velocities. */
static void correct_with_tip(const State *s, Pairs *c) {
    Tip *t = c->tip;
    const int64_t count = c->count, i = C * (int64_t)c->candidate[0] + AXIAL;
    const double dt = s->problem->dt, n = c->normal;
    double largest = 0.0, force = 0.0, work = 0.0, stored = 0.0;
    for (int64_t k = 0; k < count; ++k) {
        double yielded = 0.0;
        for (int64_t a = 0; a < t->closings; ++a)
            yielded += t->flexibility[count * k + t->closed[a]] * t->lambda[t->closed[a]];
        t->wanted[k] = yielded - c->gap[k] - n * (s->u[i] - s->u[C * (int64_t)c->opposite[k] + AXIAL]);
        if (t->wanted[k] > largest) largest = t->wanted[k];
    }
    exchange(s->problem, t, count, SLACK * largest);
    for (int64_t a = 0; a < t->closings; ++a) {
        const double lambda = t->lambda[t->closed[a]];
        const int64_t j = C * (int64_t)c->opposite[t->closed[a]] + AXIAL;
        const double change = -n * dt * lambda * s->inverse[j];
        s->v[j] += change;
        s->u[j] += dt * change;
        force += lambda;
    }
    const double change = n * dt * force * s->inverse[i];
    s->v[i] += change;
    s->u[i] += dt * change;
    for (int64_t a = 0; a < t->closings; ++a) {
        const int64_t k = t->closed[a], j = C * (int64_t)c->opposite[k] + AXIAL;
        /* The discrete energy changes by exactly dt lambda times the mean relative velocity. */
        work += 0.5 * dt * t->lambda[k] * (n * (s->v[i] - s->v[j]) + c->before[k]);
        for (int64_t b = 0; b < t->closings; ++b)
            stored += 0.5 * t->lambda[k] * t->flexibility[count * k + t->closed[b]] * t->lambda[t->closed[b]];
        if (k > c->record.outermost) c->record.outermost = k;
    }
    c->record.impulse += dt * force;
    c->record.work += work;
    c->record.stored = stored;
    record(&c->record, force, s->problem->step);
}
