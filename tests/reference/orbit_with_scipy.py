"""scipy's DOP853 and least_squares judge propagation, least squares and filter of core/tracking on the same observations.

    orbit_with_scipy.py TRACKING_CASE
"""
import json
import subprocess
import sys

try:
    import numpy as np
    from scipy.integrate import solve_ivp
    from scipy.optimize import least_squares
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

GM, RADIUS, LIGHT = 3.986004415e14, 6378136.3, 299792458.0
# EGM2008: normalised C20, C30, C40 (Pavlis et al. 2012); J_n = -sqrt(2 n + 1) C_n0.
J = {2: 0.484165143790815e-3 * 5 ** 0.5, 3: -0.957161207093473e-6 * 7 ** 0.5, 4: -0.539965866638991e-6 * 3}


def acceleration(r, pole):
    """Gradient of GM / r (1 - sum J_n (R / r)^n P_n(s)), s = r . pole / r, by derivatives of Legendre polynomials."""
    d = np.linalg.norm(r)
    u, s = r / d, r @ pole / d
    legendre = {2: ((3 * s * s - 1) / 2, 3 * s), 3: ((5 * s ** 3 - 3 * s) / 2, (15 * s * s - 3) / 2),
                4: ((35 * s ** 4 - 30 * s * s + 3) / 8, (140 * s ** 3 - 60 * s) / 8)}
    along, polar = -1.0, 0.0
    for n, j in J.items():
        p, slope = legendre[n]
        along += j * (RADIUS / d) ** n * ((n + 1) * p + s * slope)
        polar -= j * (RADIUS / d) ** n * slope
    return GM / d ** 2 * (along * u + polar * pole)


def path(state, start_s, end_s, pole):
    done = solve_ivp(lambda _, x: np.concatenate([x[3:], acceleration(x[:3], pole)]), (start_s, end_s), state,
                     method="DOP853", rtol=1e-12, atol=1e-6, dense_output=True)
    if not done.success:
        raise RuntimeError(done.message)
    return done


def vector(state):
    return np.array(state["position_m"] + state["velocity_m_per_s"])


def residuals(state, start_s, observations, pole):
    """Residuals of both angles in sigmas: tangents at what was observed."""
    first = min(o["time_s"] for o in observations) - 1
    last = max(o["time_s"] for o in observations) + 1
    back, on = path(state, start_s, first, pole).sol, path(state, start_s, last, pole).sol
    out = []
    for o in observations:
        seen, sensor, light_s = np.array(o["direction"]), np.array(o["sensor_m"]), 0.0
        for _ in range(4):
            t = o["time_s"] - light_s
            line = (on if t >= start_s else back)(t)[:3] - sensor
            light_s = np.linalg.norm(line) / LIGHT
        east = np.array([-seen[1], seen[0], 0]) / np.hypot(seen[0], seen[1])
        direction = line / np.linalg.norm(line)
        out += [direction @ east / o["sigma_rad"], direction @ np.cross(seen, east) / o["sigma_rad"]]
    return np.array(out)


def judge(program, seed):
    """Asserts on one simulated pass; returns the largest differences in sigmas and the path's in metres."""
    case = json.loads(subprocess.run([program, str(seed)], capture_output=True, text=True, check=True).stdout)
    pole = np.array(case["pole"])
    end = path(vector(case["truth"]), 0, 86400, pole).y[:3, -1]
    path_m = np.linalg.norm(end - case["a_day_later"]["position_m"])
    # The program's pole moves by less than 0.2 arcsec in the day: 10 m at most.
    assert path_m < 10, f"seed {seed}: a day's path ends {path_m:.2f} m from DOP853's"

    fit = case["fit"]
    start_s = fit["state"]["time_s"]
    scale = np.array([1e3] * 3 + [1.0] * 3)
    found = least_squares(lambda x: residuals(x * scale, start_s, case["observations"], pole),
                          vector(case["truth"]) / scale, x_scale="jac", jac="3-point", xtol=1e-14, ftol=1e-14)
    state = found.x * scale
    covariance = np.linalg.inv(found.jac.T @ found.jac) * np.outer(scale, scale)
    ours = np.array(fit["covariance"]).reshape(6, 6)
    whiten = np.linalg.inv(np.linalg.cholesky(covariance))
    fit_sigma = np.linalg.norm(whiten @ (vector(fit["state"]) - state))
    assert fit_sigma < 0.05, f"seed {seed}: the fit is {fit_sigma:.3f} sigma from scipy's"
    ratio = np.sqrt(np.diag(ours) / np.diag(covariance))
    assert np.all(abs(ratio - 1) < 0.01), f"seed {seed}: sigmas are {ratio} of scipy's"

    last = case["filter"]
    there = path(state, start_s, last["state"]["time_s"], pole).y[:, -1]
    moved = np.array(last["covariance"]).reshape(6, 6)
    whiten = np.linalg.inv(np.linalg.cholesky(moved))
    filter_sigma = np.linalg.norm(whiten @ (vector(last["state"]) - there))
    assert filter_sigma < 0.3, f"seed {seed}: the filter ends {filter_sigma:.3f} sigma from scipy's fit"
    return path_m, fit_sigma, filter_sigma


def main():
    worst = np.max([judge(sys.argv[1], seed) for seed in range(1, 6)], axis=0)
    print(f"ok: a day's path within {worst[0]:.3f} m of DOP853, the fit within {worst[1]:.4f} sigma of scipy's, "
          f"the filter within {worst[2]:.4f}")


if __name__ == "__main__":
    main()
