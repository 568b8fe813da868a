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

typedef pair Vector;

static inline double component(Vector a, int d) { return a[d]; }

/* x += scale * factor * a, component by component */
static inline void add(double *x, double scale, const double *factor, Vector a) {
    store(x, load(x) + scale * load(factor) * a);
}

static inline void shift(double *u, double h, const double *v) { store(u, load(u) + h * load(v)); }
#else
typedef double four __attribute__((vector_size(32)));
typedef int64_t four_mask __attribute__((vector_size(32)));
enum { AHEAD = 64 }; /* blocks: how far ahead of its use K is asked for from memory */
typedef four Vector; /* three components, the last lane says nothing */

static inline four load(const double *x) {
    four value;
    memcpy(&value, x, sizeof value);
    return value;
}

static inline void store(double *x, four value) { memcpy(x, &value, sizeof value); }

static inline four times(four a, four b, four c, const double *x) { return a * x[0] + b * x[1] + c * x[2]; }

/* Three rows of a block; the processor reads each from memory once. */
typedef struct {
    four first, second, third;
} Rows;

static inline Rows rows_of(const double *block) {
    Rows r = {load(block), load(block + 3), load(block + 6)};
#ifdef __AVX__
    __asm__("" : "+x"(r.first), "+x"(r.second), "+x"(r.third));
#endif
    return r;
}

/* The block times x, by its columns. */
static inline four forward(Rows r, const double *x) {
    const four_mask even = {0, 4, 2, 6}, odd = {1, 5, 3, 7}, low = {0, 1, 4, 5}, high = {2, 3, 6, 7};
    const four_mask next = {1, 1, 3, 3};
    const four outer = __builtin_shuffle(r.first, r.second, even);
    const four middle = __builtin_shuffle(r.first, r.second, odd);
    return times(__builtin_shuffle(outer, r.third, low),
                 __builtin_shuffle(middle, __builtin_shuffle(r.third, next), low),
                 __builtin_shuffle(outer, r.third, high), x);
}

static inline four block_product(const double *block, const double *x) { return forward(rows_of(block), x); }

static inline double component(Vector a, int d) { return a[d]; }

static inline void add(double *x, double scale, const double *factor, Vector a) {
    for (int d = 0; d < C; ++d) x[d] += scale * factor[d] * a[d];
}

static inline void shift(double *u, double h, const double *v) {
    for (int d = 0; d < C; ++d) u[d] += h * v[d];
}

static inline Vector row_product(const Part *l, const double *restrict x, double *restrict y,
                                 int64_t row, int64_t i) {
    const double *restrict b = l->block + 9 * l->row[row];
    const int32_t *restrict column = l->column + l->row[row];
    const int64_t count = l->row[row + 1] - l->row[row];
    const four zero = {0.0, 0.0, 0.0, 0.0};
    const double own[3] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
    const double *mine = y + 4 * i;
    four sum = {mine[0] + b[0] * own[0] + b[1] * own[1] + b[2] * own[2],
                mine[1] + b[3] * own[0] + b[4] * own[1] + b[5] * own[2],
                mine[2] + b[6] * own[0] + b[7] * own[1] + b[8] * own[2], 0.0};
    for (int64_t p = 1; p < count; ++p) {
        b += 9;
        __builtin_prefetch(b + 9 * AHEAD);
        const int64_t j = column[p];
        const Rows r = rows_of(b);
        sum += forward(r, x + 3 * j);
        store(y + 4 * j, load(y + 4 * j) + times(r.first, r.second, r.third, own));
    }
    store(y + 4 * i, zero);
    return sum;
}
#endif

/* What the nodes outside its part add to a row at the border. */
static inline Vector outer_product(const Part *l, const double *x, int64_t i) {
    Vector sum = {0.0};
    for (int64_t p = l->outer[i]; p < l->outer[i + 1]; ++p)
        sum += block_product(l->outer_block + C * C * p, x + C * (int64_t)l->outer_column[p]);
    return sum;
}

/* f += K_l x of one part */
static void part_product(const Part *l, const double *x, double *f) {
    for (int64_t i = 0; i < l->rows; ++i) {
        const int64_t n = l->node[i];
        Vector sum = row_product(l, x, f, i, n);
        if (i < l->border) sum += outer_product(l, x, i);
        store(f + LANES * n, sum);
    }
}

/* y = (K_first + ... + K_{end-1}) x */
void stiffness_product(const State *s, int64_t first, int64_t end, const double *x, double *y) {
    const Vector zero = {0.0};
    double *f = s->f;
#pragma omp parallel num_threads(s->parts) if (s->parts > 1)
    {
        for (int64_t k = first; k < end; ++k)
#pragma omp for schedule(static, 1)
            for (int64_t q = 0; q < s->parts; ++q) part_product(&s->part[k * s->parts + q], x, f);
#pragma omp for
        for (int64_t n = 0; n < s->nodes; ++n) {
            memcpy(y + C * n, f + LANES * n, C * sizeof *y);
            store(f + LANES * n, zero);
        }
    }
}
