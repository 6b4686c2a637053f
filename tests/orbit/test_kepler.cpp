#include "core/orbit/kepler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

struct Solution {
  double mean_anomaly_rad, eccentricity, eccentric_anomaly_rad;
};

// Reference: mpmath with 400 digits, tests/reference/kepler.py.
const Solution solutions[] = {
    {0x1p-996, 0x0p+0, 1.4932217896051502064e-300},
    {0x1p-400, 0x0p+0, 3.8725919148493182728e-121},
    {0x1p-70, 0x0p+0, 8.4703294725430033907e-22},
    {0x1p-30, 0x0p+0, 9.3132257461547851563e-10},
    {0x1p-10, 0x0p+0, 0.0009765625},
    {0x1p-2, 0x0p+0, 0.25},
    {0x1p+0, 0x0p+0, 1.0},
    {0x1.9p+1, 0x0p+0, 3.125},
    {0x1p-996, 0x1p-10, 1.4946814394483614969e-300},
    {0x1p-400, 0x1p-10, 3.8763774396927682418e-121},
    {0x1p-70, 0x1p-10, 8.4786093645005234331e-22},
    {0x1p-30, 0x1p-10, 9.3223295836388074291e-10},
    {0x1p-10, 0x1p-10, 0.00097751710639718860355},
    {0x1p-2, 0x1p-10, 0.25024183424631144828},
    {0x1p+0, 0x1p-10, 1.0008221825463603392},
    {0x1.9p+1, 0x1p-10, 3.1250161872141028532},
    {0x1p-996, 0x1.8p-1, 5.9728871584206008255e-300},
    {0x1p-400, 0x1.8p-1, 1.5490367659397273091e-120},
    {0x1p-70, 0x1.8p-1, 3.3881317890172013563e-21},
    {0x1p-30, 0x1.8p-1, 3.7252902984619140367e-9},
    {0x1p-10, 0x1.8p-1, 0.0039062201983824484866},
    {0x1p-2, 0x1.8p-1, 0.77454113319788491541},
    {0x1p+0, 0x1.8p-1, 1.7393689387435206884},
    {0x1.9p+1, 0x1.8p-1, 3.1321110763675636735},
    {0x1p-996, 0x1.ffp-1, 7.6452955627783690567e-298},
    {0x1p-400, 0x1.ffp-1, 1.9827670604028509557e-118},
    {0x1p-70, 0x1.ffp-1, 4.336808689942017736e-19},
    {0x1p-30, 0x1.ffp-1, 4.768371581938912115e-7},
    {0x1p-10, 0x1.ffp-1, 0.15887767584686406742},
    {0x1p-2, 0x1.ffp-1, 1.1682818841566289459},
    {0x1p+0, 0x1.ffp-1, 1.9332155885216094366},
    {0x1.9p+1, 0x1.ffp-1, 3.1332881693141618225},
    {0x1p-996, 0x1.fffffffffp-1, 2.0522684006491881247e-289},
    {0x1p-400, 0x1.fffffffffp-1, 5.3224498000101883999e-110},
    {0x1p-70, 0x1.fffffffffp-1, 1.1641532179079474207e-10},
    {0x1p-30, 0x1.fffffffffp-1, 0.0017745237216474577056},
    {0x1p-10, 0x1.fffffffffp-1, 0.18037898873077399545},
    {0x1p-2, 0x1.fffffffffp-1, 1.171229652490695391},
    {0x1p+0, 0x1.fffffffffp-1, 1.9345632107470088843},
    {0x1.9p+1, 0x1.fffffffffp-1, 3.1332962792085284857},
    {0x1p-996, 0x1.fffffffffffffp-1, 1.3449746190494519294e-284},
    {0x1p-400, 0x1.fffffffffffffp-1, 3.4881207009346770698e-105},
    {0x1p-70, 0x1.fffffffffffffp-1, 1.7063808509046624567e-7},
    {0x1p-30, 0x1.fffffffffffffp-1, 0.0017745319219447778995},
    {0x1p-10, 0x1.fffffffffffffp-1, 0.18037898881122802545},
    {0x1p-2, 0x1.fffffffffffffp-1, 1.1712296525016658265},
    {0x1p+0, 0x1.fffffffffffffp-1, 1.934563210752024191},
    {0x1.9p+1, 0x1.fffffffffffffp-1, 3.1332962792085586674},
};

TEST(Kepler, AgreesWithMultiprecisionForAnyEllipseDownToTinyAnomalies) {
  for (const Solution& s : solutions) {
    const double e = eccentric_anomaly_rad(s.mean_anomaly_rad, s.eccentricity);
    EXPECT_LE(std::abs(e / s.eccentric_anomaly_rad - 1), 1e-13)
        << s.mean_anomaly_rad << " " << s.eccentricity;
    EXPECT_EQ(eccentric_anomaly_rad(-s.mean_anomaly_rad, s.eccentricity), -e);
  }
}

TEST(Kepler, TurnsAreKept) {
  for (const double e : {0.0, 0.3, 0.9, 1 - 1e-12}) {
    const double inner = eccentric_anomaly_rad(1.25, e);
    EXPECT_NEAR(eccentric_anomaly_rad(1.25 + 200 * pi, e), inner + 200 * pi, 1e-12);
    EXPECT_NEAR(eccentric_anomaly_rad(1.25 - 200 * pi, e), inner - 200 * pi, 1e-12);
  }
}

TEST(Kepler, EndsOfTheRange) {
  EXPECT_EQ(eccentric_anomaly_rad(0.0, 0.999), 0.0);
  EXPECT_NEAR(eccentric_anomaly_rad(pi, 0.999), pi, 1e-15);
  EXPECT_THROW(eccentric_anomaly_rad(0.1, 1.0), Error);
  EXPECT_THROW(eccentric_anomaly_rad(0.1, -0.1), Error);
  EXPECT_THROW(eccentric_anomaly_rad(std::numeric_limits<double>::quiet_NaN(), 0.1), Error);
  EXPECT_THROW(eccentric_anomaly_rad(0.1, std::numeric_limits<double>::quiet_NaN()), Error);
}

}  // namespace
}  // namespace dmise
