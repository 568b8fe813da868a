/* Part of kernel.c: squeeze film between the plate and the body behind it, Reynolds' equation
 *   d/dr (r h^3/(12 mu) dp/dr) = r dh/dt,   p = 0 at the edge,
 * by linear finite elements for p over nodes of the film, each of which moves with nodes of the bodies: the opening
 * of the film is B u, its load B^T A p with A the areas of the nodes' rings. With the rates w of the bodies without
 * the film and the pressure at the end of the step,
 *   (K + dt A B M^-1 B^T A) p = -A w,
 * symmetric and positive definite: however narrow the gap, the film only takes energy, K's part at once and no step is
 * too long for it. Conjugate gradients; what acts is B^T A p whatever they leave, the same on both bodies. K is the one
 * of the gap at t_n, where the force acts. Where the bodies touch there is no film: A = 0. */

enum { MOST_ITERATIONS = 200 };
/* Square of the residual, over that of p = 0, in the norm of the preconditioner. */
static const double SETTLED = 1e-20;

/* What the motion x of all nodes opens the film by, per node of it. */
static void openings(const Film *f, const double *x, double *opening) {
    for (int64_t i = 0; i < f->count; ++i) {
        opening[i] = 0.0;
        for (int64_t k = CORNERS * i; k < CORNERS * (i + 1); ++k)
            opening[i] += f->weight[k] * x[C * (int64_t)f->node[f->corner[k]] + AXIAL];
    }
}

/* Forces of loads on the film's nodes, per node of the bodies. */
static void spread(const Film *f, const double *load, double *force) {
    memset(force, 0, (size_t)f->places * sizeof *force);
    for (int64_t k = 0; k < CORNERS * f->count; ++k) force[f->corner[k]] += f->weight[k] * load[k / CORNERS];
}

/* Effective viscosity at an apparent rate of shear, 6 flow/h^2. */
static double viscosity(const Film *f, double rate) {
    if (f->rates == 1) return f->viscosity[0];
    const double place = log(fmax(rate / f->first_rate, 1.0)) / f->log_ratio;
    const int64_t k = place < (double)(f->rates - 2) ? (int64_t)place : f->rates - 2;
    const double t = fmin(place - (double)k, 1.0);
    return (1.0 - t) * f->viscosity[k] + t * f->viscosity[k + 1];
}

/* Conductances of the elements, m^3/(Pa s), for the film opened by ``opening`` since the start: two Gauss points. The
 * viscosity is that of the last step's flow: that of its pressure would not settle where the film drives itself. */
static void conduct(const Film *f, const double *opening, double *conductance) {
    for (int64_t e = 0; e < f->count; ++e) {
        const double r[2] = {f->radius[e], f->radius[e + 1]}, length = r[1] - r[0];
        /* At the edge the bodies move as at the last node. */
        const double moved[2] = {opening[e], opening[e + 1 < f->count ? e + 1 : e]};
        double sum = 0.0, rate = 0.0;
        for (int g = -1; g <= 1; g += 2) {
            const double t = 0.5 + g * 0.28867513459481287, at = r[0] + t * length;
            const double gap = f->gap + f->curvature * at * at + (1.0 - t) * moved[0] + t * moved[1];
            const double h = fmax(gap, f->minimum_gap);
            sum += 0.5 * at * h * h * h;
            rate += 3.0 * f->flow[e] / (h * h);
        }
        conductance[e] = 2.0 * M_PI * sum / (12.0 * viscosity(f, rate) * length);
    }
}

/* z = (tridiagonal part)^-1 r, factored. */
static void precondition(const Film *f, const double *pivot, const double *c, const double *r, double *z) {
    z[0] = r[0];
    for (int64_t i = 1; i < f->count; ++i) z[i] = r[i] + c[i - 1] / pivot[i - 1] * z[i - 1];
    z[f->count - 1] /= pivot[f->count - 1];
    for (int64_t i = f->count - 2; i >= 0; --i) z[i] = (z[i] + c[i] * z[i + 1]) / pivot[i];
}

/* y = (K + dt A B M^-1 B^T A) x. */
static void film_product(const State *s, const Film *f, const double *area, const double *c, const double *x,
                         double *y) {
    double force[f->places], load[f->count];
    for (int64_t i = 0; i < f->count; ++i) load[i] = area[i] * x[i];
    spread(f, load, force);
    for (int64_t k = 0; k < f->places; ++k)
        force[k] *= s->problem->dt * s->inverse[C * (int64_t)f->node[k] + AXIAL];
    for (int64_t i = 0; i < f->count; ++i) {
        double moved = 0.0;
        for (int64_t k = CORNERS * i; k < CORNERS * (i + 1); ++k) moved += f->weight[k] * force[f->corner[k]];
        y[i] = c[i] * (x[i] - (i + 1 < f->count ? x[i + 1] : 0.0)) + area[i] * moved;
        if (i > 0) y[i] += c[i - 1] * (x[i] - x[i - 1]);
    }
}

static double inner(const double *a, const double *b, int64_t count) {
    double sum = 0.0;
    for (int64_t i = 0; i < count; ++i) sum += a[i] * b[i];
    return sum;
}

/* Pressures from the rates w of the opening; from those of the last step on. */
static void press(const State *s, Film *f, const double *area, const double *c, const double *w) {
    const int64_t n = f->count;
    double *p = f->pressure, right[n], pivot[n], r[n], z[n], d[n], q[n];
    for (int64_t i = 0; i < n; ++i) {
        double mobility = 0.0;
        for (int64_t k = CORNERS * i; k < CORNERS * (i + 1); ++k)
            mobility += f->weight[k] * f->weight[k] * s->inverse[C * (int64_t)f->node[f->corner[k]] + AXIAL];
        pivot[i] = c[i] + s->problem->dt * area[i] * area[i] * mobility;
        if (i > 0) pivot[i] += c[i - 1] - c[i - 1] * c[i - 1] / pivot[i - 1];
        right[i] = -area[i] * w[i];
    }
    precondition(f, pivot, c, right, z);
    const double enough = SETTLED * inner(right, z, n);
    film_product(s, f, area, c, p, q);
    for (int64_t i = 0; i < n; ++i) r[i] = right[i] - q[i];
    precondition(f, pivot, c, r, z);
    memcpy(d, z, sizeof d);
    double now = inner(r, z, n);
    for (int iteration = 0; now > enough; ++iteration) {
        if (iteration == MOST_ITERATIONS) {
            ++s->problem->unconverged;
            return;
        }
        film_product(s, f, area, c, d, q);
        const double step = now / inner(d, q, n);
        for (int64_t i = 0; i < n; ++i) {
            p[i] += step * d[i];
            r[i] -= step * q[i];
        }
        precondition(f, pivot, c, r, z);
        const double next = inner(r, z, n);
        for (int64_t i = 0; i < n; ++i) d[i] = z[i] + next / now * d[i];
        now = next;
    }
}

/* Corrects the predicted displacements and velocities. */
static void correct_with_film(const State *s, Film *f) {
    Problem *p = s->problem;
    const int64_t n = f->count;
    double opening[n], w[n], area[n], c[n], force[f->places];
    openings(f, s->u, opening);
    openings(f, s->v, w);
    for (int64_t i = 0; i < n; ++i) {
        const double gap = f->gap + f->curvature * f->radius[i] * f->radius[i] + opening[i];
        area[i] = gap > 0.0 ? f->area[i] : 0.0;
        opening[i] -= p->dt * w[i];
    }
    conduct(f, opening, c);
    press(s, f, area, c, w);
    f->force = 0.0;
    for (int64_t i = 0; i < n; ++i) {
        const double fall = f->pressure[i] - (i + 1 < n ? f->pressure[i + 1] : 0.0);
        f->flow[i] = c[i] * fabs(fall) / (M_PI * (f->radius[i] + f->radius[i + 1]));
        f->load[i] = area[i] * f->pressure[i];
        f->force += f->load[i];
    }
    f->impulse += p->dt * f->force;
    spread(f, f->load, force);
    for (int64_t k = 0; k < f->places; ++k) {
        const int64_t i = C * (int64_t)f->node[k] + AXIAL;
        const double change = p->dt * s->inverse[i] * force[k];
        s->v[i] += change;
        s->u[i] += p->dt * change;
        if (s->inverse[i] == 0.0) p->reaction[AXIAL] -= p->dt * force[k];
    }
}

/* Work of the loads of the step, exactly what they change the discrete energy by, once contact has acted too. */
static void book_film(const State *s, Film *f) {
    double after[f->count];
    openings(f, s->v, after);
    for (int64_t i = 0; i < f->count; ++i)
        f->work += 0.5 * s->problem->dt * f->load[i] * (f->before[i] + after[i]);
}
