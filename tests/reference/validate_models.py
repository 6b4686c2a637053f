"""A tenth of `dmise validate`: the models of families beside the held-out half of what was measured of the sky, and places of
satellites beside their precise orbits.

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
    for what, most in (("places_bias", 0.1), ("places_rms_over_sigma", 1.2)):
        referee.check(figures[what]["value"] <= most, f"{what} is {figures[what]['value']:.3f}, at most {most}")


if __name__ == "__main__":
    referee.main(judge, *sys.argv[1:])
