"""UTC of the Python package's records beside astropy's, at and around every leap second.

    leap_seconds.py
"""

import datetime
import pathlib
import random
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/system"), str(ROOT / "build/python")]
from harness import check  # noqa: E402

try:
    import erfa
    from astropy.time import Time, TimeDelta
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
from dmise.convert import start_of  # noqa: E402
from dmise.leap_seconds import utc_after  # noqa: E402

days = [datetime.datetime(int(row["year"]), int(row["month"]), 1, tzinfo=datetime.timezone.utc)
        for row in erfa.leap_seconds.get() if (row["year"], row["month"]) > (1972, 1)]
random.seed(1)
wrong = []
for midnight in days:
    for _ in range(60):
        start = midnight + datetime.timedelta(seconds=random.uniform(-3, 3) * random.choice((1, 1e3, 1e6)))
        microseconds = int(random.uniform(-1, 1) * 10 ** random.choice((6, 7, 9, 13)))
        got = utc_after(start, microseconds)
        parts = (Time(start) + TimeDelta(microseconds * 1e-6, format="sec")).utc.ymdhms
        second = float(parts["second"])
        leap = second >= 60.0
        expected = datetime.datetime(*(int(parts[name]) for name in ("year", "month", "day", "hour", "minute")),
                                     tzinfo=datetime.timezone.utc) + datetime.timedelta(seconds=second - leap)
        near_its_edge = abs(second - 60.0) < 3e-6 or second < 3e-6
        if abs((got - expected).total_seconds()) > 3e-6 or (got.fold != leap and not near_its_edge):
            wrong.append((start, microseconds, got, parts))
check(len(days) >= 27 and not wrong, f"UTC is astropy's about {len(days)} leap seconds: {wrong[:3]}")

start = start_of("2016-12-31T23:59:60.500000Z")
check(start is not None and (start.second, start.fold) == (59, 1), f"a run may start in a leap second: {start}")
check(utc_after(start, 400_000).fold == 1, "and is in it 0.4 s later")
check(utc_after(start, 500_000) == datetime.datetime(2017, 1, 1, tzinfo=datetime.timezone.utc), "and in the next year 0.5 s later")
