#!/usr/bin/env python3
"""Fits three terms of Henyey & Greenstein to the phase function of the rural aerosol of Shettle & Fenn 1979
(AFGL-TR-79-0214) by Mie's theory, for core/sky/air/haze.cpp. Prints scattering albedo, asymmetry and extinction by
wavelength, then the terms and their errors. Usage, after `pip install miepython`: haze_phase.py"""
import miepython
import numpy as np
from scipy.optimize import least_squares

INDEX = complex(1.53, -0.0066)
MODES = [(0.999875, 0.027, 0.35), (0.000125, 0.43, 0.40)]  # share of particles, radius [um], deviation of log10
WAVELENGTHS_UM = [0.45, 0.55, 0.85, 1.25, 1.65, 2.2]
ANGLES_DEG = np.concatenate([np.arange(0, 5, 0.25), np.arange(5, 181, 1.0)])
COSINES = np.cos(np.radians(ANGLES_DEG))


def aerosol(wavelength_um):
    """Extinction, scattering albedo, asymmetry and phase function."""
    radius = np.exp(np.linspace(np.log(0.003), np.log(25), 220))
    number = sum(n / s * np.exp(-0.5 * (np.log10(radius / r) / s) ** 2) for n, r, s in MODES)
    extinction = scattering = forward = 0.0
    phase = np.zeros(len(COSINES))
    for r, n in zip(radius, number):
        size = 2 * np.pi * r / wavelength_um
        out, scattered, _, asymmetry = miepython.efficiencies_mx(INDEX, size)
        area = np.pi * r * r * n
        extinction += area * out
        scattering += area * scattered
        forward += area * scattered * asymmetry
        phase += area * scattered * miepython.i_unpolarized(INDEX, size, COSINES, norm="4pi")
    return extinction, scattering / extinction, forward / scattering, phase / scattering


def main():
    phases = []
    for wavelength_um in WAVELENGTHS_UM:
        extinction, albedo, asymmetry, phase = aerosol(wavelength_um)
        phases.append(phase)
        print(f"{wavelength_um} um: extinction {extinction:.4g}, albedo {albedo:.3f}, asymmetry {asymmetry:.3f}")
    mean = np.exp(np.mean(np.log(phases[:5]), axis=0))

    def terms(parameters):
        shares = np.exp(np.append(parameters[:2], 0.0))
        return shares / shares.sum(), np.tanh(parameters[2:])

    def model(parameters):
        return sum(f * (1 - g * g) / (1 + g * g - 2 * g * COSINES) ** 1.5 for f, g in zip(*terms(parameters)))

    start = np.concatenate([np.zeros(2), np.arctanh([0.93, 0.6, -0.4])])
    fit = least_squares(lambda p: np.log(model(p) / mean), start).x
    print("shares and asymmetries:", *(np.round(t, 3) for t in terms(fit)))
    print(f"rms of the mean: {np.std(np.log(model(fit) / mean)):.3f}")
    for wavelength_um, phase in zip(WAVELENGTHS_UM, phases):
        print(f"{wavelength_um} um: {np.std(np.log(model(fit) / phase)[ANGLES_DEG >= 1]):.3f} from 1 deg on")


if __name__ == "__main__":
    main()
