#!/usr/bin/env python3
"""Writes tests/sky/day_sky_reference.inc: radiance of the day sky over the Sun's irradiance [1/sr] by PythonicDISORT,
for plane layers with the standard air, haze and ozone of core/sky/day_sky.h. Usage, after
`pip install PythonicDISORT`: day_sky.py > tests/sky/day_sky_reference.inc"""
import numpy as np
from PythonicDISORT.pydisort import pydisort
from PythonicDISORT.subroutines import interpolate

STREAMS, MOMENTS = 32, 700
LEVELS_M = np.concatenate([np.arange(0, 12e3, 750), np.arange(12e3, 30e3, 2e3), np.arange(30e3, 61e3, 10e3)])
HENYEY_GREENSTEIN = [(0.056, 0.966), (0.923, 0.638), (0.021, -0.637)]
# Wavelength [um], ozone [1/atm-cm], haze at 550 nm, ground albedo.
AIRS = [(0.40, 0.0, 0.2, 0.2), (0.55, 0.085, 0.2, 0.2), (1.25, 0.0, 0.2, 0.2), (0.45, 0.003, 0.6, 0.7)]
SUNS_DEG = [70, 50, 35, 20, 12]
DIRECTIONS_DEG = [(85, 90), (75, 180), (60, 45), (60, 180), (45, 90), (30, 30), (30, 135), (20, 180), (15, 90)]  # altitude, azimuth


def pressure(height_m):
    """U.S. Standard Atmosphere 1976 to 47 km, over that at the sea."""
    h = 6356766 * height_m / (6356766 + height_m)
    p, last, temperature = 1.0, 0.0, 288.15
    for top, lapse in ((11e3, -6.5e-3), (20e3, 0.0), (32e3, 1e-3), (47e3, 2.8e-3), (1e9, 0.0)):
        rise = min(h, top) - last
        if lapse:
            p *= (1 + lapse * rise / temperature) ** (-0.0341632 / lapse)
        else:
            p *= np.exp(-0.0341632 * rise / temperature)
        temperature += lapse * rise
        last = top
        if h <= top:
            return p
    return p


def layers(wavelength_um, ozone, haze, _):
    """Depths of molecules, haze and ozone in layers, from the top down."""
    air = np.array([pressure(z) for z in LEVELS_M])
    s = wavelength_um ** -2
    rayleigh = 0.008569 * s * s * (1 + 0.0113 * s + 0.00013 * s * s) * -np.diff(air)
    of_haze = haze * (wavelength_um / 0.55) ** -1.3 * -np.diff(np.exp(-LEVELS_M / 2000))
    z = np.linspace(0, LEVELS_M[-1], 60001)
    gauss = 0.3 * np.exp(-0.5 * ((z - 22e3) / 5e3) ** 2) / (5e3 * np.sqrt(2 * np.pi))
    column = np.concatenate([[0], np.cumsum(0.5 * (gauss[1:] + gauss[:-1]) * np.diff(z))])
    of_ozone = ozone * np.diff(np.interp(LEVELS_M, z, column))
    return rayleigh[::-1], of_haze[::-1], of_ozone[::-1]


def radiances(air, sun_deg):
    rayleigh, haze, ozone = layers(*air)
    l = np.arange(MOMENTS)
    haze_moments = sum(share * g ** l for share, g in HENYEY_GREENSTEIN)
    molecules = np.where(l == 0, 1.0, np.where(l == 2, 0.1, 0.0))
    scattering = rayleigh + 0.94 * haze
    moments = (rayleigh[:, None] * molecules + 0.94 * haze[:, None] * haze_moments) / scattering[:, None]
    extinction = rayleigh + haze + ozone
    mu, _, _, _, light = pydisort(np.cumsum(extinction), scattering / extinction, STREAMS, moments,
                                  np.sin(np.radians(sun_deg)), 1.0, 0.0, NLeg=STREAMS, NFourier=STREAMS,
                                  f_arr=moments[:, STREAMS], NT_cor=True, BDRF_Fourier_modes=[air[3]])[:5]
    at = interpolate(light, NT_cor="eval")
    bottom = np.sum(extinction)
    return [float(np.squeeze(at(-np.sin(np.radians(alt)), bottom, np.radians(az)))) for alt, az in DIRECTIONS_DEG]


def main():
    print("// Made by tests/reference/day_sky.py with PythonicDISORT 1.8, 32 streams, delta-M and Nakajima-Tanaka\n"
          "// corrections. {wavelength [um], haze at 550 nm, ground albedo, altitude of the Sun, altitude and azimuth\n"
          "// from the Sun [deg], radiance over the Sun's irradiance [1/sr]}")
    for air in AIRS:
        for sun in SUNS_DEG:
            for (alt, az), value in zip(DIRECTIONS_DEG, radiances(air, sun)):
                print(f"{{{air[0]}, {air[2]}, {air[3]}, {{{sun}, {alt}, {az}}}, {value:.6g}}},")


if __name__ == "__main__":
    main()
