"""The text of docs/paper.md from what make.py found."""

TABLE_1 = [
    ("Simulation", "`simulation: {start, duration_s, tick_s, seed, earth_orientation, ellipsoid: WGS84 \\| WGS72 \\| GRS80 \\| {a_m, f}, "
     "origin: {latitude_deg, longitude_deg, height_m}}`; `motion: {enu}`, `pointing: {enu}`, `output: {positions_frame: enu}`",
     "as GeographicLib's `LocalCartesian` to 1e-8 m near the ground"),
    ("Star Background", "`stars: {catalogue: kstars \\| HYG \\| BSC5, faintest_mag}`; effects `proper_motion`, `parallax`, `annual_aberration`",
     "places equal astropy's to 0.2 mas"),
    ("Sky", "`sky: {preset, zenith_mag_per_arcsec2, lamps, cities, parts}`; effects `twilight`, `scattered_moonlight`, ...",
     "each part is switched by itself"),
    ("Platform", "`objects: [{name, motion, attitude, panel, geometry: {obj \\| model}}]`", "OBJ and MTL; SGP4, two bodies, OEM, tracks, motions in ENU"),
    ("Atmosphere", "`atmosphere: {extinction, refraction, turbulence}`, `weather`, `seeing`", ""),
    ("Beer's Law", "`atmosphere: {extinction: SITE \\| K}`", "0.2 % of the integral to an airmass of 3"),
    ("Camera", "`sensors: [{site \\| platform, camera, pointing}]`; `pointing: {body: {boresight, up}}` is the body-mounted one",
     "a free camera is aboard an object with a motion of its own: eye `motion: {enu: {position_m, velocity_m_per_s \\| track}}`, look and up "
     "`pointing: {enu: {look \\| look_at_m, up}}`"),
    ("Sun", "`core/sky/places/sun_moon`", "0.01 deg of the Almanac's formula"),
]


def figure(name, words):
    return f"![{words}](paper/{name})\n"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def table_3(found):
    figures = found["table3"]["figures"]
    rows = []
    for material, paper, laboratory in (("silicon", "13.66 +- 1.16", 15.6), ("germanium", "0.926 +- 0.076", 1.0)):
        of = {key: figures[f"table3_{material}_{key}"] for key in ("bias_sigma", "ratio", "scatter", "scatter_of_ratio", "z_width", "snr_r")}
        error = of["scatter"]["value"] / 200**0.5
        rows.append((material, laboratory, paper, f"{of['ratio']['value']:.4g} +- {error:.2g}", f"{of['bias_sigma']['value']:.1f}",
                     f"{of['scatter']['value']:.3g}", f"{of['scatter']['anchor_value']:.3g}",
                     f"{100 * of['scatter_of_ratio']['value']:.1f} % ({100 * of['scatter_of_ratio']['anchor_value']:.1f} %)",
                     f"{of['z_width']['value']:.2f}", f"{of['snr_r']['value']:.1f}"))
    return table(("material", "laboratory", "the paper", "ours, mean of 200 seeds", "bias, standard errors", "scatter", "noise theory",
                  "relative (the paper's)", "width of z", "SNR in R"), rows)


def bias(three, material):
    """The bias by 40,000 seeds, and by the expected light."""
    many, quiet = (three["figures"][f"table3_{material}_{key}"] for key in ("bias_percent", "bias_without_noise_percent"))
    return f"{many['value']:+.3f} +- {many['anchor_value']:.3f} % off (without noise {quiet['value']:+.3f} %)"


def seconds(value):
    return "never" if value is None else f"{value:.3g}"


def nearest_in_order(solutions):
    if not solutions:
        return "No combination has R between them."
    s = solutions[0]
    return (f"The nearest with R between them is B {s['B']:.2f}, R {s['R']:.2f}, G {s['G']:.2f} (V = {s['magnitude']:.1f}, lamps {s['lps']:g}, "
            f"{s['hps']:g}, {s['led']:g}, {s['exposure_s']:.2g} s).")


def text(found):
    five, six, seven, eight, nine, ten = (found[f"figure{k}"] for k in range(5, 11))
    three = found["table3"]
    contrast = eight["contrast"]
    best = seven["best"][0]
    parts = [
        "# The paper's results beside ours\n",
        "`./dmise paper` runs `launch/scenarios/paper/*.yaml` and writes this page: Figures 5 to 10 and Tables 1 to 3 of *DMISE-assisted "
        "design of future sensor networks in support of Space Traffic Management* (AMOS 2021).\n",
        "## Table 1: actors\n",
        table(("actor", "key", "note"), TABLE_1),
        "## Table 2: OMNISSA\n",
        table(("", "the paper", "`camera: omnissa`"), [
            ("field, deg", 90, "90.00 across the columns"), ("aperture, m", 0.0375, "0.0375"), ("wavelength, um", 0.55, "0.55"),
            ("bandwidth, um", 0.128, "0.128"), ("exposure, s", 20, 20), ("pixels", "3326 x 2504", "3326 x 2504"), ("pixel, um", 5.4, "5.4")]),
        "These mean a focal length of 8.98 mm and a focal ratio of 0.24, which no lens has: the aperture is a collecting area "
        "(`equivalent_aperture`).\n",
        "## Figure 5: ranges over Atlanta\n",
        "![Range against time of sunlit objects in the field](gallery/figure5.svg)\n",
        f"{five['catalogue']}, over a day: {five['passes']:,} partly sunlit passes of {five['objects']:,} objects. The paper plots 17,356 objects "
        "of a catalogue that it does not date; as there, most are in low orbits "
        f"({100 * five['low_share']:.0f} % of the passes). Equal to a test of every object at every instant ([visibility](models/visibility.md)).\n",
        "Objects in the field, and those of them that are sunlit, by `dmise visible` (counts.csv), by python3-skyfield and by astropy "
        "(`tests/reference/figure5_counts.py`). In doubt: objects within 0.01 deg of an edge of the frame or of the shadow.\n",
        table(("UTC", "in the field", "skyfield", "astropy", "in doubt", "sunlit", "skyfield", "astropy", "in doubt"), [
            (r["time_utc"][11:19], r["dmise"][0], r["skyfield"][0], r["astropy"][0], r["skyfield"][1],
             r["dmise"][1], r["skyfield"][2], r["astropy"][2], r["skyfield"][3]) for r in five["counts"]]),
        "## Figure 6: a streak of 20 s\n",
        figure("figure6.png", "COSMOS 2519 and trails of stars"),
        f"COSMOS 2519 at V = {six['magnitude']:.2f}, {six['range_km']:.0f} km away at {six['elevation_deg']:.0f} deg of elevation: a streak of "
        f"{six['length_px']:.0f} px and {six['signal_e']:.3g} electrons. The paper shows the picture alone; its time and pass are not given, so the "
        "length cannot be compared. On the dates of the element set the object is in the Earth's shadow over Atlanta: the shadow is off.\n",
        "## Figure 7: contrast over a city\n",
        table(("(streak + sky) / sky", "B", "G", "R"), [
            ("the paper", "2.03 (highest)", "1.12 (lowest)", "between")] + [
            (label, *(f"{seven['bands'][b][key]:.3g}" for b in "BGR")) for label, key in (
                ("counts of 2 s", "2 s"), ("rate image of 20 s", "20 s"), ("20 s sky over the full well", "well"))]),
        figure("figure7.svg", "Ratio of the excesses against the brightness of the sky, for three lamps"),
        f"The excess of the ridge over the sky falls as one over the exposure; the ratio of the excesses in B and G, 8.6 in the paper, does not "
        f"depend on it. {seven['tried']} combinations were tried: zenith skies of V = 16 to 19, shares of three kinds of lamps in steps of 0.1, and "
        "the exposure that fits B and G best. "
        f"{seven['within_20_percent']} of them have both within 20 %.\n",
        figure("figure7-surface.svg", "How far apart the exposures are that B and G ask for, against share of low-pressure sodium and brightness of the sky"),
        "The exposure that B asks for over the one that G asks for (or the inverse), with the best split of the other two lamps: 1 is a solution. The best six:\n",
        table(("zenith, V", "LPS", "HPS", "LED", "exposure, s", "B", "G", "R"), [
            (f"{s['magnitude']:.1f}", s["lps"], s["hps"], s["led"], f"{s['exposure_s']:.2g}", f"{s['B']:.2f}", f"{s['G']:.3f}", f"{s['R']:.3f}")
            for s in seven["best"]]),
        f"The nearest, V = {best['magnitude']:.1f} under lamps of {best['lps']:g} low-pressure sodium, gives B {best['B']:.2f} and G {best['G']:.2f} in "
        f"{best['exposure_s']:.2g} s: the paper's two figures need light of sodium and a sky so bright that the natural one does not matter in blue. "
        f"R is then below G ({best['R']:.2f}), while the paper has its lowest contrast in G. {nearest_in_order(seven['ordered'])} With the "
        f"V = 18 of such a city, the nearest is B {seven['at_18'][0]['B']:.2f} and G {seven['at_18'][0]['G']:.2f}. With the paper's exposure of 20 s "
        "the sky alone fills the well. What cannot be known from the paper: exposure, lamps, sky, filters, and which pixels its ratio is of.\n",
        "## Figure 8: a satellite through the air\n",
        figure("figure8.png", "Radiance map, short and long exposure"),
        f"A box with wings of Sandford-Robertson materials, {eight['range_km']:.0f} km away (V = {eight['magnitude']:.1f}), before a telescope of 3 m and "
        "r0 = 15 cm: radiance map, 5 ms, 0.4 s. The paper shows pictures of another satellite, without figures. Ours are checked by the speckle of a "
        f"point ({eight['frames']} exposures of 1 ms, centred): contrast {contrast['1']:.3f}, theory 1 for D / r0 >> 1, averaged over pixels of half "
        f"lambda / D {eight['theory']:.3f}; means of 2, 4 and 8 exposures have "
        + ", ".join(f"{contrast[str(n)]:.3f}" for n in (2, 4, 8)) + ", by 1 / sqrt(N) "
        + ", ".join(f"{contrast['1'] / n**0.5:.3f}" for n in (2, 4, 8)) + ".\n",
        "## Figure 9: materials\n",
        figure("figure9.svg", "Reflectance of cells and mylar with the two bands"),
        table(("", "0.95 um", "1.40 um", "the paper"), [
            (name, *(f"{v:.3g}" for v in values), {"silicon cell": "0.025, 0.39", "germanium cell": "0.025, 0.025"}.get(name, "plotted only"))
            for name, values in nine.items()]),
        "Computed from public optical constants, and scaled to the paper's values ([materials](models/materials.md)).\n",
        "## Figure 10: the space imager\n",
        figure("figure10.png", "STARLINK-1014, the unknown object and what else is in the field at 0.925 um"),
        f"The middle of a frame of 4096 x 4096 pixels, 0.5 s. STARLINK-1014 is {ten['range_km']['STARLINK-1014']:.0f} km away, the unknown object "
        f"{ten['range_km']['unknown']:.0f} km; stars trail, as the camera turns with its platform. The boresight is "
        f"{ten['limb_angle_deg']:.1f} deg above the Earth's limb: the paper says more than 25, which its own geometry does not allow "
        "at 550 km. `dmise check --limb-deg 25` warns of it.\n",
        "## Table 3: spectral signatures\n",
        table_3(found),
        "One exposure of each band for each seed, on a window about both objects; light in an aperture of 4 px, the background from a ring. The "
        "paper's ratios are 12 and 7 % below the laboratory's as background remained in its fluxes; with a local background they are not. The sizes of the "
        "spheres are such that the paper's relative errors come out: 12 sigma in R for silicon. Germanium is as dark in the longer band, where sunlight is "
        "weaker, so that the paper's 8 % of it need more light: 23 sigma. Is there a smaller bias? 40,000 seeds, each on 48 x 48 pixels about an object, are "
        + ", ".join(f"{m} {bias(three, m)}" for m in ("silicon", "germanium"))
        + ". Without noise only what the aperture's model leaves out of the detector's coupling and non-linearity remains.\n",
        "The sequence of whole frames, one seed:\n",
        table(("object", "frames", "ratio of all", "scatter", "expected", "found to be"), [
            (o["object"], o["samples"], f"{o['ratios'][0]['of_all']['value']:.4g} +- {o['ratios'][0]['of_all']['sigma']:.2g}",
             f"{o['ratios'][0]['scatter']:.3g}", f"{o['ratios'][0]['expected_scatter']:.3g}",
             f"{o['materials'][0]['name']} ({o['materials'][0]['probability']:.4f})") for o in ten["report"]["objects"]]),
        f"2 x 20 frames of 4096 x 4096 took {three['figures']['sequence_s']['value']:.0f} s here "
        f"({three['figures']['sequence_s']['anchor_value']:.0f} s of processor time on two threads).\n",
        "### Which bands, exposure, aperture and distance\n",
        figure("design.svg", "Exposure of each band that tells silicon from germanium in 99 % of cases, against distance"),
        "For an object of 0.05 m2 times its phase function (a diffuse sphere of 0.97 m diameter, half lit), right in 99 % of cases:\n",
        table(("distance, km", "exposure, s"), [(f"{p['range_m'] / 1e3:.0f}", seconds(p["exposure_s"])) for p in three["design"]["by_range"][::5]]),
        table(("diameter, m", "exposure, s"), [(f"{p['aperture_m']:.3g}", seconds(p["exposure_s"])) for p in three["design"]["by_aperture"][::4]]),
        table(("photometric radius, px", "exposure, s"), [
            (p["radius_px"], seconds(p["exposure_s"])) for p in three["design"]["by_photometric_radius"][::2]]),
        table(("bands of 50 nm, um (cells of the library)", "exposure, s"), [
            (f"{p['shorter_m'] * 1e6:.3f} and {p['longer_m'] * 1e6:.3f}", seconds(p["exposure_s"])) for p in three["pairs"]]),
    ]
    return "\n".join(parts)
