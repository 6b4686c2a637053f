#pragma once

namespace dmise {

/// Carlson's symmetric elliptic integral of the first kind, R_F(x, y, z), to 1e-15 of its value;
/// arguments >= 0, at most one of them 0. K(m) is R_F(0, 1 - m, 1), and F(phi, m) is
/// s R_F(c^2, c^2 + (1 - m) s^2, 1) with s, c the sine and the cosine of phi, |phi| <= pi / 2.
/// Source: Carlson 1995, Numerical Algorithms 10, 13.
double carlson_rf(double x, double y, double z);

struct JacobiFunctions {
  double sn = 0.0, cn = 1.0, dn = 1.0;
};

/// Jacobi's elliptic functions of `u`, |u| <= K, for the complementary parameter `m1` = 1 - m in
/// [0, 1]; m1 = 0 gives tanh and sech. By the arithmetic-geometric mean and ascending
/// transformations (Bulirsch 1965, Numerische Mathematik 7, 78): accurate even where m1 is too
/// small for m = 1 - m1 to differ from 1.
JacobiFunctions jacobi_functions(double u, double m1);

}  // namespace dmise
