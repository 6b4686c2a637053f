"""Eccentric anomalies to 25 digits by mpmath: the table of tests/orbit/test_kepler.cpp.
Run with Debian's /usr/bin/python3."""
from mpmath import mp, mpf, sin

mp.dps = 400


def eccentric_anomaly(m, e):
    low, high = m, m / (1 - e)
    high = min(high, mp.pi)
    for _ in range(1400):
        middle = (low + high) / 2
        if middle - e * sin(middle) > m:
            high = middle
        else:
            low = middle
        if high - low < mpf(10) ** -40 * high:
            break
    return (low + high) / 2


for e in ("0x0p+0", "0x1p-10", "0x1.8p-1", "0x1.ffp-1", "0x1.fffffffffp-1", "0x1.fffffffffffffp-1"):
    for m in ("0x1p-996", "0x1p-400", "0x1p-70", "0x1p-30", "0x1p-10", "0x1p-2", "0x1p+0", "0x1.9p+1"):
        e_value, m_value = mpf(float.fromhex(e)), mpf(float.fromhex(m))
        print(f"    {{{m}, {e}, {mp.nstr(eccentric_anomaly(m_value, e_value), 20)}}},")
