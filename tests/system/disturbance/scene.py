"""A small real scenario: three sensors of 64 x 64 pixels, one of which remembers its last frames
(persistence) and one of which looks through frozen turbulence, and a node that records positions."""

SILENT_AFTER_S = 2.0
TICKS = 60
TICK_S = 2
SENSORS = ("alpha", "beta", "gamma")
NODES = (*SENSORS, "orbit-node", "environment-node", "positions-node")  # who keep time
EVERYBODY = (*NODES, "broker")

SCENARIO = """\
simulation: {{start: 2018-01-21T00:15:00Z, duration_s: {duration_s}, tick_s: {tick_s}, seed: 1}}
objects: [{{catalogue: demo}}]
stars: {{catalogue: kstars}}
sensors:
  - {{name: alpha, site: atlanta, camera: remembering.yaml, pointing: zenith, exposure_s: 1, cadence_s: 4,
     atmosphere: {{refraction: off}}}}
  - {{name: beta, site: atlanta, camera: telescope.yaml, pointing: zenith, exposure_s: 0.02, cadence_s: 8,
     atmosphere: {{turbulence: hv57, refraction: off}}}}
  - {{name: gamma, site: savannah, camera: small.yaml, pointing: zenith, exposure_s: 2, cadence_s: 6,
     atmosphere: {{refraction: off}}}}
network: {{on_silent_node: {policy}, silent_after_s: {silent_after_s}, join_within_s: 60, real_time: {real_time}}}
output: {{png: false, positions: [csv]}}
"""

CAMERA = """\
name: {name}
optics: {{projection: gnomonic, columns: 64, rows: 64, pixel_pitch_m: {pitch_m}, field_of_view_deg: {field_deg},
         aperture_m: {aperture_m}}}
detector: {{full_well_e: 25500, gain_e_per_dn: 0.35, read_noise_e: 9, bias_dn: 100{more}}}
band: {{centre_m: 0.55e-6, width_m: 0.128e-6}}
"""

CAMERAS = {
    "small": dict(pitch_m=43.2e-6, field_deg=15, aperture_m=0.02, more=""),
    "remembering": dict(pitch_m=43.2e-6, field_deg=15, aperture_m=0.02,
                        more=", persistence_fraction: 0.02, persistence_s: 6"),
    "telescope": dict(pitch_m=9e-6, field_deg=0.05, aperture_m=0.2, more=""),
}


def write_scene(directory, policy, wall_s, silent_after_s=SILENT_AFTER_S):
    """`wall_s`: seconds that an undisturbed run takes; 0: as fast as it can. Returns the scenario's path."""
    directory.mkdir(parents=True, exist_ok=True)
    for name, camera in CAMERAS.items():
        (directory / f"{name}.yaml").write_text(CAMERA.format(name=name, **camera))
    path = directory / f"{policy}-{wall_s:g}.yaml"
    path.write_text(SCENARIO.format(
        duration_s=TICKS * TICK_S, tick_s=TICK_S, policy=policy, silent_after_s=silent_after_s,
        real_time=TICKS * TICK_S / wall_s if wall_s else 0))
    return path
