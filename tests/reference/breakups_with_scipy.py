"""Fragments on paths that scipy's DOP853 integrates are found to come from one point, with an honest time and place.

    breakups_with_scipy.py PINCH_CASE BREAKUP_CASE [BREAKUPS]

Speeds and directions are those of breakup-case, which breakup_laws.py judges; forces are those of manoeuvres_with_scipy.py. Each fragment
is first seen 1 to 5 h after its breakup, with errors of 200 m and 0.2 m/s. Squared errors of time and place over their covariance must be 1
within their scatter. Without scipy or ERFA it exits 77.
"""
import json
import subprocess
import sys

from manoeuvres_with_scipy import HOUR_S, START, Paths, Surroundings, chi2, circular, np

PARENT = circular(7.158e6, 86.4, 40, 10)
SIGMA_M, SIGMA_M_PER_S = 200.0, 0.2
MEMBERS = 5
FASTEST_M_PER_S = 300.0
LATEST_S = 5 * HOUR_S


def pieces(program):
    rows = np.array([list(map(float, line.split())) for line in
                     subprocess.run([program, "explosion"], capture_output=True, text=True, check=True).stdout.splitlines()[1:]])
    speeds = 10 ** rows[:, 4:5] * rows[:, 5:8]
    return speeds[np.linalg.norm(speeds, axis=1) < FASTEST_M_PER_S]


def main(pinch, breakup, count):
    generator = np.random.default_rng(300)
    around = Surroundings(12 * HOUR_S)
    speeds = pieces(breakup)
    at_s = generator.uniform(0, 3 * HOUR_S, count)
    parents = Paths(around, [PARENT], 0.0, 3 * HOUR_S).of(0, at_s)
    truths = list(zip(at_s, parents))
    starts, begins = np.repeat(parents, MEMBERS, axis=0), np.repeat(at_s, MEMBERS)
    starts[:, 3:] += np.vstack([speeds[generator.choice(len(speeds), MEMBERS, replace=False)] for _ in range(count)])
    seen_s = begins + generator.uniform(HOUR_S, LATEST_S, len(begins))
    paths = Paths(around, starts, begins, seen_s)
    sigma = np.repeat([SIGMA_M, SIGMA_M_PER_S], 3)
    text = [START]
    for k, time_s in enumerate(seen_s):
        if k % MEMBERS == 0:
            text.append(str(MEMBERS))
        state = paths.of(k, [time_s])[0] + sigma * generator.normal(size=6)
        text.append(" ".join(repr(float(x)) for x in [time_s, *state, SIGMA_M, SIGMA_M_PER_S]))
    done = subprocess.run([pinch], input="\n".join(text) + "\n", capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(done.stderr)
    times, places, fits, members, offs = [], [], [], [], []
    for (at_s, parent), line in zip(truths, done.stdout.splitlines()):
        told = json.loads(line)
        if not told:
            continue
        off = np.array(told["position_m"]) - parent[:3]
        times.append(((told["time_s"] - at_s) / told["time_sigma_s"]) ** 2)
        places.append(off @ np.linalg.solve(np.array(told["covariance"]).reshape(3, 3), off) / 3)
        fits.append(told["chi_square"] / told["degrees"])
        members.append(told["members"])
        offs.append((abs(told["time_s"] - at_s), np.linalg.norm(off)))
    found = len(times)
    print(f"{found} of {count} breakups are found, with {np.mean(members):.2f} of {MEMBERS} members; time off by "
          f"{np.median([o[0] for o in offs]):.2f} s, place by {np.median([o[1] for o in offs]):.0f} m (medians)")
    good = found >= 0.9 * count and np.mean(members) > 0.9 * MEMBERS
    for name, values, degrees in (("time", times, found), ("place", places, 3 * found), ("fit", fits, 11 * found)):
        low, high = chi2.ppf([0.0005, 0.9995], degrees) / degrees
        print(f"squared error of the {name} over its variance: {np.mean(values):.2f} must be {low:.2f} to {high:.2f}")
        good &= low < np.mean(values) < high
    return good


if __name__ == "__main__":
    sys.exit(0 if main(sys.argv[1], sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 30) else 1)
