"""Manoeuvres on paths that scipy's DOP853 integrates, with forces of this file, are found with honest times and sizes.

    manoeuvres_with_scipy.py MANOEUVRE_CASE [LOW_CASES GEOSTATIONARY_CASES]

Drawn are the time of a change of velocity, its size (5 cm/s to 1 m/s, by its logarithm) and its direction (a third each: along the motion,
along the normal, anywhere); the observations' errors are those of their sensors. Judged are the estimates by all observations. Over all
cases: squared errors over the covariance of the time and of the size, about the likeliest mode with the spread of all modes, and within the
mode that has the truth; how often the modes that are told to have a chance have the truth. Without scipy or ERFA it exits 77.
"""
import json
import subprocess
import sys

try:
    import erfa
    import numpy as np
    from scipy.integrate import solve_ivp
    from scipy.stats import chi2
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

START, START_JD = "2018-12-24T22:00:00", (2458477.0, 0.5 - 2 / 24)
TT_MINUS_UTC_S = 69.184
GM, RADIUS, LIGHT = 3.986004415e14, 6378136.3, 299792458.0
GM_SUN, GM_MOON, AU_M = 1.32712440018e20, 4.902800e12, 149597870700.0
LOVE = 0.3019
# EGM2008, fully normalised, tide-free (Pavlis, Holmes, Kenyon & Factor 2012): (n, m): C, S.
TERMS = {(2, 0): (-4.84165143790815e-4, 0), (2, 1): (-2.06615509074176e-10, 1.38441389137979e-9),
         (2, 2): (2.43938357328313e-6, -1.40027370385934e-6), (3, 0): (9.57161207093473e-7, 0),
         (3, 1): (2.03046201047864e-6, 2.48200415856872e-7), (3, 2): (9.04787894809528e-7, -6.19005475177618e-7),
         (3, 3): (7.21321757121568e-7, 1.41434926192941e-6), (4, 0): (5.39965866638991e-7, 0),
         (4, 1): (-5.36157389388867e-7, -4.73567346518086e-7), (4, 2): (3.50501623962649e-7, 6.62480026275829e-7),
         (4, 3): (9.90856766672321e-7, -2.00956723567452e-7), (4, 4): (-1.88519633023033e-7, 3.08803882149194e-7)}
STEP_S, TABLE_S = 30.0, 600.0
HOUR_S = 3600.0


def unnormalised():
    out = {}
    for (n, m), (c, s) in TERMS.items():
        factorial = np.prod(np.arange(n - m + 1, n + m + 1, dtype=float))  # (n + m)! / (n - m)!
        scale = np.sqrt((2 * n + 1) * (1 if m == 0 else 2) / factorial)
        out[n, m] = complex(c * scale, s * scale)
    return out


FIELD = unnormalised()


def gravity(r):
    """Earth-fixed acceleration by the recursion of Cunningham (1970), harmonics V + iW, as in Montenbruck & Gill, section 3.2. Rows: places."""
    top = 5
    d2 = np.sum(r * r, axis=1)
    x, y, z = (r * (RADIUS / d2)[:, None]).T
    ratio = RADIUS * RADIUS / d2
    e = {(0, 0): RADIUS / np.sqrt(d2) + 0j}
    for m in range(top + 1):
        if m:
            e[m, m] = (2 * m - 1) * (x + 1j * y) * e[m - 1, m - 1]
        for n in range(m + 1, top + 1):
            e[n, m] = ((2 * n - 1) * z * e[n - 1, m] - (n + m - 1) * ratio * e.get((n - 2, m), 0)) / (n - m)
    plane, up = 0.0, 0.0
    for (n, m), cs in {(0, 0): complex(1), **FIELD}.items():
        c = cs.conjugate()
        if m == 0:
            plane = plane - c.real * e[n + 1, 1]
        else:
            plane = plane + 0.5 * ((n - m + 2) * (n - m + 1) * (c * e[n + 1, m - 1]).conj() - c * e[n + 1, m + 1])
        up = up - (n - m + 1) * (c * e[n + 1, m]).real
    return GM / RADIUS ** 2 * np.array([plane.real, plane.imag, up]).T


class Surroundings:
    """The celestial pole, Sun and Moon at every 10 minutes of a run; UT1 is UTC and the pole doesn't move on the Earth."""

    def __init__(self, length_s):
        rows = []
        for t in np.arange(0, length_s + 2 * TABLE_S, TABLE_S):
            tt = (START_JD[0], START_JD[1] + (t + TT_MINUS_UTC_S) / 86400)
            heliocentric, _ = erfa.epv00(*tt)
            rows.append(np.concatenate([erfa.c2i06a(*tt).ravel(), -np.array(heliocentric["p"]) * AU_M, np.array(erfa.moon98(*tt)["p"]) * AU_M]))
        self.table = np.array(rows)

    def at(self, t):
        k = (t // TABLE_S).astype(int)
        now = self.table[k] + (t / TABLE_S - k)[:, None] * (self.table[k + 1] - self.table[k])
        angle = erfa.era00(START_JD[0], START_JD[1] + t / 86400)
        c, s, one = np.cos(angle), np.sin(angle), np.ones_like(angle)
        turn = np.array([[c, s, 0 * one], [-s, c, 0 * one], [0 * one, 0 * one, one]]).transpose(2, 0, 1)
        return turn @ now[:, :9].reshape(-1, 3, 3), now[:, 9:12], now[:, 12:]


def length(v):
    return np.sqrt(np.sum(v * v, axis=1))[:, None]


def acceleration(around, t, r, v):
    """Of places r with velocities v (rows) at times t."""
    turn, sun, moon = around.at(t)
    d = length(r)
    out = np.einsum("nji,nj->ni", turn, gravity(np.einsum("nij,nj->ni", turn, r)))
    for gm, body in ((GM_SUN, sun), (GM_MOON, moon)):
        far, apart = length(body), body - r
        out = out + gm * (apart / length(apart) ** 3 - body / far ** 3)
        cosine = np.sum(r * body, axis=1)[:, None] / (d * far)
        out = out + LOVE / 2 * gm / far ** 3 * RADIUS ** 5 / d ** 4 * ((3 - 15 * cosine ** 2) * r / d + 6 * cosine * body / far)
    speed2, radial = np.sum(v * v, axis=1)[:, None], np.sum(r * v, axis=1)[:, None]
    return out + GM / (LIGHT ** 2 * d ** 3) * ((4 * GM / d - speed2) * r + 4 * radial * v)  # Schwarzschild


class Paths:
    """States that fly together, each from its own time to its own end."""

    def __init__(self, around, states, from_s, to_s):
        n = len(states)
        self.from_s, self.span_s = np.broadcast_to(from_s, n), np.broadcast_to(np.subtract(to_s, from_s), n)

        def slope(share, flat):
            x = flat.reshape(n, 6)
            a = acceleration(around, self.from_s + share * self.span_s, x[:, :3], x[:, 3:])
            return (self.span_s[:, None] * np.hstack([x[:, 3:], a])).ravel()
        done = solve_ivp(slope, (0.0, 1.0), np.ravel(states), method="DOP853", rtol=3e-11, atol=1e-5, dense_output=True)
        if not done.success:
            raise RuntimeError(done.message)
        self.path = done.sol

    def of(self, i, times):
        """States of the i-th at times."""
        return self.path((np.asarray(times) - self.from_s[i]) / self.span_s[i])[6 * i:6 * i + 6].T


def axes(state):
    radial, normal = state[:3] / np.linalg.norm(state[:3]), np.cross(state[:3], state[3:])
    normal /= np.linalg.norm(normal)
    return np.array([radial, np.cross(normal, radial), normal]).T


def circular(radius_m, inclination_deg, node_deg, from_node_deg):
    i, o, u = np.radians([inclination_deg, node_deg, from_node_deg])
    ahead = np.array([np.cos(o), np.sin(o), 0])
    up = np.array([-np.sin(o) * np.cos(i), np.cos(o) * np.cos(i), np.sin(i)])
    return np.concatenate([radius_m * (np.cos(u) * ahead + np.sin(u) * up),
                           np.sqrt(GM / radius_m) * (np.cos(u) * up - np.sin(u) * ahead)])


# network, state, times between which manoeuvres are drawn, and the end [h]
REGIMES = {"low": ("wide", circular(7.192e6, 98.6, 65, 180), (14, 26), 40),
           "geostationary": ("belt", circular(42.164e6, 0.05, 0, 68 + 10), (12, 28), 54)}


def drawn(generator, hours):
    direction = [np.array([0, 1.0, 0]), np.array([0, 0, 1.0]), generator.normal(size=3)][generator.integers(3)]
    size = np.exp(generator.uniform(np.log(0.05), np.log(1.0))) * generator.choice([-1, 1])
    return generator.uniform(*hours) * HOUR_S, size * direction / np.linalg.norm(direction)


def cases_of(regime, count, seed):
    """The truths, and the input of manoeuvre-case."""
    network, start, hours, end_h = REGIMES[regime]
    end_s = end_h * HOUR_S
    around = Surroundings(end_s)
    generator = np.random.default_rng(seed)
    truths = [drawn(generator, hours) for _ in range(count)]
    times = np.array([at_s for at_s, _ in truths])
    quiet = Paths(around, [start], 0.0, times.max() + STEP_S)
    burnt = []
    for at_s, change in truths:
        state = quiet.of(0, [at_s])[0]
        state[3:] += axes(state) @ change
        burnt.append(state)
    after = Paths(around, burnt, times, end_s)
    grid, text = np.arange(0, end_s + STEP_S, STEP_S), []
    for number, at_s in enumerate(times):
        rows = np.vstack([quiet.of(0, grid[grid < at_s]), after.of(number, grid[(grid >= at_s) & (grid <= end_s)])])
        text.append(f"{seed + number} {network} {STEP_S} {len(rows)}\n" + "\n".join(" ".join(map(repr, map(float, row))) for row in rows))
    return truths, text


def matrix(numbers):
    return np.array(numbers).reshape(3, 3)


def size_d2(told, change):
    off = np.array(told["delta_v_m_per_s"]) - change
    return off @ np.linalg.solve(matrix(told["covariance"]), off) / 3


def own_mode(modes, at_s, change):
    """The mode to which the truth belongs: of the largest chance and density there."""
    def density(m):
        return (np.log(m["chance"]) - 0.5 * ((m["time_s"] - at_s) / m["time_sigma_s"]) ** 2 - np.log(m["time_sigma_s"]))
    return max(modes, key=density)


class Tally:
    def __init__(self):
        self.cases = self.found = self.others = 0
        self.scores = {key: [] for key in ("time", "size", "mode_time", "mode_size", "first_chance", "own_chance", "modes", "off_s",
                                           "off_m_per_s", "orbit", "is_first")}

    def add(self, told, truth, which):
        at_s, change = truth
        self.cases += 1
        candidates = [m for m in told[which] if m["found_s"] > at_s]
        self.others += len(told[which]) - min(1, len(candidates))
        if not candidates:
            return None
        self.found += 1
        m = candidates[0]
        own = own_mode(m["modes"], at_s, change)
        s = self.scores
        s["time"].append(((m["time_s"] - at_s) / m["time_sigma_s"]) ** 2)
        s["size"].append(size_d2(m, change))
        s["mode_time"].append(((own["time_s"] - at_s) / own["time_sigma_s"]) ** 2)
        s["mode_size"].append(size_d2(own, change))
        s["own_chance"].append(own["chance"])
        s["first_chance"].append(m["modes"][0]["chance"])
        s["is_first"].append(float(own is m["modes"][0]))
        s["modes"].append(len(m["modes"]))
        s["off_s"].append(abs(m["time_s"] - at_s))
        s["off_m_per_s"].append(np.linalg.norm(np.array(m["delta_v_m_per_s"]) - change))
        s["orbit"].append(told["end"]["nees"])
        return m

    def lines(self, name):
        mean = {key: np.mean(values) for key, values in self.scores.items()}
        middle = {key: np.median(values) for key, values in self.scores.items()}
        yield f"{name}: {self.found} of {self.cases} are found, {self.others} others"
        yield (f"  all modes: time {mean['time']:.2f}, size {mean['size']:.2f}; the truth's mode: time {mean['mode_time']:.2f}, "
               f"size {mean['mode_size']:.2f}; orbit at the end {mean['orbit']:.2f}")
        yield (f"  {mean['modes']:.1f} modes; the likeliest has the truth in {mean['is_first']:.2f}, told {mean['first_chance']:.2f}; "
               f"off by {mean['off_s']:.0f} s (median {middle['off_s']:.0f}), {mean['off_m_per_s']:.4f} m/s (median {middle['off_m_per_s']:.4f})")


def main(program, counts, verbose):
    good = True
    everything = Tally()
    for (regime, count), seed in zip(counts.items(), (11, 12)):
        truths, text = cases_of(regime, count, seed)
        done = subprocess.run([program], input=START + "\n" + "\n".join(text) + "\n", capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(done.stderr)
        last, first = Tally(), Tally()
        for truth, line in zip(truths, done.stdout.splitlines()):
            told = json.loads(line)
            m = last.add(told, truth, "at_last")
            everything.add(told, truth, "at_last")
            first.add(told, truth, "at_first")
            if verbose and m:
                print("%8.0f s %s: off %7.0f s, sigma %6.0f s, modes %s, size d2 %.2f, orbit %.2f" % (
                    truth[0], np.round(truth[1], 3), m["time_s"] - truth[0], m["time_sigma_s"],
                    [(round(x["chance"], 3), round(x["time_s"] - truth[0]), round(x["time_sigma_s"])) for x in m["modes"]],
                    size_d2(m, truth[1]), told["end"]["nees"]))
            elif verbose:
                print("%8.0f s %s: not found, %s" % (truth[0], np.round(truth[1], 3), told["at_last"]))
        for line in [*last.lines(regime + ", at last"), *first.lines(regime + ", when found")]:
            print(line)
    for line in everything.lines("all"):
        print(line)
    n = everything.found
    for key, degrees, bound in (("mode_time", n, 1.0), ("mode_size", 3 * n, 1.0)):
        mean = np.mean(everything.scores[key])
        low, high = chi2.ppf([0.0005, 0.9995], degrees) / degrees
        low, high = min(low, 0.8 * bound), max(high, 1.2 * bound)
        print(f"{key}: {mean:.2f} must be {low:.2f} to {high:.2f}")
        good &= low < mean < high
    good &= everything.found >= 0.9 * everything.cases
    return good


if __name__ == "__main__":
    arguments = [a for a in sys.argv[1:] if a != "-v"]
    low, geostationary = map(int, arguments[1:3]) if len(arguments) > 2 else (26, 26)
    sys.exit(0 if main(arguments[0], {"low": low, "geostationary": geostationary}, "-v" in sys.argv) else 1)
