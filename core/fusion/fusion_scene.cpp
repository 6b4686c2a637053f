#include "core/fusion/fusion_scene.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/sky/places/sun_moon.h"

namespace dmise {
namespace {

constexpr double fastest_m_per_s = 11e3;
constexpr double nearest_m = 150e3;  // an object that a sensor on the ground sees
constexpr double cone_margin_rad = 0.02;
constexpr double largest_cone_rad = 3.1;
constexpr double surface_m = 6.35e6;

}  // namespace

Fusion::Scene::Scene(const Clock& clock, const CataloguePrediction& catalogue,
                     const Ellipsoid& ellipsoid)
    : time(catalogue.time()),
      shadow(solar_system(clock.tt(time)).sun_m,
             oblate_earth(earth_orientation(clock, time), ellipsoid)) {}

std::vector<std::uint64_t> Fusion::Scene::objects_in(std::span<const SensorFrame> frames,
                                                     const CataloguePrediction& catalogue) const {
  const Rotation<Teme, Gcrs> teme_from_gcrs = catalogue.gcrs_from_teme().inverse();
  std::vector<Cone> cones;
  for (const SensorFrame& frame : frames) {
    const double moved_m = fastest_m_per_s * std::fabs((frame.time - time).seconds());
    const double margin = cone_margin_rad + std::atan(moved_m / nearest_m);
    cones.push_back({teme_from_gcrs * frame.sensor_m, teme_from_gcrs * frame.axis,
                     std::min(frame.half_angle_rad + margin, largest_cone_rad)});
  }
  std::vector<std::uint64_t> inside(frames.size() * cone_words(catalogue.size()));
  cone_test(catalogue.teme_m(), cones, inside);
  return inside;
}

bool Fusion::Scene::is_kept(std::size_t object) const {
  return std::ranges::binary_search(kept, object, {},
                                    &std::pair<std::size_t, KeptOrbits::Place>::first);
}

double Fusion::Scene::sunlit(const Vec<Gcrs>& position_m) const {
  return norm(position_m) < surface_m ? 0.0 : shadow.sunlit_fraction(position_m);
}

}  // namespace dmise
