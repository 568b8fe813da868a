/* Part of kernel.c for three components: K_l x element by element, of tetrahedra with straight edges, four at a time.
 *
 * With the gradients G_b of the barycentric coordinates and p_kb = 3 u_k for b = k, else 4 u_kb - u_b (u_kb at the middle of
 * the edge), the gradient of a quadratic displacement is linear, sum_b G_b p_kb at corner k, and so is the stress s_k. The
 * integral of two linear functions over a tetrahedron is V/20 (sum_k a_k b_k + sum_k a_k sum_k b_k). K is never stored: an
 * element takes 11 numbers, its half of K's blocks some 70 (Kronbichler & Kormann 2012, Computers & Fluids 63, 135, of the
 * same for hexahedra). Forces on a node are added in the order of the elements, whatever the threads. */

typedef Lanes four;
typedef int64_t four_mask __attribute__((vector_size(32)));

/* Rows of four nodes (the last number says nothing) as three components of four elements; and back. */
static inline void read_nodes(const double *x, const int32_t *node, four *u) {
    const four_mask even = {0, 4, 2, 6}, odd = {1, 5, 3, 7}, low = {0, 1, 4, 5}, high = {2, 3, 6, 7};
    const four a = load(x + 3 * (int64_t)node[0]), b = load(x + 3 * (int64_t)node[1]);
    const four c = load(x + 3 * (int64_t)node[2]), d = load(x + 3 * (int64_t)node[3]);
    const four ab = __builtin_shuffle(a, b, even), cd = __builtin_shuffle(c, d, even);
    u[0] = __builtin_shuffle(ab, cd, low);
    u[1] = __builtin_shuffle(__builtin_shuffle(a, b, odd), __builtin_shuffle(c, d, odd), low);
    u[2] = __builtin_shuffle(ab, cd, high);
}

static inline void write_nodes(const four *sum, four *force) {
    const four_mask even = {0, 4, 2, 6}, odd = {1, 5, 3, 7}, low = {0, 1, 4, 5}, high = {2, 3, 6, 7};
    const four zero = {0.0, 0.0, 0.0, 0.0};
    const four xy = __builtin_shuffle(sum[0], sum[1], even), z = __builtin_shuffle(sum[2], zero, even);
    const four yx = __builtin_shuffle(sum[0], sum[1], odd), w = __builtin_shuffle(sum[2], zero, odd);
    force[0] = __builtin_shuffle(xy, z, low);
    force[1] = __builtin_shuffle(yx, w, low);
    force[2] = __builtin_shuffle(xy, z, high);
    force[3] = __builtin_shuffle(yx, w, high);
}

/* Gradients of the barycentric coordinates 1, 2, 3 (that of 0 is minus their sum), 1/m; Lame's constants times the
 * volume, of quadratic elements times a twentieth of it, N m. */
typedef struct {
    four gradient[3][3];
    four lame, shear;
} Four;

/* Stress (xx, yy, zz, yz, zx, xy) of the displacement whose derivatives by the barycentric coordinates 1, 2, 3 are
 * ``p``, each less that by coordinate 0; times what ``e`` has of the volume. */
static inline void stress(const Four *e, const four (*p)[3], four *s) {
    four h[3][3]; /* by direction, component */
    for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c)
            h[i][c] = e->gradient[0][i] * p[0][c] + e->gradient[1][i] * p[1][c] + e->gradient[2][i] * p[2][c];
    const four volume = e->lame * (h[0][0] + h[1][1] + h[2][2]);
    for (int i = 0; i < 3; ++i) s[i] = volume + 2.0 * e->shear * h[i][i];
    s[3] = e->shear * (h[1][2] + h[2][1]);
    s[4] = e->shear * (h[2][0] + h[0][2]);
    s[5] = e->shear * (h[0][1] + h[1][0]);
}

/* Component ``c`` of the force per gradient: G_b s of all four coordinates. */
static inline void forces(const Four *e, const four *s, int c, four *z) {
    static const int of[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    for (int b = 1; b < 4; ++b)
        z[b] = e->gradient[b - 1][0] * s[of[c][0]] + e->gradient[b - 1][1] * s[of[c][1]]
               + e->gradient[b - 1][2] * s[of[c][2]];
    z[0] = -(z[1] + z[2] + z[3]);
}

static inline void linear_elements(const Four *e, const four (*u)[3], four (*f)[3]) {
    four p[3][3], s[6], z[4];
    for (int b = 0; b < 3; ++b)
        for (int c = 0; c < 3; ++c) p[b][c] = u[b + 1][c] - u[0][c];
    stress(e, p, s);
    for (int c = 0; c < 3; ++c) {
        forces(e, s, c, z);
        for (int b = 0; b < 4; ++b) f[b][c] = z[b];
    }
}

static inline void quadratic_elements(const Four *e, const four (*u)[3], four (*f)[3]) {
    /* the node between two corners, as VTK numbers them */
    static const int middle[4][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};
    four s[4][6], sum[6];
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) {
        four p[3][3];
        for (int c = 0; c < 3; ++c) {
            four by[4];
            for (int b = 0; b < 4; ++b) by[b] = b == k ? 3.0 * u[k][c] : 4.0 * u[middle[k][b]][c] - u[b][c];
            for (int b = 0; b < 3; ++b) p[b][c] = by[b + 1] - by[0];
        }
        stress(e, p, s[k]);
        for (int j = 0; j < 6; ++j) sum[j] = k == 0 ? s[k][j] : sum[j] + s[k][j];
    }
    memset(f, 0, 10 * sizeof *f);
#pragma GCC unroll 4
    for (int k = 0; k < 4; ++k) {
        for (int j = 0; j < 6; ++j) s[k][j] += sum[j];
        for (int c = 0; c < 3; ++c) {
            four z[4];
            forces(e, s[k], c, z);
            for (int b = 0; b < 4; ++b) {
                f[b][c] += b == k ? 3.0 * z[b] : -z[b];
                if (b != k) f[middle[k][b]][c] += 4.0 * z[b];
            }
        }
    }
}

/* f += scale K_l x at the nodes of one part, of elements with ``size`` nodes; what others get goes to ``nowhere``. */
static inline __attribute__((always_inline)) void add_elements(const Part *l, int size, double scale, const double *x,
                                                               double *f, int64_t nowhere) {
    for (int64_t i = 0; i < l->fours; ++i) {
        const int32_t *node = l->node + 4 * size * i;
        Four e;
        four u[10][3], sum[10][3], force[10][4];
        memcpy(&e, l->element + 44 * i, sizeof e);
        e.lame *= scale;
        e.shear *= scale;
        for (int a = 0; a < size; ++a) read_nodes(x, node + 4 * a, u[a]);
        if (size == 4)
            linear_elements(&e, u, sum);
        else
            quadratic_elements(&e, u, sum);
        for (int a = 0; a < size; ++a) write_nodes(sum[a], force[a]);
        /* element by element: the order must not depend on which of them are in one four */
        for (int k = 0; k < 4; ++k)
            for (int a = 0; a < size; ++a) {
                const int64_t n = node[4 * a + k];
                double *to = f + LANES * (l->part[n] == l->number ? n : nowhere);
                store(to, load(to) + force[a][k]);
            }
    }
}

static void add_product(const Part *l, double scale, const double *x, double *f, int64_t nowhere) {
    if (l->size == 4)
        add_elements(l, 4, scale, x, f, nowhere);
    else
        add_elements(l, 10, scale, x, f, nowhere);
}

/* y = (K_first + ... + K_{end-1}) x; three numbers behind the last of x are read. */
void stiffness_product(const State *s, int64_t first, int64_t end, const double *x, double *y) {
    const four zero = {0.0, 0.0, 0.0, 0.0};
#pragma omp parallel for num_threads(s->parts) if (s->parts > 1) schedule(static, 1)
    for (int64_t q = 0; q < s->parts; ++q)
        for (int64_t k = end - 1; k >= first; --k)
            add_product(&s->part[k * s->parts + q], 1.0, x, s->f, s->nodes + q);
    for (int64_t n = 0; n < s->nodes; ++n) {
        memcpy(y + C * n, s->f + LANES * n, C * sizeof *y);
        store(s->f + LANES * n, zero);
    }
}

/* The impulse of the acting levels on nodes that move with one of them, over its time step h their motion, and the
 * supports' impulse on those that are held. */
static inline void move(const State *s, const Part *l, double h, double *reaction) {
    const four zero = {0.0, 0.0, 0.0, 0.0};
    const double dt = s->problem->dt;
    for (int64_t i = 0; i < l->moving; ++i) {
        const int64_t n = l->moves[i];
        double *force = s->f + LANES * n;
        for (int d = 0; d < C; ++d) {
            double *v = s->v + C * n + d;
            *v -= dt * s->inverse[C * n + d] * force[d];
            s->u[C * n + d] += h * *v;
            if (i >= l->free && s->inverse[C * n + d] == 0.0) reaction[d] += dt * force[d];
        }
        store(force, zero);
    }
}

/* The forces of the levels that act in step number ``step``, each thread its parts. One that acts at every 2^k-th step does
 * so with 2^k times the impulse. */
static void act(const State *s, int64_t step) {
    const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads();
    for (int64_t q = thread; q < s->parts; q += threads)
        for (int64_t k = s->levels - 1; k >= 0; --k)
            if (step % ((int64_t)1 << k) == 0)
                add_product(&s->part[k * s->parts + q], (double)((int64_t)1 << k), s->effective, s->f,
                            s->nodes + q);
    meet(s);
}

/* What they move: a node moves with its fastest level, so all nodes that forces act on. */
static void follow(const State *s, int64_t step, double *reaction) {
    const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads();
    for (int64_t q = thread; q < s->parts; q += threads)
        for (int64_t k = 0; k < s->levels && step % ((int64_t)1 << k) == 0; ++k)
            move(s, &s->part[k * s->parts + q], s->problem->dt * (double)((int64_t)1 << k),
                 q == 0 ? reaction : s->support + SPACED * q);
    meet(s);
}

/* The elastic bodies' step number ``step``. */
static void move_elastic(const State *s, int64_t step, double *reaction) {
    act(s, step);
    follow(s, step, reaction);
}
