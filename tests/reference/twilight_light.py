"""Light of the twilight sky by successive orders of scattering in spherical air.

Sunlight comes along bent rays with its disc; the air is that of the day sky: molecules, haze, ozone, over a
Lambertian ground. Light from all around is kept by height and the Sun's zenith angle, in moments up to order 2.
Scalar; lines of sight are straight. Prints core/sky/twilight_pattern.inc, and beside it (stderr) the zenith, how
well the fit is and the sky 30 deg up. Takes two minutes. Needs numpy.

    twilight_light.py [WAVELENGTH_NM [HAZE_AT_550_NM]]
"""
import sys

import numpy as np

EARTH_M, TOP_M = 6371e3, 100e3
SUN_RADIUS_RAD = 0.004652
FORWARD, BODY, BACKWARD = (0.056, 0.966), (0.923, 0.638), (0.021, -0.637)
HAZE_ALBEDO, HAZE_SCALE_M = 0.94, 2000.0


def relative_density(z):
    """U.S. Standard Atmosphere 1976."""
    base = [(0, 288.15, -6.5e-3), (11e3, 216.65, 0), (20e3, 216.65, 1e-3), (32e3, 228.65, 2.8e-3),
            (47e3, 270.65, 0), (51e3, 270.65, -2.8e-3), (71e3, 214.65, -2e-3)]
    h = 6356766.0 * np.asarray(z, float) / (6356766.0 + np.asarray(z, float))
    c, pressure = 0.0341632, 1.0
    density = np.zeros_like(h)
    for i, (low, kelvin, slope) in enumerate(base):
        def ratio(rise):
            if slope == 0:
                return np.exp(-c * rise / kelvin)
            return (np.maximum(1.0, kelvin + slope * rise) / kelvin) ** (-c / slope)
        here = np.maximum(150.0, kelvin + slope * (h - low))
        inside = h >= low
        density = np.where(inside, pressure * ratio(np.where(inside, h - low, 0)) * 288.15 / here, density)
        if i + 1 < len(base):
            pressure *= ratio(base[i + 1][0] - low)
    return density


def ozone_absorption(nm):
    return np.interp(nm, [350, 440, 450, 480, 500, 530, 550, 570, 593, 610, 630, 656, 690, 740, 780],
                     [.007, 0, .003, .014, .03, .063, .085, .12, .119, .12, .09, .065, .028, .01, 0])


def haze_phase(c):
    return sum(a * (1 - g * g) / (1 + g * g - 2 * g * c) ** 1.5 for a, g in (FORWARD, BODY, BACKWARD))


def haze_moment(l):
    return sum(a * g**l for a, g in (BODY, BACKWARD)) / (BODY[0] + BACKWARD[0])


class Air:
    """Extinction and scattering [1/m] by the height over the ground."""

    def __init__(self, nm, haze, ground_m):
        s = (1000.0 / nm) ** 2
        fine = np.linspace(0, TOP_M, 20001)
        column = np.sum(relative_density(fine)) * (fine[1] - fine[0])
        self.depth = 0.008569 * s * s * (1 + 0.0113 * s + 0.00013 * s * s) / column
        self.haze = haze * (nm / 550.0) ** -1.3 / HAZE_SCALE_M
        self.ozone = ozone_absorption(nm) * 0.3 / (5e3 * np.sqrt(2 * np.pi))
        self.ground_m = ground_m
        self.refractivity = 2.77e-4

    def molecules(self, z):
        return self.depth * relative_density(z + self.ground_m)

    def refraction(self, z):
        """Fall of the refractive index with height [1/m]."""
        z = np.maximum(z, 50.0) + self.ground_m
        return self.refractivity * (relative_density(z - 50) - relative_density(z + 50)) / 100

    def haze_once(self, z):
        return HAZE_ALBEDO * self.haze * np.exp(-z / HAZE_SCALE_M)

    def extinction(self, z):
        haze = self.haze * np.exp(-z / HAZE_SCALE_M) * (1 - HAZE_ALBEDO * FORWARD[0])
        return self.molecules(z) + haze + self.ozone * np.exp(-0.5 * ((z + self.ground_m - 22e3) / 5e3) ** 2)


class Line:
    """Steps along a line from a radius in a direction, to the ground or beyond the air."""

    def __init__(self, air, radius, mu, ground, step_m=16e3):
        top = ground + TOP_M
        passes2 = radius**2 * (1 - mu**2)
        self.hits = mu < 0 and passes2 < ground**2
        here = radius * mu
        shells = ground + TOP_M * np.linspace(0, 1, 81) ** 2
        end = -np.sqrt(ground**2 - passes2) if self.hits else np.sqrt(top**2 - passes2)
        beyond = shells[shells**2 > passes2]
        at = np.sqrt(beyond**2 - passes2)
        at = np.unique(np.concatenate([[here, end], at, -at]))
        at = at[(at >= here) & (at <= end)]
        pieces = [np.linspace(a, b, max(2, int(np.ceil((b - a) / step_m)) + 1))[:-1]
                  for a, b in zip(at[:-1], at[1:])]
        edges = np.concatenate(pieces + [[end]])
        middle = 0.5 * (edges[1:] + edges[:-1])
        self.radius = np.sqrt(passes2 + middle**2)
        self.along = middle - here
        self.end = end - here
        self.mu = middle / self.radius
        depth = air.extinction(self.radius - ground) * np.diff(edges)
        before = np.concatenate([[0], np.cumsum(depth)])
        share = np.where(depth > 1e-9, -np.expm1(-depth) / np.maximum(depth, 1e-300), 1.0)
        self.weight = np.exp(-before[:-1]) * share * np.diff(edges)
        self.through = np.exp(-before[-1])
        self.bends = np.sum(air.refraction(self.radius - ground) * np.sqrt(1 - self.mu**2) * np.diff(edges))


class Twilight:
    def __init__(self, nm=550.0, haze=0.1, ground_m=0.0, albedo=0.2, orders=8):
        self.air, self.albedo = Air(nm, haze, ground_m), albedo
        self.ground = EARTH_M + ground_m
        self.levels = TOP_M * np.linspace(0, 1, 31) ** 2
        self.theta = np.deg2rad(np.arange(66.0, 120.1, 1.0))
        self.make_sunlight()
        t, w = np.polynomial.legendre.leggauss(10)
        t, w = 0.5 * (t + 1), 0.5 * w
        self.mu = np.concatenate([-(t[::-1] ** 2), t**2])
        self.mu_weight = np.concatenate([(2 * t * w)[::-1], 2 * t * w])
        self.phi = np.pi * (np.arange(8) + 0.5) / 8  # half a turn
        self.lines = [[Line(self.air, self.ground + z, m, self.ground) for m in self.mu] for z in self.levels]
        self.sum_orders(orders)

    def make_sunlight(self):
        """Share of sunlight by height and the Sun's zenith angle."""
        self.sun_z = TOP_M * np.linspace(0, 1, 161) ** 2
        self.sun_theta = np.deg2rad(np.arange(60, 126, 0.1))
        seen = np.deg2rad(np.arange(55, 126, 0.1))  # where the bent ray comes from, at the point
        out = np.zeros((len(self.sun_z), len(self.sun_theta)))
        for i, z in enumerate(self.sun_z):
            r = self.ground + z
            dip = np.arccos(self.ground / r)
            share = np.clip(0.5 + 0.5 * (np.pi / 2 - seen + dip) / SUN_RADIUS_RAD, 0, 1)
            light, true = np.zeros(len(seen)), np.zeros(len(seen))
            count = np.count_nonzero(share > 0)
            for j in range(count):
                # the lower half of the disc is hidden by the ground: a line over it
                mu = max(np.cos(seen[j]), -np.sqrt(1 - (self.ground / r) ** 2) * (1 - 1e-9))
                line = Line(self.air, r, mu, self.ground, step_m=1e9)
                light[j] = share[j] * line.through
                true[j] = seen[j] + line.bends
            light, true = light[:count], true[:count]
            light *= np.gradient(seen[:count], true)  # bent rays spread
            out[i] = np.interp(self.sun_theta, true, light, right=0.0)
        self.sunlight = out

    def sun_at(self, z, theta):
        a = np.clip(np.sqrt(np.maximum(z, 0) / TOP_M) * (len(self.sun_z) - 1), 0, len(self.sun_z) - 1.000001)
        b = np.clip((theta - self.sun_theta[0]) / np.deg2rad(0.1), 0, len(self.sun_theta) - 1.000001)
        i, j = a.astype(int), b.astype(int)
        u, v = a - i, b - j
        s = self.sunlight
        return ((1 - u) * ((1 - v) * s[i, j] + v * s[i, j + 1]) + u * ((1 - v) * s[i + 1, j] + v * s[i + 1, j + 1]))

    def along(self, line, radius, mu, theta, cos_phi):
        """Where a line goes: the Sun's zenith angle and the components of its direction there."""
        to_sun = mu * np.cos(theta) + np.sqrt(1 - mu**2) * cos_phi * np.sin(theta)
        cos_there = (radius * np.cos(theta) + line.along[:, None, None] * to_sun) / line.radius[:, None, None]
        there = np.arccos(np.clip(cos_there, -1, 1))
        up = line.mu[:, None, None]
        side = (to_sun - up * cos_there) / np.sin(there)
        return to_sun, there, up, side

    def once(self, line, to_sun, there):
        z = line.radius - self.ground
        sun = self.sun_at(np.broadcast_to(z[:, None, None], there.shape), there)
        phase = (0.75 * (1 + to_sun**2) * self.air.molecules(z)[:, None, None]
                 + haze_phase(to_sun) * self.air.haze_once(z)[:, None, None])
        return np.einsum("s,stp->tp", line.weight, sun * phase) / (4 * np.pi)

    def again(self, moments, line, there, up, side):
        """Light scattered again by the moments of the light at the grid's points."""
        z = line.radius - self.ground
        a = np.clip(np.sqrt(np.maximum(z, 0) / TOP_M) * (len(self.levels) - 1), 0, len(self.levels) - 1.000001)
        i = a.astype(int)
        u = (a - i)[:, None]
        log_mean = (1 - u) * moments["log"][i] + u * moments["log"][i + 1]
        rest = (1 - u[None]) * moments["rest"][:, i] + u[None] * moments["rest"][:, i + 1]
        b = np.clip((there - self.theta[0]) / (self.theta[1] - self.theta[0]), -20, len(self.theta) + 20)
        j = np.clip(b.astype(int), 0, len(self.theta) - 2)
        v = b - j
        s = np.arange(len(z))[:, None, None]
        mean = np.exp((1 - v) * log_mean[s, j] + v * log_mean[s, j + 1])
        v = np.clip(v, 0, 1)
        fu, fs, kuu, kss, kus = ((1 - v) * m[s, j] + v * m[s, j + 1] for m in rest)
        across2 = np.maximum(0, 1 - up**2 - side**2)
        k = kuu * up**2 + kss * side**2 + 2 * kus * up * side + (1 - kuu - kss) * across2
        haze = (1 - FORWARD[0]) * self.air.haze_once(z)[:, None, None]
        phase = (self.air.molecules(z)[:, None, None] * 0.75 * (1 + k)
                 + haze * (1 + 3 * haze_moment(1) * (fu * up + fs * side) + 2.5 * haze_moment(2) * (3 * k - 1)))
        return np.einsum("s,stp->tp", line.weight, mean * phase) / (4 * np.pi)

    def of_ground(self, ground, line, there_end):
        if not line.hits:
            return 0.0
        return line.through * np.exp(np.interp(there_end, self.theta, np.log(np.maximum(ground, 1e-200))))

    def light(self, moments, ground, line, radius, mu, theta, cos_phi):
        to_sun, there, up, side = self.along(line, radius, mu, theta[:, None], cos_phi[None, :])
        if moments is None:
            sky = self.once(line, to_sun, there)
        else:
            sky = self.again(moments, line, there, up, side)
        if line.hits:
            cos_end = (radius * np.cos(theta[:, None]) + line.end * to_sun) / self.ground
            sky = sky + self.of_ground(ground, line, np.arccos(np.clip(cos_end, -1, 1)))
        return sky

    def moments_of(self, moments, ground):
        shape = (len(self.levels), len(self.theta))
        mean, fu, fs, kuu, kss, kus = (np.zeros(shape) for _ in range(6))
        flux = np.zeros(len(self.theta))
        cos_phi = np.cos(self.phi)
        for i, z in enumerate(self.levels):
            for m, mu in enumerate(self.mu):
                light = self.light(moments, ground, self.lines[i][m], self.ground + z, mu, self.theta, cos_phi)
                light = light * self.mu_weight[m] * 2 * np.pi / len(self.phi)
                side = np.sqrt(1 - mu**2) * cos_phi
                total, first = light.sum(1), (light * side).sum(1)
                mean[i] += total
                fu[i] += mu * total
                fs[i] += first
                kuu[i] += mu * mu * total
                kus[i] += mu * first
                kss[i] += (light * side**2).sum(1)
                if i == 0 and mu > 0:
                    flux += mu * total
        safe = np.maximum(mean, 1e-200)
        rest = np.stack([fu, fs, kuu, kss, kus]) / safe
        return {"log": np.log(safe), "rest": rest, "mean": mean}, self.albedo / np.pi * flux

    def sum_orders(self, orders):
        """Sums of all orders but the first, as moments that light is scattered from."""
        ground = self.albedo / np.pi * np.maximum(0, np.cos(self.theta)) * self.sun_at(
            np.zeros_like(self.theta), self.theta)
        moments, self.all, self.all_ground = None, None, np.zeros_like(ground)
        sums = []
        for order in range(orders):
            self.all_ground = self.all_ground + ground
            moments, ground = self.moments_of(moments, ground)
            mean = moments["mean"]
            sums.append((mean, moments["rest"] * mean))
        mean = sum(m for m, _ in sums)
        safe = np.maximum(mean, 1e-200)
        self.all = {"log": np.log(safe), "rest": sum(r for _, r in sums) / safe}
        self.last_over_sum = float(np.max(sums[-1][0] / safe))

    def sky(self, depressions_deg, altitudes_deg, azimuths_deg):
        """Radiance over the Sun's irradiance [1/sr] and that scattered once: depressions x altitudes x azimuths."""
        theta = np.deg2rad(90.0 + np.asarray(depressions_deg))
        cos_phi = np.cos(np.deg2rad(azimuths_deg))
        out, first = [], []
        for altitude in altitudes_deg:
            mu = np.sin(np.deg2rad(altitude))
            line = Line(self.air, self.ground, mu, self.ground, step_m=4e3)
            once = self.light(None, None, line, self.ground, mu, theta, cos_phi)
            first.append(once)
            out.append(once + self.light(self.all, None, line, self.ground, mu, theta, cos_phi))
        return np.stack(out, 1), np.stack(first, 1)


DEPRESSIONS_DEG = np.arange(0, 19.0)
ALTITUDES_DEG = np.array([0, 0.5, 1, 2, 3, 4, 5, 7, 10, 13, 16, 20, 25, 30, 37, 45, 55, 65, 75, 83, 90])
AZIMUTHS_DEG = np.arange(0, 181, 15)
POWERS_OF_X, POWERS_OF_V, NEAR_HORIZON = 7, 5, 0.3


def terms():
    """The terms of `TwilightPattern`, directions x terms, and the place of each in its table."""
    s = np.sin(np.deg2rad(ALTITUDES_DEG))[:, None] + 0 * AZIMUTHS_DEG
    x = np.cos(np.deg2rad(ALTITUDES_DEG))[:, None] * np.cos(np.deg2rad(AZIMUTHS_DEG))
    v = NEAR_HORIZON * (1 - s) / (s + NEAR_HORIZON)
    places = [(i, j) for i in range(POWERS_OF_X) for j in range(POWERS_OF_V) if i + j > 0]
    return np.stack([(x**i * v**j).ravel() for i, j in places], 1), places


def fit(log_ratio, depression_deg):
    """Least squares; the aureole of a Sun near the horizon, which the day sky has, weighs little."""
    matrix, places = terms()
    a, z = np.deg2rad(ALTITUDES_DEG)[:, None], np.deg2rad(AZIMUTHS_DEG)
    h = np.deg2rad(depression_deg)
    cosine = np.cos(a) * np.cos(z) * np.cos(h) - np.sin(a) * np.sin(h)
    from_sun = np.rad2deg(np.arccos(np.clip(cosine, -1, 1)))
    weight = np.where(from_sun < 12, 0.1, 1.0).ravel() if depression_deg < 3 else np.ones(log_ratio.size)
    small = 1e-3 * np.eye(len(places))
    found = np.linalg.lstsq(np.concatenate([matrix * weight[:, None], small]),
                            np.concatenate([log_ratio.ravel() * weight, np.zeros(len(places))]), rcond=None)[0]
    table = np.zeros((POWERS_OF_X, POWERS_OF_V))
    for (i, j), value in zip(places, found):
        table[i, j] = value
    return table, (matrix @ found).reshape(log_ratio.shape) - log_ratio


def main():
    nm, haze = (float(x) for x in (sys.argv[1:] + ["550", "0.1"][len(sys.argv) - 1:])[:2])
    light, once = Twilight(nm, haze).sky(DEPRESSIONS_DEG, ALTITUDES_DEG, AZIMUTHS_DEG)
    log_ratio = np.log(light / light[:, -1:, :1])
    tables, errors = zip(*(fit(*row) for row in zip(log_ratio, DEPRESSIONS_DEG)))
    print("// Coefficients of ln(brightness over the zenith's) by the Sun's depression, powers of X and of V.")
    print("// tests/reference/twilight_light.py")
    print("constexpr double step_deg = 1.0;")
    print("constexpr double nodes[][powers_of_x][powers_of_v] = {")
    for table in tables:
        rows = ["{" + ", ".join("%.4g" % v for v in row) + "}" for row in table]
        print("    {" + ",\n     ".join(rows) + "},")
    print("};")
    for d, table_errors, sky, first in zip(DEPRESSIONS_DEG, errors, light, once):
        print("%2.0f deg down: zenith %.2f mag/arcsec2 (a Sun of -26.76), once %.3f; the fit: rms %.3f, "
              "from 10 deg up at most %.3f, at all %.3f mag; 30 deg up, 0 to 180 deg from the Sun: %s" %
              (d, -26.76 - 2.5 * np.log10(sky[-1, 0] * (np.pi / 648000) ** 2), first[-1, 0] / sky[-1, 0],
               1.086 * table_errors.std(), 1.086 * abs(table_errors[ALTITUDES_DEG >= 10]).max(),
               1.086 * abs(table_errors).max(), np.round(sky[13, ::3] / sky[-1, 0], 2)), file=sys.stderr)


if __name__ == "__main__":
    main()
