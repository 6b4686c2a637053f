"""UTC of a count of SI seconds. `datetime` has no second 60: a leap second is the second 59 with fold = 1."""
from __future__ import annotations

import datetime

_SECOND = datetime.timedelta(seconds=1)

# Days that began after a leap second. Source: IERS Bulletin C.
_DAYS = [datetime.datetime(year, month, 1, tzinfo=datetime.timezone.utc)
         for year, month in ((1972, 7), (1973, 1), (1974, 1), (1975, 1), (1976, 1), (1977, 1), (1978, 1), (1979, 1), (1980, 1),
                             (1981, 7), (1982, 7), (1983, 7), (1985, 7), (1988, 1), (1990, 1), (1991, 1), (1992, 7), (1993, 7),
                             (1994, 7), (1996, 1), (1997, 7), (1999, 1), (2006, 1), (2009, 1), (2012, 7), (2015, 7), (2017, 1))]


def utc_after(start: datetime.datetime, microseconds: int) -> datetime.datetime:
    """UTC so many microseconds of TAI after `start`, which has a time zone."""
    time = start.replace(fold=0) + datetime.timedelta(microseconds=microseconds) + start.fold * _SECOND
    for day in _DAYS:
        if start < day <= time:
            time -= _SECOND
            if time < day:
                return time.replace(fold=1)
        elif start >= day > time:
            time += _SECOND
            if time >= day:
                return (time - _SECOND).replace(fold=1)
    return time
