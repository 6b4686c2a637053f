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
    from astropy.time import Time, TimeDelta
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed (./dmise setup --tests)")
    sys.exit(77)
from dmise.convert import start_of  # noqa: E402
from dmise.leap_seconds import utc_after  # noqa: E402

dates = [f"{year}-07-01" for year in (1972, 1981, 1985, 1992, 2012, 2015)] + [f"{year}-01-01" for year in (1973, 1999, 2006, 2017)]
random.seed(1)
wrong = []
for date in dates:
    midnight = datetime.datetime.fromisoformat(date + "T00:00:00+00:00")
    for _ in range(100):
        start = midnight + datetime.timedelta(seconds=random.uniform(-3, 3) * random.choice((1, 1e3, 1e6)))
        microseconds = int(random.uniform(-1, 1) * 10 ** random.choice((6, 7, 9, 13)))
        got = utc_after(start, microseconds)
        parts = (Time(start) + TimeDelta(microseconds * 1e-6, format="sec")).utc.ymdhms
        expected = datetime.datetime(*(int(parts[name]) for name in ("year", "month", "day", "hour", "minute")), tzinfo=datetime.timezone.utc)
        minute = got.replace(second=0, microsecond=0, fold=0)
        seconds = (minute - expected).total_seconds() + got.second + got.fold + got.microsecond * 1e-6
        if abs(seconds - float(parts["second"])) > 3e-6:
            wrong.append((start, microseconds, got))
check(not wrong, f"UTC is astropy's at {100 * len(dates)} times: {wrong[:3]}")

start = start_of("2016-12-31T23:59:60.500000Z")
check(start is not None and (start.second, start.fold) == (59, 1), f"a run may start in a leap second: {start}")
check(utc_after(start, 400_000).fold == 1, "and is in it 0.4 s later")
check(utc_after(start, 500_000) == datetime.datetime(2017, 1, 1, tzinfo=datetime.timezone.utc), "and in the next year 0.5 s later")
