/* Part of kernel.c: materials that relax.
 *
 * With one Prony series for bulk and shear, E(t) = E_0 (1 - sum g (1 - exp(-t/tau))), a body's internal force is K e with
 * its instantaneous stiffness K and the effective displacement e = u - sum g xi, where xi' = (u - xi) / tau (generalised
 * Maxwell model; Simo & Hughes, Computational Inelasticity, 1998, section 10.2). Kept is the extension d = u - xi of each
 * term's spring: d' = u' - d/tau, exact over a step in which u moves evenly. d is small where tau is, and
 * e = (1 - sum g) u + sum g d. On the unit circle the discrete modulus e/u stays below 1 with a phase between 0 and pi:
 * the instantaneous modulus sets the stable step, and every mode loses energy.
 */

/* Moves the extensions of the nodes that have moved in step number ``step``, and their effective displacement; each
 * thread a share of them. */
static void relax(const State *s, int64_t step) {
    if (s->relaxings == 0) return;
    const int64_t thread = omp_get_thread_num(), threads = omp_get_num_threads();
    for (const Relaxing *r = s->relaxing; r < s->relaxing + s->relaxings; ++r) {
        if (step % ((int64_t)1 << r->level) != 0) continue;
        for (int64_t i = r->count * thread / threads; i < r->count * (thread + 1) / threads; ++i) {
            const int64_t n = C * (int64_t)r->node[i];
            const double *u = s->u + n, *v = s->v + n;
            double *extension = s->extension + n * s->springs, e[C];
            for (int d = 0; d < C; ++d) e[d] = r->lasting * u[d];
            for (int64_t k = 0; k < r->terms; ++k, extension += C)
                for (int d = 0; d < C; ++d) {
                    extension[d] = r->decay[k] * extension[d] + r->growth[k] * v[d];
                    e[d] += r->ratio[k] * extension[d];
                }
            memcpy(s->effective + n, e, sizeof e);
        }
    }
    meet(s);
}
