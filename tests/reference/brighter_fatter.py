#!/usr/bin/env python3
"""Growth of spots with their light by GalSim's silicon sensor (photons that are shot one by one into pixels whose boundaries are
solutions of Poisson's equation for an ITL detector of LSST): the figures of tests/detector/test_brighter_fatter.cpp. Prints the
slope of the second moments [px^2] with the charge of the brightest pixel, with its error, for Gaussians of several widths."""
import galsim
import numpy as np

SIZE, PEAK_E, SEEDS = 25, 8e4, 24
Y, X = np.mgrid[:SIZE, :SIZE] - SIZE // 2


def moments(fwhm_px, flux, seed, silicon):
    rng = galsim.BaseDeviate(seed)
    sensor = galsim.SiliconSensor(name="lsst_itl_8", rng=rng, diffusion_factor=0.0) if silicon else None
    image = galsim.ImageD(SIZE, SIZE, scale=1.0)
    galsim.Gaussian(fwhm=fwhm_px, flux=flux).drawImage(image=image, method="phot", rng=rng, poisson_flux=False, sensor=sensor)
    total = image.array.sum()
    return np.array([(image.array * X * X).sum() / total, (image.array * Y * Y).sum() / total]), image.array.max()


if __name__ == "__main__":
    for fwhm_px in (2.0, 3.0, 4.0, 6.0):
        peak = galsim.Gaussian(fwhm=fwhm_px, flux=1.0).drawImage(nx=SIZE, ny=SIZE, scale=1.0).array.max()
        flux = PEAK_E / peak
        grown = np.array([moments(fwhm_px, flux, seed, True)[0] - moments(fwhm_px, flux, seed + 1000, False)[0] for seed in range(1, SEEDS + 1)])
        mean, error = grown.mean(0) / PEAK_E, grown.std(0) / np.sqrt(SEEDS) / PEAK_E
        print(f"{fwhm_px}: peak share {peak:.6f}, x {mean[0]:.3e} +- {error[0]:.1e}, y {mean[1]:.3e} +- {error[1]:.1e} px^2/e-")
