#!/usr/bin/env python3
"""Writes galsim_psf.inc: pixel-integrated PSF images by GalSim (pip install galsim) for
tests/optics/test_galsim.cpp. Cells of half lambda/D (Airy) and of a third of the seeing's FWHM
(Kolmogorov), 21 x 21, fluxes before any scaling."""
import galsim

LAMBDA_M, DIAMETER_M, R0_M = 0.55e-6, 0.3, 0.1
SIDE = 21
PRECISE = galsim.GSParams(folding_threshold=1e-4, maxk_threshold=1e-5, maximum_fft_size=16384)


def show(name, profile, cell_rad):
    image = profile.drawImage(nx=SIDE, ny=SIDE, scale=cell_rad,
                              method="auto", dtype=float)
    values = ", ".join(f"{v:.9e}" for v in image.array.ravel())
    print(f"constexpr double {name}[] = {{{values}}};")


cell = 0.5 * LAMBDA_M / DIAMETER_M
unit = LAMBDA_M / DIAMETER_M  # radians: GalSim's lengths carry the unit that we give them
show("galsim_airy", galsim.Airy(lam_over_diam=unit, gsparams=PRECISE), cell)
show("galsim_obscured_airy", galsim.Airy(lam_over_diam=unit, obscuration=0.4, gsparams=PRECISE), cell)
show("galsim_kolmogorov", galsim.Kolmogorov(lam_over_r0=LAMBDA_M / R0_M, gsparams=PRECISE),
     0.325 * LAMBDA_M / R0_M)
