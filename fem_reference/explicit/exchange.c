/* Part of kernel.c for three components: a step of one process among several, in two halves between which they add up the
 * forces on the nodes they share. */

/* The forces of this process' elements in step number ``step``. */
void process_acts(const State *s, int64_t step) {
#pragma omp parallel num_threads(s->parts) if (s->parts > 1)
    act(s, step);
}

/* What the forces of all processes move, and contact, which the first one has. */
void process_follows(const State *s) {
#pragma omp parallel num_threads(s->parts) if (s->parts > 1)
    {
        if (leads()) remember(s);
        meet(s);
        follow(s, s->problem->step, s->problem->reaction);
        if (leads()) close_step(s);
    }
}

/* The same of a step that has neither contact nor ledger. */
void process_drifts(const State *s, int64_t step) {
    double reaction[3] = {0.0, 0.0, 0.0};
#pragma omp parallel num_threads(s->parts) if (s->parts > 1)
    follow(s, step, reaction);
    book_supports(s, reaction);
}

/* Vectors of some nodes, one every ``stride`` numbers of x. */
void pack(const double *restrict x, int64_t stride, const int64_t *restrict node, int64_t count, double *restrict packed) {
    for (int64_t i = 0; i < count; ++i) memcpy(packed + C * i, x + stride * node[i], C * sizeof *x);
}

/* Into the place of those that were there. */
void unpack(double *restrict x, int64_t stride, const int64_t *restrict node, int64_t count, const double *restrict packed) {
    for (int64_t i = 0; i < count; ++i) memcpy(x + stride * node[i], packed + C * i, C * sizeof *x);
}

/* Takes them out and leaves zeros. */
void take(double *restrict x, int64_t stride, const int64_t *restrict node, int64_t count, double *restrict packed) {
    pack(x, stride, node, count, packed);
    for (int64_t i = 0; i < count; ++i) memset(x + stride * node[i], 0, C * sizeof *x);
}

/* Adds them to those that are there. */
void put(double *restrict x, int64_t stride, const int64_t *restrict node, int64_t count, const double *restrict packed) {
    for (int64_t i = 0; i < count; ++i)
        for (int d = 0; d < C; ++d) x[stride * node[i] + d] += packed[C * i + d];
}
