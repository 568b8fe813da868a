/* Part of kernel.c: the product with the stiffness of a level, row by row. */

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
