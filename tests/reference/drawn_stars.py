"""Star frames that GalSim draws: the shipped catalogue's stars at apparent places by ERFA, through a lens written here.

The lens is gnomonic, or Brown's (1966): with u = tan of the angle from the axis, the image lies at f u (1 + k1 u^2). The point spread is a
Gaussian or a Moffat whose width may grow with the square of the distance from the middle of the frame.
"""
import gzip
import math
import pathlib

import erfa
import galsim
import numpy as np
from scipy import optimize

CATALOGUE = pathlib.Path(__file__).parents[2] / "launch/catalogues/stars.dat.gz"
MAS = math.radians(1 / 3.6e6)
TT_UTC_S = 69.184  # from 2017 on
# Bessell 1990, PASP 102, 1181, table 2: V from 470 to 700 nm in steps of 10, of energy: that of photons goes as it over the wavelength.
BESSELL_V = [0.0, 0.03, 0.163, 0.458, 0.78, 0.967, 1.0, 0.973, 0.898, 0.792, 0.684, 0.574, 0.461, 0.359, 0.27, 0.197, 0.135, 0.081, 0.045, 0.025, 0.017, 0.013,
             0.009, 0.0]
VEGA_MAG = 0.03
FWHM_PER_SIGMA = 2 * math.sqrt(2 * math.log(2))


def photons_of_v0():
    """Photons a second and m2 of V = 0 in V, by GalSim's spectrum of Vega."""
    nm = np.arange(470, 701, 10.0)
    band = galsim.Bandpass(galsim.LookupTable(nm, np.array(BESSELL_V) * 530 / nm, interpolant="linear"), wave_type="nm")
    return galsim.SED("vega.txt", wave_type="nm", flux_type="flambda").calculateFlux(band) * 1e4 * 10**(0.4 * VEGA_MAG)


def read_catalogue():
    """RA, Dec [rad], proper motions [rad/yr; of RA on the sky], parallax [arcsec], V, B-V."""
    rows = []
    with gzip.open(CATALOGUE, "rt", encoding="ascii") as lines:
        for s in lines:
            if s.startswith("#"):
                continue
            ra = 15 * (int(s[0:2]) + int(s[2:4]) / 60 + float(s[4:9]) / 3600)
            dec = (-1 if s[10] == "-" else 1) * (int(s[11:13]) + int(s[13:15]) / 60 + float(s[15:19]) / 3600)
            rows.append((math.radians(ra), math.radians(dec), float(s[20:29]) * MAS, float(s[29:38]) * MAS, float(s[38:45]) / 1000, float(s[46:51]), float(s[51:56])))
    return np.array(rows).T


class Sky:
    """The catalogue as it is seen from the geocentre at an instant."""

    def __init__(self, utc_jd):
        ra, dec, pm_ra, pm_dec, parallax, self.v, self.bv = read_catalogue()
        tt = utc_jd + TT_UTC_S / 86400
        heliocentric, barycentric = erfa.epv00(tt, 0.0)
        p = erfa.pmpx(ra, dec, pm_ra / np.cos(dec), pm_dec, parallax, 0.0, (tt - 2451545.0) / 365.25, barycentric["p"])
        em = np.linalg.norm(heliocentric["p"])
        p = erfa.ldsun(p, heliocentric["p"] / em, em)
        v = barycentric["v"] * (erfa.DAU / erfa.DAYSEC / erfa.CMPS)
        self.directions = erfa.ab(p, v, em, math.sqrt(1 - v @ v))


class Lens:
    """`fwhm_px` on the axis, before pixels; `growth`: its relative growth to the corners, as the square of the radius."""

    def __init__(self, rng, columns, rows, pitch_m, moffat, distorted):
        self.columns, self.rows, self.pitch_m = columns, rows, pitch_m
        self.focal_m = rng.uniform(0.013, 0.02)
        self.aperture_m = self.focal_m / rng.uniform(1.8, 2.8)
        self.transmission = rng.uniform(0.4, 0.9)
        self.colour_term = rng.uniform(-0.1, 0.1)
        self.fwhm_px = rng.uniform(1.6, 3.0)
        self.beta = rng.uniform(3.0, 4.5) if moffat else None
        self.k1 = rng.uniform(0.05, 0.3) * rng.choice([-1, 1]) if distorted else 0.0
        self.growth = rng.uniform(0.3, 0.8) if distorted else 0.0
        area_m2 = math.pi / 4 * self.aperture_m**2
        self.zero_point_mag = 2.5 * math.log10(self.transmission * area_m2 * photons_of_v0())

    @property
    def corner_px(self):
        return math.hypot(self.columns - 1, self.rows - 1) / 2

    def truth(self):
        """What the camera file says, by its keys; 0 where a key is left out."""
        t = {"focal_length_m": self.focal_m, "distortion.k1": self.k1, "zero_point_mag": self.zero_point_mag, "psf_fwhm_px": 0.0,
             "psf_field middle": 0.0, "psf_field corner": 0.0}
        if self.growth:
            t.update({"psf_field middle": self.gaussian_fwhm_px(0.0), "psf_field corner": self.gaussian_fwhm_px(self.corner_px)})
        else:
            t["psf_fwhm_px"] = self.gaussian_fwhm_px(0.0)
        return t

    def psf(self, radius_px):
        fwhm = self.fwhm_px * (1 + self.growth * (radius_px / self.corner_px)**2)
        return galsim.Gaussian(fwhm=fwhm) if self.beta is None else galsim.Moffat(beta=self.beta, fwhm=fwhm)

    def places(self, directions, camera):
        """Pixels of directions; NaN behind the camera."""
        x, y, z = camera @ directions.T
        with np.errstate(divide="ignore", invalid="ignore"):
            u, v = np.where(z > 0.5, x / z, np.nan), np.where(z > 0.5, y / z, np.nan)
            scale = self.focal_m / self.pitch_m * (1 + self.k1 * (u * u + v * v))
        return u * scale + (self.columns - 1) / 2, v * scale + (self.rows - 1) / 2

    def frame(self, sky, camera, exposure_s, vignetting_at):
        """Electrons of the stars. The lens takes light from a star by where it is, and leaves its image as it is."""
        margin, half = 20, 24
        image = galsim.ImageD(self.columns, self.rows, xmin=0, ymin=0)
        xs, ys = self.places(sky.directions, camera)
        inside = (xs > -margin) & (xs < self.columns + margin) & (ys > -margin) & (ys < self.rows + margin)
        for i in np.flatnonzero(inside):
            radius = math.hypot(xs[i] - (self.columns - 1) / 2, ys[i] - (self.rows - 1) / 2)
            flux = exposure_s * 10**(0.4 * (self.zero_point_mag - sky.v[i] + self.colour_term * (sky.bv[i] - 0.65))) * vignetting_at(xs[i], ys[i])
            stamp = galsim.ImageD(galsim.BoundsI(*(int(round(xs[i])) + half * s for s in (-1, 1)), *(int(round(ys[i])) + half * s for s in (-1, 1))), scale=1.0)
            self.psf(radius).withFlux(flux).drawImage(stamp, center=galsim.PositionD(xs[i], ys[i]))
            shared = stamp.bounds & image.bounds
            if shared.isDefined():
                image[shared] += stamp[shared]
        return np.maximum(image.array, 0.0)

    def gaussian_fwhm_px(self, radius_px):
        """FWHM of the Gaussian that fits a star by least squares of even weight within two widths of most stars and a pixel, with a level; less
        the diffraction. A Moffat is the wider, the wider the window, by 5 to 8 % of it: rounds until it is that of its own width."""
        usual, before = self.fwhm_px, 0.0
        while abs(usual - before) > 1e-4 * usual:
            usual, before = best_gaussian_px(self.psf(self.corner_px / math.sqrt(3)), 2 * usual + 1), usual
        fwhm = best_gaussian_px(self.psf(radius_px), 2 * usual + 1)
        airy = 1.029 * 0.55e-6 / self.aperture_m * self.focal_m / self.pitch_m
        return math.sqrt(fwhm**2 - airy**2)


def best_gaussian_px(profile, window_px):
    """FWHM of the Gaussian, over pixels, that fits a drawn star within a radius: the mean of some places of the star in its pixel."""
    widths = []
    for x, y in ((0.0, 0.0), (0.5, 0.0), (0.25, 0.25), (0.5, 0.5)):
        drawn = profile.drawImage(nx=49, ny=49, scale=1.0, offset=(x, y)).array
        at = np.arange(49) - 24.0
        weight = (at[None, :] - x)**2 + (at[:, None] - y)**2 <= window_px**2

        def misfit(p, drawn=drawn, at=at, weight=weight, x=x, y=y):
            cells = [erf_cells(at - c, p[1]) for c in (x, y)]
            return ((p[0] * cells[1][:, None] * cells[0][None, :] + p[2] - drawn) * weight).ravel()
        widths.append(optimize.least_squares(misfit, [1.0, profile.fwhm / FWHM_PER_SIGMA, 0.0]).x[1] * FWHM_PER_SIGMA)
    return float(np.mean(widths))


def erf_cells(at, sigma):
    """Shares of pixels at distances from a Gaussian's middle."""
    edges = np.array([math.erf(t / (sigma * math.sqrt(2))) / 2 for t in np.append(at - 0.5, at[-1] + 0.5)])
    return np.diff(edges)


def random_camera(rng):
    """A rotation from the sky to a camera that points anywhere."""
    q, r = np.linalg.qr(rng.standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q
