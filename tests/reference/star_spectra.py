#!/usr/bin/python3
"""Prints core/photometry/star_spectrum_table.inc: by what a black body of a star's colour temperature is
multiplied, at eight wavelengths, so that the star has the colours of real ones of its B-V; for red dwarfs, and for
stars of type M, in tables of their own.

    star_spectra.py FILTERS VEGA         (folders of filter curves in ECSV, CALSPEC's Vega [nm])
    star_spectra.py FILTERS VEGA --check NLANDOLT BSC5

--check prints median colours of Landolt's standards (nlandolt.dat of IRAF's noao package) and of the Yale
Bright Star Catalogue, for tests/photometry/test_star_spectrum.cpp.
"""
import gzip
import sys

import numpy as np

# B-V, U-B, V-R, V-I, V-K, J-H, H-K. To B-V = 0.95 dwarfs: Pecaut & Mamajek 2013, ApJS 208, 9, table 5, as of 2024;
# from 1.16 giants, for among stars as red as that nearly all bright ones are: V-R and V-I by eye through Landolt's
# standards of V < 12 and their U-B (Landolt 1992, AJ 104, 340), U-B from the Yale Bright Star Catalogue, the
# infrared as dwarfs of the same V-I have it.
COLOURS = np.array([
    (-0.289, -1.030, -0.118, -0.338, -0.913, -0.153, -0.063),
    (-0.278, -0.995, -0.115, -0.325, -0.874, -0.148, -0.059),
    (-0.215, -0.790, -0.094, -0.230, -0.602, -0.113, -0.032),
    (-0.178, -0.673, -0.080, -0.192, -0.492, -0.098, -0.021),
    (-0.156, -0.581, -0.070, -0.165, -0.380, -0.084, -0.010),
    (-0.128, -0.459, -0.058, -0.133, -0.325, -0.077, -0.004),
    (-0.109, -0.364, -0.048, -0.108, -0.254, -0.067, 0.003),
    (-0.070, -0.200, -0.028, -0.061, -0.121, -0.050, 0.016),
    (0.000, -0.005, 0.001, 0.004, 0.041, -0.032, 0.028),
    (0.035, 0.033, 0.019, 0.044, 0.090, -0.025, 0.030),
    (0.100, 0.077, 0.050, 0.108, 0.253, 0.003, 0.035),
    (0.160, 0.100, 0.089, 0.186, 0.403, 0.031, 0.038),
    (0.210, 0.091, 0.117, 0.242, 0.528, 0.055, 0.040),
    (0.295, 0.053, 0.166, 0.339, 0.734, 0.096, 0.045),
    (0.370, -0.008, 0.213, 0.432, 0.925, 0.140, 0.050),
    (0.440, -0.029, 0.252, 0.506, 1.079, 0.173, 0.054),
    (0.530, 0.001, 0.300, 0.599, 1.290, 0.225, 0.061),
    (0.595, 0.057, 0.341, 0.673, 1.437, 0.262, 0.067),
    (0.650, 0.133, 0.363, 0.713, 1.564, 0.293, 0.073),
    (0.680, 0.185, 0.377, 0.738, 1.635, 0.310, 0.076),
    (0.730, 0.284, 0.404, 0.786, 1.768, 0.342, 0.082),
    (0.816, 0.436, 0.443, 0.853, 1.953, 0.387, 0.091),
    (0.884, 0.581, 0.482, 0.920, 2.130, 0.427, 0.098),
    (0.950, 0.700, 0.520, 0.980, 2.250, 0.465, 0.105),
    (1.160, 1.130, 0.610, 1.140, 2.600, 0.530, 0.120),
    (1.300, 1.420, 0.695, 1.320, 2.940, 0.580, 0.136),
    (1.400, 1.600, 0.748, 1.420, 3.080, 0.601, 0.148),
    (1.500, 1.790, 0.805, 1.530, 3.370, 0.620, 0.165),
    (1.600, 1.920, 0.875, 1.710, 3.570, 0.631, 0.181),
    (1.700, 1.950, 0.945, 1.820, 3.740, 0.624, 0.199),
    (1.800, 1.960, 1.010, 1.940, 3.910, 0.617, 0.215),
    (1.900, 1.970, 1.090, 2.110, 4.130, 0.607, 0.229),
    (2.000, 2.000, 1.165, 2.280, 4.390, 0.592, 0.242),
])
# Dwarfs from there on: Pecaut & Mamajek 2013, as of 2024. Beyond M6 they grow no redder in B-V.
RED_DWARFS = np.array([
    (0.938, 0.691, 0.513, 0.974, 2.274, 0.459, 0.104),
    (0.986, 0.776, 0.537, 1.013, 2.380, 0.483, 0.109),
    (1.050, 0.917, 0.592, 1.108, 2.582, 0.520, 0.118),
    (1.100, 1.004, 0.640, 1.190, 2.733, 0.544, 0.125),
    (1.150, 1.081, 0.685, 1.272, 2.883, 0.568, 0.132),
    (1.240, 1.184, 0.759, 1.420, 3.143, 0.601, 0.148),
    (1.330, 1.221, 0.806, 1.529, 3.330, 0.617, 0.162),
    (1.408, 1.204, 0.889, 1.766, 3.680, 0.626, 0.193),
    (1.475, 1.172, 0.959, 2.019, 4.020, 0.613, 0.225),
    (1.500, 1.170, 1.001, 2.173, 4.240, 0.600, 0.234),
    (1.544, 1.181, 1.079, 2.420, 4.600, 0.579, 0.252),
    (1.602, 1.200, 1.178, 2.680, 5.000, 0.558, 0.269),
    (1.661, 1.222, 1.241, 2.831, 5.250, 0.557, 0.282),
    (1.720, 1.230, 1.345, 3.073, 5.640, 0.564, 0.301),
    (1.874, 1.240, 1.446, 3.277, 5.940, 0.580, 0.311),
    (2.000, 1.300, 1.950, 4.130, 7.300, 0.605, 0.352),
])
# Giants M0 to M7: B-V and U-B are medians of the Yale Bright Star Catalogue (72 to 10 giants), V-R that of dwarfs of the
# V-I, the rest of Bessell & Brett 1988, PASP 100, 1134; V-I of M6 and M7 by steps of theirs in V-K.
M_GIANTS = np.array([
    (1.585, 1.945, 0.893, 1.780, 3.850, 0.830, 0.190),
    (1.630, 1.950, 0.926, 1.900, 4.050, 0.850, 0.205),
    (1.640, 1.930, 0.967, 2.050, 4.300, 0.870, 0.215),
    (1.640, 1.880, 1.025, 2.250, 4.640, 0.900, 0.235),
    (1.600, 1.710, 1.128, 2.550, 5.100, 0.930, 0.245),
    (1.580, 1.485, 1.334, 3.050, 5.960, 0.950, 0.285),
    (1.475, 1.120, 1.557, 3.500, 6.840, 0.960, 0.300),
    (1.590, 0.385, 1.800, 3.950, 7.800, 0.960, 0.310),
])
NODES_NM = np.array([360, 440, 550, 650, 800, 1235, 1662, 2159.0])
VEGA = {"U": 0.024, "B": 0.03, "V": 0.03, "R": 0.03, "I": 0.03}
# Cohen, Wheaton & Megeath 2003, AJ 126, 1090: the flux of magnitude 0 in J, H, Ks [Jy].
INFRARED_JY = np.array([1594.0, 1024.0, 666.7])
H_J_S, C_M_PER_S, K_J_PER_K = 6.62607015e-34, 299792458.0, 1.380649e-23


def filters(folder):
    """Photon responses of a peak of 1, on a grid of 1 nm."""
    responses = {}
    for name in "UBVRI":
        rows = np.array([line.split() for line in open(f"{folder}/bessell-{name}.ecsv") if line[0].isdigit()], float)
        grid = np.arange(rows[0, 0] / 10, rows[-1, 0] / 10 + 0.5, 1.0)
        response = np.interp(grid, rows[:, 0] / 10, rows[:, 1] / rows[:, 0])
        responses[name] = grid, response / (rows[:, 1] / rows[:, 0]).max()
    return responses


def photons(grid_nm, irradiance_w_m2_nm, response):
    rate = irradiance_w_m2_nm * grid_nm * 1e-9 / (H_J_S * C_M_PER_S) * response
    return float(np.sum((rate[1:] + rate[:-1]) / 2 * np.diff(grid_nm)))


def temperature(bv):
    return 4600 * (1 / (0.92 * bv + 1.7) + 1 / (0.92 * bv + 0.62))


def planck(nm, kelvin):
    return 1e13 / nm**5 / np.expm1(H_J_S * C_M_PER_S / (nm * 1e-9 * K_J_PER_K * kelvin))


class Bands:
    def __init__(self, folder, vega):
        self.responses = filters(folder)
        rows = np.array([line.split()[:2] for line in open(vega) if line.strip() and line[0] != "#"], float)
        self.zero = {}
        for name, (grid, response) in self.responses.items():
            irradiance = np.interp(grid, rows[:, 0], rows[:, 1]) * 1e-3  # erg/s/cm2/nm
            self.zero[name] = photons(grid, irradiance, response) * 10 ** (0.4 * VEGA[name])

    def magnitudes(self, kelvin, factors):
        """U, B, V, R, I, J, H, K of a black body times the factors."""
        out = []
        for name, (grid, response) in self.responses.items():
            spectrum = planck(grid, kelvin) * np.interp(grid, NODES_NM, factors)
            out.append(-2.5 * np.log10(photons(grid, spectrum, response) / self.zero[name]))
        nm = NODES_NM[5:]
        irradiance = planck(nm, kelvin) * factors[5:]  # W/m2/nm
        zero = INFRARED_JY * 1e-26 * C_M_PER_S / (nm * 1e-9) ** 2 * 1e-9
        return np.array(out + list(-2.5 * np.log10(irradiance / zero)))


def wanted(colours):
    """U, B, R, I, J, H, K less V."""
    bv, ub, vr, vi, vk, jh, hk = colours
    return np.array([ub + bv, bv, -vr, -vi, -(vk - jh - hk), -(vk - hk), -vk])


def factors_of(bands, colours, kelvin=None):
    factors = np.ones(8)
    want = wanted(colours)
    for _ in range(200):
        m = bands.magnitudes(kelvin or temperature(colours[0]), factors)
        left = np.delete(m, 2) - m[2] - want
        factors[[0, 1, 3, 4, 5, 6, 7]] *= 10 ** (0.4 * 0.7 * left)
    assert np.abs(left).max() < 1e-6, left
    return factors / factors.max()


def check(landolt, bsc5):
    stars = []
    for line in open(landolt):
        try:
            stars.append([float(field) for field in line.split()[3:9]])
        except ValueError:
            pass
    stars = np.array([star for star in stars if len(star) == 6])
    print("// Landolt: B-V, V-R, V-I, number")
    for bv in (-0.25, -0.15, 0.2, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0):
        near = stars[(abs(stars[:, 1] - bv) < 0.05)]
        print(f"{{{bv}, {np.median(near[:, 3]):.3f}, {np.median(near[:, 5]):.3f}}},  // {len(near)}")
    colours = []
    for line in gzip.open(bsc5, "rt", encoding="latin-1"):
        try:
            colours.append((float(line[109:114]), float(line[115:120])))
        except ValueError:
            pass
    colours = np.array(colours)
    print("// Yale Bright Star Catalogue: B-V, U-B, number")
    for bv in (-0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7):
        near = colours[abs(colours[:, 0] - bv) < 0.03]
        print(f"{{{bv}, {np.median(near[:, 1]):.2f}}},  // {len(near)}")


def main():
    bands = Bands(*sys.argv[1:3])
    if sys.argv[3:4] == ["--check"]:
        print({name: f"{zero:.4g}" for name, zero in bands.zero.items()}, "photons/s/m2 of magnitude 0")
        check(*sys.argv[4:6])
        return
    print("// Made by tests/reference/star_spectra.py: factors at the nodes, by B-V from -0.3, 0.05 apart.")
    print("constexpr double nodes_nm[] = {" + ", ".join(f"{nm:g}" for nm in NODES_NM) + "};")
    print("constexpr double factors_of_colour[][std::size(nodes_nm)] = {")
    for bv in np.arange(-6, 41) / 20:
        colours = [bv] + [np.interp(bv, COLOURS[:, 0], COLOURS[:, i]) for i in range(1, 7)]
        print("    {" + ", ".join(f"{f:.4f}" for f in factors_of(bands, colours)) + "},")
    print("};")
    print("// Of dwarfs, by B-V from 0.95, 0.05 apart.")
    print("constexpr double factors_of_red_dwarf[][std::size(nodes_nm)] = {")
    for bv in np.arange(19, 41) / 20:
        colours = [bv] + [np.interp(bv, RED_DWARFS[:, 0], RED_DWARFS[:, i]) for i in range(1, 7)]
        print("    {" + ", ".join(f"{f:.4f}" for f in factors_of(bands, colours)) + "},")
    print("};")
    m_dwarfs = RED_DWARFS[np.searchsorted(RED_DWARFS[:, 0], (1.408, 1.475, 1.5, 1.544, 1.661, 1.874))]
    for name, stars in ("giant", M_GIANTS), ("dwarf", m_dwarfs):
        print(f"// Of {name}s M0 to M{len(stars) - 1}, of black bodies of 3500 K.")
        print(f"constexpr double factors_of_m_{name}[][std::size(nodes_nm)] = {{")
        for colours in stars:
            print("    {" + ", ".join(f"{f:.4f}" for f in factors_of(bands, colours, 3500.0)) + "},")
        print("};")


main()
