/* Part of kernel.c: Coulomb friction of candidates with surfaces and spheres, once after the multipliers of a step.
 * These are of the state before friction: what friction does to the normal velocities the next step's multipliers
 * mend (a splitting of first order in the step). */
#if COMPONENTS == 3

static inline void cross(const double *a, const double *b, double *c) {
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* What a rigid body's sphere moves at with the velocity v and spin w, where the candidate with the normal n meets it. */
static inline void of_sphere(const Contact *c, const double *n, const double *v, const double *w, double *out) {
    cross(w, n, out);
    for (int d = 0; d < 3; ++d) out[d] = v[d] + c->radius * out[d];
}

/* Velocity of a candidate along what it faces; x per node, v and w of the rigid body, if it is a sphere's. */
static void slip(const Contact *c, int32_t k, const double *x, const double *v, const double *w, double *out) {
    const double *n = c->normal + 3 * (int64_t)k;
    memcpy(out, x + 3 * (int64_t)c->node[k], 3 * sizeof *out);
    if (c->kind == AGAINST_SPHERE) {
        double other[3];
        of_sphere(c, n, v, w, other);
        for (int d = 0; d < 3; ++d) out[d] -= other[d];
    }
    for (int m = 0; m < FACET_NODES && c->kind == AGAINST_SURFACE; ++m) {
        const double weight = c->weight[FACET_NODES * (int64_t)k + m];
        const double *other = x + 3 * (int64_t)c->facet[FACET_NODES * (int64_t)k + m];
        for (int d = 0; d < 3 && weight != 0.0; ++d) out[d] -= weight * other[d];
    }
    const double along = dot(out, n);
    for (int d = 0; d < 3; ++d) out[d] -= along * n[d];
}

/* At least the velocity that a unit impulse along any tangent takes from the slip, 1/kg. */
static double tangential_mobility(const Problem *p, const Contact *c, int32_t k) {
    const double *inverse = p->inverse + 3 * (int64_t)c->node[k];
    double sum = fmax(inverse[0], fmax(inverse[1], inverse[2]));
    if (c->kind == AGAINST_SPHERE) {
        const Rigid *r = &p->rigid[c->rigid];
        double most = 0.0, turning = 0.0;
        for (int d = 0; d < 3; ++d) {
            most = fmax(most, r->mobility[4 * d]);
            turning = fmax(turning, r->turning[4 * d]);
        }
        return sum + most + c->radius * c->radius * turning;
    }
    for (int m = 0; m < FACET_NODES; ++m) {
        const double weight = c->weight[FACET_NODES * (int64_t)k + m];
        const double *other = p->inverse + 3 * (int64_t)c->facet[FACET_NODES * (int64_t)k + m];
        if (weight != 0.0) sum += weight * weight * fmax(other[0], fmax(other[1], other[2]));
    }
    return sum;
}

/* The force f on a node over the step. */
static inline void pull(Problem *p, int32_t node, double share, const double *f) {
    for (int d = 0; d < 3; ++d) {
        const int64_t i = 3 * (int64_t)node + d;
        p->force[i] += share * f[d];
        p->predicted[i] += p->dt * p->inverse[i] * share * f[d];
        if (p->inverse[i] == 0.0) p->reaction[d] -= p->dt * share * f[d];
    }
}

/* The force f on a candidate over the step, and its opposite on what it faces. */
static void drag_along(Problem *p, Contact *c, int32_t k, const double *f) {
    pull(p, c->node[k], 1.0, f);
    for (int m = 0; m < FACET_NODES && c->kind == AGAINST_SURFACE; ++m) {
        const double weight = c->weight[FACET_NODES * (int64_t)k + m];
        if (weight != 0.0) pull(p, c->facet[FACET_NODES * (int64_t)k + m], -weight, f);
    }
    if (c->kind == AGAINST_SURFACE) return;
    Rigid *r = &p->rigid[c->rigid];
    double torque[3];
    cross(c->normal + 3 * (int64_t)k, f, torque);
    for (int d = 0; d < 3; ++d) {
        const double change = -p->dt * dot(r->mobility + 3 * d, f);
        r->v[d] += change;
        r->u[d] += p->dt * change;
        r->force[d] -= f[d];
        p->reaction[d] += r->mass * change + p->dt * f[d];
        r->spin[d] -= p->dt * c->radius * dot(r->turning + 3 * d, torque);
    }
}

/* One sweep of a contact: each force comes nearer to what leaves no slip, as far as Coulomb's law lets it grow.
 * The largest change of a force, N. */
static double rub_once(Problem *p, Contact *c) {
    const Rigid *r = c->kind == AGAINST_SPHERE ? &p->rigid[c->rigid] : 0;
    double largest = 0.0;
    for (int32_t k = 0; k < c->count; ++k) {
        const double bound = c->friction * c->lambda[k];
        if (bound == 0.0) continue;
        const double mobility = tangential_mobility(p, c, k);
        if (mobility == 0.0) continue;
        double *traction = c->traction + 3 * (int64_t)k, wanted[3], change[3];
        slip(c, k, p->predicted, r ? r->v : 0, r ? r->spin : 0, wanted);
        for (int d = 0; d < 3; ++d) wanted[d] = traction[d] - wanted[d] / (p->dt * mobility);
        const double size = sqrt(dot(wanted, wanted));
        const double scale = size > bound ? bound / size : 1.0;
        for (int d = 0; d < 3; ++d) {
            change[d] = scale * wanted[d] - traction[d];
            traction[d] += change[d];
        }
        drag_along(p, c, k, change);
        largest = fmax(largest, sqrt(dot(change, change)));
    }
    return largest;
}

/* Friction of all contacts, from the velocities that the multipliers left; adds to the forces on both sides. */
static void rub_all(Problem *p) {
    double bound = 0.0;
    for (int32_t a = 0; a < p->contacts; ++a) {
        Contact *c = &p->contact[a];
        if (c->friction == 0.0) continue;
        memset(c->traction, 0, 3 * (size_t)c->count * sizeof *c->traction);
        for (int32_t k = 0; k < c->count; ++k) bound = fmax(bound, c->friction * c->lambda[k]);
    }
    if (bound == 0.0) return;
    for (int sweep = 0; sweep < MAX_SWEEPS; ++sweep) {
        double change = 0.0;
        for (int32_t a = 0; a < p->contacts; ++a)
            if (p->contact[a].friction > 0.0) change = fmax(change, rub_once(p, &p->contact[a]));
        if (change <= FRICTION_TOLERANCE * bound) return;
    }
    ++p->unconverged;
}

/* Energy that a contact's friction gave to both sides in the step, once their velocities are known. */
static void book_friction(const Problem *p, Contact *c) {
    const Rigid *r = c->kind == AGAINST_SPHERE ? &p->rigid[c->rigid] : 0;
    for (int32_t k = 0; k < c->count; ++k) {
        if (c->lambda[k] == 0.0) continue;
        const double *f = c->traction + 3 * (int64_t)k;
        double after[3], before[3];
        slip(c, k, p->predicted, r ? r->v : 0, r ? r->spin : 0, after);
        slip(c, k, p->before, r ? r->before : 0, r ? r->spun : 0, before);
        c->rubbed += 0.5 * p->dt * (dot(f, after) + dot(f, before));
        for (int d = 0; d < 3; ++d) {
            c->force[d] += f[d];
            c->impulse[d] += p->dt * f[d];
        }
    }
}
#else /* an axisymmetric system has matching nodes alone */
static void rub_all(Problem *p) { (void)p; }
static void book_friction(const Problem *p, Contact *c) { (void)p, (void)c; }
#endif
