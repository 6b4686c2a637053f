"""A telescope that follows a geostationary satellite, in DMISE's API: 512 x 512 pixels, 8 frames of 1 s, Gaussian blur."""
import dmise

SCENE = {
    "simulation": {"start": "2018-01-21T03:00:00Z", "duration_s": 40, "tick_s": 5, "seed": 3},
    "objects": [{"catalogue": "demo", "only": ["GOES 13"], "radius_m": 2}],
    "stars": {"catalogue": "kstars"},
    "sensors": [{
        "name": "west", "site": {"latitude_deg": 33, "longitude_deg": -100, "height_m": 300},
        "camera": {
            "optics": {"columns": 512, "rows": 512, "pixel_pitch_m": 9e-6, "focal_length_m": 0.2, "aperture_m": 0.1, "psf_fwhm_px": 2},
            "detector": {"quantum_efficiency": 0.6, "read_noise_e": 5, "dark_e_per_s": 0.1, "full_well_e": 60000, "gain_e_per_dn": 1,
                         "bias_dn": 100},
            "band": {"name": "V", "centre_m": 0.55e-6, "width_m": 0.128e-6}},
        "pointing": {"target": "GOES 13", "tracking": "target"}, "exposure_s": 1, "cadence_s": 5}]}

for frame in dmise.Simulation(SCENE).frames("west"):
    made(frame.counts)
