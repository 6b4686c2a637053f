#include "core/detector/charge_transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/detector/exposure/expected_signal.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

const Exposure exposure{.seed = 1, .sensor = "s", .frame = 1, .exposure_s = 1.0};

ElectronImage read_out(const ExpectedElectronImage& light, double parallel, double serial,
                       double release_px = 0.0, int thread_count = 1) {
  Detector d = detector_of({});
  d.parallel_cti = parallel;
  d.serial_cti = serial;
  d.cti_release_px = release_px;
  Threads threads(thread_count);
  return expected_signal(light, d, exposure, {}, threads);
}

struct Case {
  double cti, release_px;
  double star[7], block[7];  // behind a star in row 400, and from the last row of a block on
};

// Reference: a column that numpy reads clock by clock, tests/reference/charge_transfer.py.
constexpr Case cases[] = {
    {1e-5, 0.0, {9959.980, 39.940, 0.080, 0, 0, 0, 0}, {999.990, 2.995, 0.005, 0, 0, 0, 0}},
    {2e-4,
     0.0,
     {9229.243, 740.185, 29.755, 0.799, 0.016, 0, 0},
     {999.800, 58.229, 1.735, 0.035, 0.001, 0, 0}},
    {5e-5,
     3.0,
     {9801.492, 55.707, 40.075, 28.829, 20.739, 14.919, 10.732},
     {999.824, 14.761, 10.608, 7.623, 5.478, 3.937, 2.829}},
    {5e-5,
     30.0,
     {9801.492, 6.443, 6.234, 6.031, 5.836, 5.646, 5.463},
     {998.160, 13.108, 12.681, 12.268, 11.869, 11.482, 11.109}}};

TEST(ChargeTransfer, TrailsAreThoseOfAColumnReadClockByClock) {
  for (const Case& c : cases) {
    ExpectedElectronImage light(3, 512);
    light.at(0, 400) = 10000.0f;
    for (int y = 200; y < 300; ++y) light.at(2, y) = 1000.0f;
    const auto image = read_out(light, c.cti, 0.0, c.release_px);
    // A share of the trail, by the steps in which transfers are made.
    const double lost = 1.0 - std::pow(1.0 - c.cti, 401);
    const double tolerance = 0.01 * lost;
    for (int k = 0; k < 7; ++k) {
      EXPECT_NEAR(image.at(0, 400 + k), c.star[k], 10000 * tolerance) << c.cti << " " << k;
      EXPECT_NEAR(image.at(2, 299 + k), c.block[k], 1000 * tolerance) << c.cti << " " << k;
      EXPECT_EQ(image.at(1, 400 + k), 0.0f);
    }
    EXPECT_EQ(image.at(0, 399), 0.0f);
  }
}

// Janesick 2001: the charge behind the last pixel of an even light is that of a pixel times the
// number of its transfers times the inefficiency.
TEST(ChargeTransfer, ExtendedPixelEdgeResponseIsTheInefficiency) {
  constexpr double cti = 2e-6;
  for (const bool serial : {false, true}) {
    ExpectedElectronImage light(serial ? 2048 : 2, serial ? 2 : 2048);
    for (int i = 0; i < 1500; ++i) (serial ? light.at(i, 1) : light.at(1, i)) = 30000.0f;
    const auto image = read_out(light, serial ? 0.0 : cti, serial ? cti : 0.0);
    double deferred_e = 0.0;
    for (int i = 1500; i < 2048; ++i) deferred_e += serial ? image.at(i, 1) : image.at(1, i);
    const double last_e = serial ? image.at(1499, 1) : image.at(1, 1499);
    EXPECT_NEAR(deferred_e / (last_e * 1500), cti, 0.01 * cti) << serial;
  }
}

TEST(ChargeTransfer, KeepsChargeThatStaysInTheFrame) {
  ExpectedElectronImage light(130, 400);  // columns of several blocks
  for (int x = 0; x < 130; ++x) light.at(x, x) = 5000.0f;
  const auto image = read_out(light, 1e-4, 1e-4, 2.0);
  const double sum = std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
  // The last columns lose theirs to the overscan: transfers times inefficiency of some.
  EXPECT_NEAR(sum, 130 * 5000.0, 5000.0 * 130 * 1e-4 * 3);
  EXPECT_LE(sum, 130 * 5000.0 * (1 + 1e-6));
  EXPECT_EQ(image.pixels, read_out(light, 1e-4, 1e-4, 2.0, 3).pixels);
}

TEST(ChargeTransfer, SerialIsParallelWithRowsForColumns) {
  ExpectedElectronImage light(300, 70), turned(70, 300);
  for (int y = 0; y < 70; ++y)
    for (int x = 0; x < 300; ++x)
      light.at(x, y) = turned.at(y, x) = float((x * 37 + y * 101) % 997);
  const auto serial = read_out(light, 0.0, 3e-5, 4.0), parallel = read_out(turned, 3e-5, 0.0, 4.0);
  for (int y = 0; y < 70; ++y)
    for (int x = 0; x < 300; ++x) ASSERT_EQ(serial.at(x, y), parallel.at(y, x));
}

TEST(ChargeTransfer, OnePixelAndNoInefficiency) {
  const ExpectedElectronImage one(1, 1, 1000.0f);
  EXPECT_FLOAT_EQ(read_out(one, 1e-3, 0.0).at(0, 0), 999.0f);
  EXPECT_EQ(read_out(one, 0.0, 0.0, 7.0).at(0, 0), 1000.0f);
  EXPECT_FALSE(applies(detector_of({}), ChargeTransfer::facts));
}

}  // namespace
}  // namespace dmise
