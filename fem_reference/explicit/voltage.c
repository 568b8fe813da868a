/* Part of kernel.c: a stack's voltage, which pulls tip and base apart in proportion to it.
 *
 * The uniform stress of a uniform field is in balance inside the body: what is left of it is a force on the tip, and its opposite
 * on the base. Charge Q = C_S V + alpha x; R dQ/dt = V_0 - Q/C_B - V, by the trapezoidal rule. */

/* Pushes the tip by the voltage at the start of the step, after the predictor. */
static void push_tip(const State *s, Voltage *d) {
    const double dt = s->problem->dt;
    const int64_t i = C * d->node + AXIAL;
    d->extension = dt * s->v[i] - s->u[i];
    const double voltage =
        d->resistance > 0.0 ? (d->charge - d->force_per_voltage * d->extension) / d->capacitance : d->source;
    d->force = d->force_per_voltage * voltage;
    const double change = -dt * s->inverse[i] * d->force;
    s->v[i] += change;
    s->u[i] += dt * change;
}

/* Books what the step has come to, and moves the charge on. */
static void book_voltage(const State *s, Voltage *d) {
    const double dt = s->problem->dt;
    const int64_t i = C * d->node + AXIAL;
    d->impulse -= dt * d->force;
    d->work -= 0.5 * dt * d->force * (d->before + s->v[i]);
    if (d->resistance <= 0.0) return;
    const double mean = 0.5 * (d->extension - s->u[i]);
    const double rate = 0.5 * dt * (d->elastance + 1.0 / d->capacitance) / d->resistance;
    const double fed = (d->source + d->force_per_voltage * mean / d->capacitance) / d->resistance;
    const double charge = ((1.0 - rate) * d->charge + dt * fed) / (1.0 + rate);
    d->heat += d->resistance * (charge - d->charge) * (charge - d->charge) / dt;
    d->charge = charge;
}
