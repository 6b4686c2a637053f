"""Rows of tests/base/test_elliptic.cpp by mpmath with 60 digits (PyPI: mpmath): {1 - m, u / K, sn, cn, dn}, K(1 - 1e-30), R_F(1, 2, 3)."""
import mpmath

mpmath.mp.dps = 60


def text(x):
    return mpmath.nstr(mpmath.re(x), 17)


for m1 in (1.0, 0.7, 0.1, 1e-3, 1e-10, 1e-30):
    for part in (0.1, 0.5, 0.9, -0.75):
        m = 1 - mpmath.mpf(m1)
        u = mpmath.mpf(part) * mpmath.ellipk(m)
        values = ", ".join(text(mpmath.ellipfun(f, u=u, m=m)) for f in ("sn", "cn", "dn"))
        print(f"    Row{{{m1:g}, {part:g}, {values}}},")
print(text(mpmath.ellipk(1 - mpmath.mpf(1e-30))), text(mpmath.elliprf(1, 2, 3)))
