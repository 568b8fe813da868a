/* Part of kernel.c: materials that relax.
 *
 * With one Prony series for bulk and shear, E(t) = E_0 (1 - sum g (1 - exp(-t/tau))), a body's internal force is K e with
 * its instantaneous stiffness K and the effective displacement e = u - sum g xi, where xi' = (u - xi) / tau (generalised
 * Maxwell model; Simo & Hughes, Computational Inelasticity, 1998, section 10.2). Kept is the extension d = u - xi of each
 * term's spring: d' = u' - d/tau, exact over a step in which u moves evenly. d is small where tau is, and
 * e = (1 - sum g) u + sum g d. On the unit circle the discrete modulus e/u stays below 1 with a phase between 0 and pi:
 * the instantaneous modulus sets the stable step, and every mode loses energy.
 */

/* Four neighbours among the extensions of a node: those of its terms one after the other, the C components of each. */
typedef double Neighbours __attribute__((vector_size(32), aligned(8), may_alias));

/* Fours after which the components come in the same places again: v0 v1 v0 v1, or v0 v1 v2 v0, v1 v2 v0 v1, v2 v0 v1 v2. */
enum { PATTERNS = C == 2 ? 1 : C };

/* Moves the extensions of a node with the velocity ``v``, and its effective displacement, ``u`` its displacement. */
static inline void relax_node(const Relaxing *r, double *extension, const double *u, const double *v,
                              double *effective) {
    Neighbours speed[PATTERNS], sum[PATTERNS] = {{0.0}};
    double e[C];
    for (int d = 0; d < C; ++d) e[d] = r->lasting * u[d];
#pragma GCC unroll 3
    for (int p = 0; p < PATTERNS; ++p)
        speed[p] = (Neighbours){v[4 * p % C], v[(4 * p + 1) % C], v[(4 * p + 2) % C], v[(4 * p + 3) % C]};
    int64_t at = 0;
    for (; at + 4 * PATTERNS <= r->entries; at += 4 * PATTERNS)
#pragma GCC unroll 3
        for (int p = 0; p < PATTERNS; ++p) {
            const int64_t from = at + 4 * p;
            Neighbours *d = (Neighbours *)(extension + from);
            *d = *(const Neighbours *)(r->decay + from) * *d + *(const Neighbours *)(r->growth + from) * speed[p];
            sum[p] += *(const Neighbours *)(r->ratio + from) * *d;
        }
    for (; at < r->entries; at += C)
        for (int d = 0; d < C; ++d) {
            extension[at + d] = r->decay[at + d] * extension[at + d] + r->growth[at + d] * v[d];
            e[d] += r->ratio[at + d] * extension[at + d];
        }
#pragma GCC unroll 12
    for (int i = 0; i < 4 * PATTERNS; ++i) e[i % C] += sum[i / 4][i % 4];
    memcpy(effective, e, sizeof e);
}

/* Moves the nodes that have moved in step number ``step``; each thread a share of them. */
static void relax(const State *s, int64_t step) {
    if (s->relaxings == 0) return;
    const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads();
    for (const Relaxing *r = s->relaxing; r < s->relaxing + s->relaxings; ++r) {
        if (step % ((int64_t)1 << r->level) != 0) continue;
        for (int64_t i = r->count * thread / threads; i < r->count * (thread + 1) / threads; ++i) {
            const int64_t n = C * (int64_t)r->node[i];
            relax_node(r, s->extension + n * s->springs, s->u + n, s->v + n, s->effective + n);
        }
    }
    meet(s);
}
