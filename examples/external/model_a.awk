# Model A of the paper in awk: a clamped plate as its first mode between two spheres, contacts of Hertz. The question is one
# line of JSON with numbers in SI; the answer is a table of curves, from which impactcheck reads the quantities.

function number(part, key,    text) {       # of "part": {... "key": number ...}
    text = substr($0, index($0, "\"" part "\":"))
    text = substr(text, index(text, "\"" key "\":") + length(key) + 3)
    return text + 0
}

function bessel(order, x, sign,    k, term, sum) {  # J (sign -1) or I (sign 1) of order 0 or 1, by its power series
    term = order ? x / 2 : 1
    for (k = 1; k < 40; k++) { sum += term; term *= sign * x * x / (4 * k * (k + order)) }
    return sum
}

function hertz(body,    radius, compliance) {       # stiffness against the plate, N/m^1.5
    radius = number(body, "radius")
    compliance = (1 - number("plate", "poisson_ratio") ^ 2) / number("plate", "youngs_modulus")
    compliance += (1 - number(body, "poisson_ratio") ^ 2) / number(body, "youngs_modulus")
    return 4 / 3 * sqrt(radius) / compliance
}

function mass(body) { return number(body, "density") * 4 / 3 * 3.14159265358979 * number(body, "radius") ^ 3 }

function force(stiffness, depth) { return depth > 0 ? stiffness * depth ^ 1.5 : 0 }

{
    k = 3.19622061658
    nu = number("plate", "poisson_ratio"); h = number("plate", "thickness"); radius = number("plate", "radius")
    density = number("plate", "density") * h
    omega = (k / radius) ^ 2 * sqrt(number("plate", "youngs_modulus") * h ^ 3 / (12 * (1 - nu ^ 2)) / density)
    shape = 1 - bessel(0, k, -1) / bessel(0, k, 1)
    modal = 2 * 3.14159265358979 * radius ^ 2 * density * bessel(0, k, -1) ^ 2 / shape ^ 2
    m1 = mass("outer"); m2 = mass("inner"); k1 = hertz("outer"); k2 = hertz("inner")
    interval = substr($0, index($0, "\"sample_interval\":") + 18) + 0
    v1 = -number("outer", "speed"); z2 = -number("inner", "gap")
    start = z2; dt = interval / 20
    print "time,outer_displacement,outer_velocity,plate_displacement,plate_velocity,inner_displacement,inner_velocity,outer_force,inner_force"
    for (n = 0; n * interval < 200e-6; n++) {       # velocity Verlet
        f1 = force(k1, w - z1); f2 = force(k2, z2 - w)
        printf "%.9e,%.9e,%.9e,%.9e,%.9e,%.9e,%.9e,%.9e,%.9e\n", n * interval, z1, v1, w, v, z2 - start, v2, f1, f2
        for (i = 0; i < 20; i++) {
            v1 += dt / 2 * f1 / m1; v2 -= dt / 2 * f2 / m2; v += dt / 2 * ((f2 - f1) / modal - omega ^ 2 * w)
            z1 += dt * v1; z2 += dt * v2; w += dt * v
            f1 = force(k1, w - z1); f2 = force(k2, z2 - w)
            v1 += dt / 2 * f1 / m1; v2 -= dt / 2 * f2 / m2; v += dt / 2 * ((f2 - f1) / modal - omega ^ 2 * w)
        }
    }
}
