"""Elements of one ISS set as python3-sgp4 reads them: the numbers in
tests/orbit/test_tle.cpp. Run with Debian's /usr/bin/python3."""
from sgp4.model import Satrec

LINE1 = "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927"
LINE2 = "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537"

satellite = Satrec.twoline2rv(LINE1, LINE2)
for name in ("jdsatepoch jdsatepochF no_kozai ecco inclo nodeo argpo mo bstar ndot nddot").split():
    print(f"{name:12} {getattr(satellite, name)!r}")
