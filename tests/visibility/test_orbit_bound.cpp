#include "core/visibility/orbit_bound.h"

#include "core/base/units.h"
#include "tests/visibility/watch.h"

namespace dmise {
namespace {

// Over the whole catalogue of December 2019 and a day: the bound that holds at both ends of an hour
// against steps of 10 s within it, in TEME and in axes turning with the Earth.
TEST(OrbitBound, NoObjectOfTheCatalogueMovesFasterOrFarther) {
  const std::string path = test::data_path("tle/catalog_3le_2019-12-19_18470.txt.gz");
  DMISE_NEEDS_FILE(path);
  const auto elements = read_catalogue(path).elements;
  const Sgp4Batch batch(elements);
  const std::size_t n = batch.size();
  struct States {
    std::vector<double> r, v;
    std::vector<std::uint8_t> code;
  };
  const auto states = [&](double s) {
    States x{std::vector<double>(3 * n), std::vector<double>(3 * n), std::vector<std::uint8_t>(n)};
    batch.propagate(2458837.5, s / 86400.0, x.r, x.v, x.code);
    return x;
  };
  const auto vec = [&](const std::vector<double>& a, std::size_t i) {
    return Vec<Teme>{a[i], a[n + i], a[2 * n + i]};
  };
  const auto turned = [](const Vec<Teme>& p, double s) {
    const double a = 7.292115855306587e-5 * s;
    return Vec<Teme>{std::cos(a) * p.x + std::sin(a) * p.y, -std::sin(a) * p.x + std::cos(a) * p.y,
                     p.z};
  };
  double fullest = 0, fullest_turning = 0, fullest_distance = 0;
  for (double hour = 0; hour < 86400; hour += 6 * 3600) {
    const States first = states(hour), last = states(hour + 3600);
    for (double s = hour; s < hour + 3600; s += 290) {
      const States a = states(s), b = states(s + 10);
      for (std::size_t i = 0; i < n; ++i) {
        if (first.code[i] || last.code[i] || a.code[i] || b.code[i]) continue;
        const OrbitBound bound = either(orbit_bound(vec(first.r, i), vec(first.v, i)),
                                        orbit_bound(vec(last.r, i), vec(last.v, i)));
        const Vec<Teme> p = vec(a.r, i), q = vec(b.r, i);
        fullest = std::max(fullest, norm(q - p) / 10 / bound.speed_m_per_s);
        fullest_turning =
            std::max(fullest_turning, norm(turned(q, 10) - p) / 10 / bound.turning_speed_m_per_s);
        fullest_distance = std::max(fullest_distance, norm(p) / bound.distance_m);
      }
    }
  }
  EXPECT_LT(fullest, 1.0);
  EXPECT_LT(fullest_turning, 1.0);
  EXPECT_LT(fullest_distance, 1.0);
  EXPECT_GT(fullest, 0.95);  // and not idle
  RecordProperty("fullest", std::to_string(fullest));
  std::printf("fullest: speed %.4f, turning %.4f, distance %.4f\n", fullest, fullest_turning,
              fullest_distance);
}

TEST(OrbitBound, AnEscapingObjectIsNotBound) {
  const OrbitBound b = orbit_bound(Vec<Teme>{7e6, 0, 0}, Vec<Teme>{0, 12e3, 0});
  EXPECT_TRUE(std::isinf(b.speed_m_per_s));
}

}  // namespace
}  // namespace dmise
