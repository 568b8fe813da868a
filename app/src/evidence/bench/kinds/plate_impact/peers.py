"""The reduced model's equations by SciPy's integrators: one JSON document in, one JSON line per run out.

q'' + 2 alpha q' + omega^2 q = -B^T F,  F = k max(B q - gap, 0)^(3/2), state y = [q, q'].
"""

import json
import sys
import time

import numpy as np
from scipy.integrate import solve_ivp


class OverBudget(Exception):
    pass


def main():
    problem = json.load(sys.stdin)
    damping = 2 * np.array(problem["alpha"])
    stiffness = np.array(problem["omega"]) ** 2
    B = np.array(problem["approach"])
    Bt = np.ascontiguousarray(B.T)
    gap, k = np.array(problem["gap"]), np.array(problem["contact_stiffness"])
    start, scale = np.array(problem["start"]), np.array(problem["scale"])
    n = len(stiffness)
    deadline = [np.inf]
    out = np.empty(2 * n)

    def rate(t, y):
        if time.perf_counter() > deadline[0]:
            raise OverBudget
        d = np.maximum(B @ y[:n] - gap, 0)
        dy = out.copy()
        dy[:n] = y[n:]
        dy[n:] = -damping * y[n:] - stiffness * y[:n] - Bt @ (k * d * np.sqrt(d))
        return dy

    def jacobian(t, y):
        d = np.maximum(B @ y[:n] - gap, 0)
        J = np.zeros((2 * n, 2 * n))
        J[:n, n:] = np.eye(n)
        J[n:, :n] = -np.diag(stiffness) - (Bt * (1.5 * k * np.sqrt(d))) @ B
        J[n:, n:] = -np.diag(damping)
        return J

    for method in problem["methods"]:
        options = {"jac": jacobian} if method in ("Radau", "LSODA") else {}
        for rtol in problem["tolerances"]:
            seconds = np.inf
            try:
                for _ in range(problem["repeats"]):
                    begin = time.perf_counter()
                    deadline[0] = begin + problem["budget"]
                    end = problem["end_time"]
                    run = solve_ivp(rate, (0, end), start, method=method, rtol=rtol, atol=rtol * scale, t_eval=[end], **options)
                    seconds = min(seconds, time.perf_counter() - begin)
                    if seconds > 1:
                        break
            except OverBudget:
                break
            if not run.success:
                break
            inner = float(run.y[n + 1, -1])
            print(json.dumps({"solver": method, "tolerance": rtol, "inner_rate": inner, "seconds": seconds}), flush=True)
            if seconds > problem["budget"] / 3:
                break


main()
