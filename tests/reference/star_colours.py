#!/usr/bin/python3
"""Reference for tests/photometry/test_star_light.cpp: photon rate of a black body in the 0.50-0.60 um and
0.80-0.90 um top hats relative to 0.50-0.51 um, by scipy's quadrature of astropy's Planck law."""
from astropy import units as u
from astropy.modeling.models import BlackBody
from scipy.integrate import quad

for kelvin in (3500, 5778, 20000):
    planck = BlackBody(temperature=kelvin * u.K, scale=1 * u.W / (u.m**2 * u.um * u.sr))
    photons = lambda x: planck(x * u.um).value * x
    rate = lambda a, b: quad(photons, a, b, epsrel=1e-10)[0]
    print(kelvin, rate(0.5, 0.6) / rate(0.5, 0.51), rate(0.8, 0.9) / rate(0.5, 0.51))
