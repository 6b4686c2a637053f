"""A tenth of `dmise validate`: the models of families beside the held-out half of what was measured of the sky, the power of
light curves (all of them), places of satellites beside their precise orbits, the sky beside published figures, frames of survey
telescopes, and what is detected in drawn frames.

    validate_models.py DMISE

Without the measurements ($DMISE_DATA, else ../shared/data) it says so and exits 77, with DMISE_DATA set 1.
"""
import json
import os
import pathlib
import subprocess
import sys

import referee

DATA = pathlib.Path(os.environ.get("DMISE_DATA", referee.SOURCE / "../shared/data")) / "validation"


def judge(dmise):
    referee.need_file(DATA / "brightness/pomenis_even.csv")
    done = subprocess.run([dmise, "validate", "--data", DATA, "--every", "10", "--json"], capture_output=True, text=True)
    referee.check_silently(done.returncode == 0, f"dmise validate ends well: {done.stderr}")
    figures = {figure["name"]: figure for figure in map(json.loads, done.stdout.splitlines())}
    for family in ("starlink-v1.5", "oneweb", "iridium-next"):
        for what in ("median_off", "scatter"):
            figure = figures[f"{family}_held_out_{what}"]
            referee.check(figure["value"] <= figure["target"],
                          f"{figure['name']} is {figure['value']:.2f} mag, wanted {figure['target']:.2f}")
    for name in ("oneweb_held_out_power_off_mean", "oneweb_held_out_power_off_median", "iridium-next_held_out_power_off_mean",
                 "iridium-next_held_out_power_off_median"):
        referee.check(figures[name]["value"] <= 2, f"{name} is {figures[name]['value']:.2f}, at most 2")
    for what, most in (("places_bias", 0.1), ("places_rms_over_sigma", 1.2)):
        referee.check(figures[what]["value"] <= most, f"{what} is {figures[what]['value']:.3f}, at most {most}")
    for what, most in (("dark", 0.7), ("moonlit", 0.3), ("twilight", 0.2), ("day", 0.3), ("day_zenith", 0.3)):
        worst = figures[f"sky_{what}_worst"]["value"]
        referee.check(worst <= most, f"sky_{what}_worst is {worst:.2f} mag, at most {most}")
    judge_frames(figures)
    judge_detector(figures)


def judge_frames(figures):
    found = figures["frames_found_as_wanted"]
    referee.check(found["value"] == found["target"], f"{found['value']:.0f} of {found['target']:.0f} real frames have what they should")
    for name, low, high in (("sdss_zero_point", 0.998, 1.002), ("sdss_noise", 0.7, 1.0), ("vatt_noise", 0.9, 1.25), ("hsc_noise", 0.9, 1.5)):
        figure = figures[f"frames_{name}"]
        ratio = figure["value"] / figure["anchor_value"]
        referee.check(low <= ratio <= high, f"{figure['name']}: predicted / measured {ratio:.3f}, in {low} to {high}")


def judge_detector(figures):
    for kind in ("points", "streaks"):
        of = {what: figures[f"detector_{kind}_sparse_{what}"]["value"] for what in
              ("found", "deviation", "false_positives", "across_over_sigma", "along_over_sigma", "magnitude_over_sigma")}
        for what, most in (("deviation", 5), ("false_positives", 1.5), ("across_over_sigma", 1.4), ("along_over_sigma", 1.4),
                           ("magnitude_over_sigma", 1.4)):
            referee.check(of[what] <= most, f"detector, {kind}: {what} is {of[what]:.2f}, at most {most}")
        referee.check(of["found"] >= 0.5, f"detector, {kind}: {of['found']:.2f} of all are found, at least 0.5")


if __name__ == "__main__":
    referee.main(judge, *sys.argv[1:])
