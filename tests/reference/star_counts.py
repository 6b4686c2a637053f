"""Counts of stars by others, and the table of core/sky/stars/star_counts.cpp that is made of them.

    star_counts.py DEEPSTARS           figures for tests/sky/test_star_counts.cpp
    star_counts.py DEEPSTARS --table   core/sky/stars/star_counts_table.inc

DEEPSTARS: KStars' deepstars.dat, which holds Tycho-2. Bahcall & Soneira 1980, ApJS 44, 73: the fit of appendix B in V, for |b| >= 20 deg,
within 15 % of their model. Whole sky: Tycho-2 with UCAC4 to V = 16 (hnsky.org/star_count.htm; the magnitudes of UCAC4 are redder than V
by some 0.3), USNO-B1.0 (Monet et al. 2003, AJ 125, 984), 1,042,618,261 objects to V = 21.
"""

import sys

import numpy as np

SKY_DEG2 = 4 * np.pi * np.degrees(1) ** 2
WHOLE_SKY = {12: 2955951, 13: 7346735, 14: 17214116, 15: 39387795, 16: 88896114, 21: 1042618261}
LATITUDES = np.array([0, 5, 10, 20, 30, 45, 60, 90.0])
LONGITUDES = np.arange(2.5, 360, 5)
GALACTIC = np.array([[-0.0548755604, -0.8734370902, -0.4838350155], [0.4941094279, -0.4448296300, 0.7469822445],
                     [-0.8676661490, -0.1980763734, 0.4559837762]])
# By how much log N rises from |b| = 20 deg to the plane, at V = 9, 10, ... 21: as Tycho-2 has it to V = 11, then between it and USNO-B1.0.
RISE = [0.29, 0.31, 0.35, 0.43, 0.52, 0.61, 0.69, 0.74, 0.77, 0.78, 0.77, 0.75, 0.73]


def bahcall_soneira(v_mag, l_deg, b_deg):
    l, b = np.radians(l_deg), np.radians(np.abs(b_deg))
    mu, gamma = np.clip(0.0075 * (v_mag - 12) + 0.03, 0.03, 0.09), np.clip(0.04 * (12 - v_mag) + 0.36, 0.04, 0.36)
    disc = 925 * 10 ** (0.035 * (v_mag - 15.75)) / (1 + 10 ** (-0.132 * (v_mag - 15.75))) ** 3
    disc = disc / (np.sin(b) * (1 - mu / np.tan(b) * np.cos(l))) ** (3 - 5 * gamma)
    towards = np.cos(b) * np.cos(l)
    halo = 1050 * 10 ** (0.087 * (v_mag - 17.5)) / (1 + 10 ** (-0.18 * (v_mag - 17.5))) ** 2.5
    return disc + halo / (1 - towards) ** (1.45 - 0.2 * towards)


def read_tycho2(path):
    """Sine of the galactic latitude, and V."""
    fields = [(name, "<i4") for name in ("ra", "dec", "pm_ra", "pm_dec", "plx", "hd")] + [("mag", "<i2"), ("bv", "<i2"), ("rest", "V4")]
    deep = np.fromfile(path, np.dtype(fields), offset=309 + 512 * 12 + 5)
    ra, dec = np.radians(deep["ra"] * 15e-6), np.radians(deep["dec"] * 1e-5)
    sine = GALACTIC[2] @ np.array([np.cos(ra) * np.cos(dec), np.sin(ra) * np.cos(dec), np.sin(dec)])
    return np.abs(sine), deep["mag"] * 1e-2 - 0.09 * deep["bv"] * 1e-2


def tycho2_per_deg2(tycho2, v_mag, b_deg):
    sine, v = tycho2
    half = 2 if b_deg < 45 else 4
    low, high = (75, 90) if b_deg == 90 else (max(0, b_deg - half), b_deg + half)
    low, high = np.sin(np.radians([low, high]))
    return np.sum((v < v_mag) & (sine >= low) & (sine < high)) / (SKY_DEG2 * (high - low))


def log_mean(v_mag, b_deg):
    return float(np.log10(np.mean(bahcall_soneira(v_mag, LONGITUDES, b_deg))))


def table(tycho2):
    rows = []
    for v_mag, rise in zip(range(9, 22), RISE):
        high = []
        for b in LATITUDES[3:]:
            if v_mag > 11:  # the fit, with what Tycho-2 has more, to V = 16
                more = np.log10(tycho2_per_deg2(tycho2, 11, b)) - log_mean(11, b)
                high.append(log_mean(v_mag, b) + np.interp(v_mag, [11, 16], [more, 0]))
            else:  # deepstars.dat lacks some stars of V = 9
                high.append(np.log10(tycho2_per_deg2(tycho2, max(v_mag, 10), b)) -
                            (v_mag < 10) * np.interp(b, [20, 90], [0.49, 0.47]))
        rows.append(np.concatenate([high[0] + rise * (1 - LATITUDES[:3] / 20), high]))
    return rows


def main():
    tycho2 = read_tycho2(sys.argv[1])
    if sys.argv[2:] == ["--table"]:
        for row in table(tycho2):
            print("    {" + ", ".join(f"{x:.3f}" for x in row) + "},")
        return
    for b in (5, 30, 90):
        print(f"Tycho-2, |b| = {b}, V < 11: {tycho2_per_deg2(tycho2, 11, b):.2f} a square degree")
    for l, b in ((90, 30), (180, 45), (0, 60), (0, 90)):
        print(f"Bahcall & Soneira, l = {l}, b = {b}:", {m: round(float(bahcall_soneira(m, l, b)), 1) for m in (16, 18, 20, 21)})
    for v_mag, stars in WHOLE_SKY.items():
        print(f"whole sky, V < {v_mag}: {stars / SKY_DEG2:.2f} a square degree")


if __name__ == "__main__":
    main()
