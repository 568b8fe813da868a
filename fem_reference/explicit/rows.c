/* Part of kernel.c for two components: K_l as half of its blocks, product and motion in one sweep of the rows. */

/* Row i of K_l x for node n, complete once the rows before it have been done: the node's own and later
 * neighbours' part, and what earlier rows left in y, which is taken out of it; passes on to later rows
 * what they need (K_l is symmetric, only its upper half is stored and read). */
typedef Lanes pair;
typedef int64_t pair_mask __attribute__((vector_size(16)));

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

static inline pair block_product(const double *block, const double *x) {
    return load(block) * x[0] + load(block + 2) * x[1];
}

static inline pair row_product(const Part *l, const double *x, double *y, int64_t i, int64_t n) {
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

/* x += scale * factor * a, component by component */
static inline void add(double *x, double scale, const double *factor, pair a) {
    store(x, load(x) + scale * load(factor) * a);
}

static inline void shift(double *u, double h, const double *v) { store(u, load(u) + h * load(v)); }

/* What the nodes outside its part add to a row at the border. */
static inline pair outer_product(const Part *l, const double *x, int64_t i) {
    pair sum = {0.0};
    for (int64_t p = l->outer[i]; p < l->outer[i + 1]; ++p)
        sum += block_product(l->outer_block + C * C * p, x + C * (int64_t)l->outer_column[p]);
    return sum;
}

/* f += K_l x of one part */
static void part_product(const Part *l, const double *x, double *f) {
    for (int64_t i = 0; i < l->rows; ++i) {
        const int64_t n = l->node[i];
        pair sum = row_product(l, x, f, i, n);
        if (i < l->border) sum += outer_product(l, x, i);
        store(f + C * n, sum);
    }
}

/* y = (K_first + ... + K_{end-1}) x */
void stiffness_product(const State *s, int64_t first, int64_t end, const double *x, double *y) {
    const pair zero = {0.0};
    double *f = s->f;
#pragma omp parallel num_threads(s->parts) if (s->parts > 1)
    {
        for (int64_t k = first; k < end; ++k)
#pragma omp for schedule(static, 1)
            for (int64_t q = 0; q < s->parts; ++q) part_product(&s->part[k * s->parts + q], x, f);
#pragma omp for
        for (int64_t n = 0; n < s->nodes; ++n) {
            memcpy(y + C * n, f + C * n, C * sizeof *y);
            store(f + C * n, zero);
        }
    }
}

/* Rows of one group: the impulse of their level over its time step h; the motion of those that move;
 * the support's impulse on those that are held. */
static inline __attribute__((always_inline)) void group(const State *s, const Part *l, double h,
                                                        int64_t from, int64_t to, int moves, int held,
                                                        double *reaction) {
    double *u = s->u, *v = s->v, *f = s->f;
    const double *inverse = s->inverse, *effective = s->effective;
    for (int64_t i = from; i < to; ++i) {
        const int64_t n = l->node[i];
        const pair force = row_product(l, effective, f, i, n);
        add(v + C * n, -h, inverse + C * n, force);
        for (int d = 0; held && d < C; ++d)
            if (inverse[C * n + d] == 0.0) reaction[d] += h * force[d];
        /* No later row reads u of this node any more. */
        if (moves) shift(u + C * n, h, v + C * n);
    }
}

/* Rows at the border: the impulse of their level; they move when all parts are done. */
static void border(const State *s, const Part *l, double h, double *reaction) {
    for (int64_t i = 0; i < l->border; ++i) {
        const int64_t n = l->node[i];
        const pair force = row_product(l, s->effective, s->f, i, n) + outer_product(l, s->effective, i);
        add(s->v + C * n, -h, s->inverse + C * n, force);
        for (int d = 0; d < C; ++d)
            if (s->inverse[C * n + d] == 0.0) reaction[d] += h * force[d];
    }
}

static void sweep(const State *s, const Part *l, double h, double *reaction) {
    border(s, l, h, reaction);
    group(s, l, h, l->border, l->shared_free, 0, 0, reaction);
    group(s, l, h, l->shared_free, l->shared, 0, 1, reaction);
    group(s, l, h, l->shared, l->free, 1, 0, reaction);
    group(s, l, h, l->free, l->rows, 1, 1, reaction);
}

/* The elastic bodies' step number ``step``, each thread its parts. Slower levels come first: they still need u_n of the
 * faster nodes, and do not share a node that moves with them with a faster level. */
static void move_elastic(const State *s, int64_t step, double *reaction) {
    const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads();
    for (int64_t k = s->levels - 1; k >= 0; --k) {
        const int64_t every = (int64_t)1 << k;
        if (step % every != 0) continue;
        const Part *part = &s->part[k * s->parts];
        const double h = s->problem->dt * (double)every;
        for (int64_t q = thread; q < s->parts; q += threads)
            sweep(s, &part[q], h, q == 0 ? reaction : s->support + SPACED * q);
        meet(s);
        for (int64_t q = thread; q < s->parts; q += threads)
            for (int64_t i = part[q].border_shared; i < part[q].border; ++i)
                shift(s->u + C * (int64_t)part[q].node[i], h, s->v + C * (int64_t)part[q].node[i]);
    }
    meet(s);
}

