"""fitsverify finds neither error nor warning in any frame of a run.

A frame with a lookup table of its world coordinate system has several cards DP1 and DP2, as the convention of
record-valued keywords (Calabretta et al., "Representations of distortions in FITS world coordinate systems")
demands: DP1 = 'EXTVER: 1' and so on. fitsverify does not know it and warns that they are duplicated; of these
warnings alone nothing follows, and each must be of such a record.

    fitsverify_frames.py RUN
"""

import re
import subprocess
import sys

import referee


RECORD = re.compile(r"(DP[12]) *= *'[A-Z]+(\.[A-Z]+)*(\.\d+)?: *[-+.\dEe]+ *'")


def records_only(path, keyword):
    """All cards of the keyword are records with fields of different names."""
    cards = []
    data = path.read_bytes()
    for at in range(0, len(data), 80):
        card = data[at:at + 80].decode("ascii", "replace")
        if card.startswith(keyword.ljust(8) + "="):
            cards.append(card)
        if at >= 400 * 80:
            break
    fields = [card.split("'")[1].split(":")[0] for card in cards if RECORD.match(card)]
    return len(fields) == len(cards) > 1 and len(set(fields)) == len(fields)


def faults_of(path):
    done = subprocess.run([referee.need("fitsverify"), str(path)], capture_output=True, text=True, check=False)
    faults = [line for line in done.stdout.splitlines() if line.startswith("*** ")]
    rest = []
    for line in faults:
        twice = re.match(r"\*\*\* Warning: Keyword (DP[12]) is duplicated in card", line)
        if not (twice and records_only(path, twice[1])):
            rest.append(line)
    if not faults and done.returncode:
        rest.append(f"exit status {done.returncode}")
    return rest


def judge(run):
    paths = sorted(referee.need_file(run).glob("*/frame-*.fits"))
    referee.check(len(paths) > 0, f"{run} holds {len(paths)} frames")
    bad = [f"{path}: {fault}" for path in paths for fault in faults_of(path)]
    referee.check(not bad, f"fitsverify on {len(paths)} frames: {len(bad)} errors or warnings {bad[:3]}")


if __name__ == "__main__":
    referee.main(judge, sys.argv[1])
