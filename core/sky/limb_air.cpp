#include "core/sky/limb_air.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <vector>

#include "core/base/numeric/table_place.h"
#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/sky/air/kept_tables.h"
#include "core/sky/air/standard_air.h"
#include "core/sky/air/sunlit_air.h"

namespace dmise {
namespace {

constexpr double limb_earth_radius_m = AirColumns::earth_radius_m;
constexpr float darkest_air_log = -200.0f;  // stands for no light

// Nodes of the table of scattered light.
constexpr std::size_t tangent_nodes = 71;  // every 1 km to 40, 2.3 km above
double tangent_node_m(std::size_t i) {
  constexpr double above_ground_m = 10.0;  // where the ground's edge hides nothing
  if (i == 0) return above_ground_m;
  return i <= 40 ? 1e3 * double(i)
                 : std::min(LimbAirTable::top_m, 40e3 + 70e3 / 30.0 * double(i - 40));
}
double node_of_tangent(double height_m) {
  return height_m <= 40e3 ? height_m / 1e3 : 40.0 + (height_m - 40e3) / (70e3 / 30.0);
}
constexpr std::array sun_nodes_deg = [] {
  std::array<double, 144> nodes{0, 30, 50, 60, 70, 75, 78, 80};
  for (std::size_t i = 8; i < 14; ++i) nodes[i] = 81.0 + double(i - 8);
  for (std::size_t i = 14; i < nodes.size(); ++i) nodes[i] = 86.2 + 0.2 * double(i - 14);
  return nodes;
}();
/// Even steps of the root of the cosine.
constexpr std::size_t azimuths = 61;
double towards_sun_of_node(std::size_t i) {
  const double u = 2.0 * double(i) / (azimuths - 1) - 1.0;
  return u * std::abs(u);
}
double node_of_towards_sun(double towards_sun) {
  const double root = std::copysign(std::sqrt(std::abs(towards_sun)), towards_sun);
  return 0.5 * (root + 1.0) * (azimuths - 1);
}
TablePlace between_suns(double zenith_rad) {
  const double at_deg = std::clamp(zenith_rad / deg, 0.0, sun_nodes_deg.back());
  const auto above = std::upper_bound(sun_nodes_deg.begin() + 1, sun_nodes_deg.end() - 1, at_deg);
  const auto node = std::size_t(above - sun_nodes_deg.begin()) - 1;
  return {node, (at_deg - sun_nodes_deg[node]) / (sun_nodes_deg[node + 1] - sun_nodes_deg[node])};
}

/// A line of sight, cut into pieces.
struct Place {
  double along_m, air_m;  // from the tangent place; metres of the sea's air in the piece
  AirColumns::Level level;
  AirColumn before;  // between it and the observer
};
constexpr int pieces = 128;

struct Sight {
  double nearest_m, piece_m;
  std::vector<Place> places;

  explicit Sight(double tangent_height_m) : nearest_m(limb_earth_radius_m + tangent_height_m) {
    const auto& columns = AirColumns::standard();
    const double top_m = AirColumns::top_m;
    const double farthest_m = std::sqrt((top_m - tangent_height_m) *
                                        (top_m + tangent_height_m + 2 * limb_earth_radius_m));
    piece_m = 2.0 * farthest_m / pieces;
    AirColumn before, last;
    for (int i = 0; i < pieces; ++i) {
      const double s = -farthest_m + (i + 0.5) * piece_m;
      const double height_m = std::hypot(nearest_m, s) - limb_earth_radius_m;
      const double air_m = relative_density(height_m) * piece_m;
      const AirColumn here{air_m / columns.column_m(), ozone_density(height_m) * piece_m};
      before.air += 0.5 * (last.air + here.air);
      before.ozone += 0.5 * (last.ozone + here.ozone);
      last = here;
      places.push_back({s, air_m, columns.level(height_m), before});
    }
  }

  double scattered(const ScatteredSunlight& sunlight, double sun_zenith_rad,
                   double towards_sun) const {
    const auto& columns = AirColumns::standard();
    const double up = std::cos(sun_zenith_rad), ahead = std::sin(sun_zenith_rad) * towards_sun;
    double light = 0.0;
    for (const Place& place : places) {
      const double r = limb_earth_radius_m + place.level.height_m;
      const double to_sun_m = nearest_m * up + place.along_m * ahead;
      const double cosine = std::clamp(to_sun_m / r, -1.0, 1.0);
      double lit = 1.0;
      AirColumn column;
      if (cosine >= 0.0) {
        column = columns.upwards(place.level, cosine);
      } else {
        // A piece in which the shadow of the ground begins is lit in part.
        const double passes_m = r * std::sqrt(1.0 - cosine * cosine);
        const double changes_m =
            std::abs(place.along_m - to_sun_m * ahead) / std::max(passes_m, 1.0) * piece_m;
        const double lowest_m = passes_m - limb_earth_radius_m;
        lit = std::clamp(0.5 + lowest_m / std::max(changes_m, 1.0), 0.0, 1.0);
        if (lit == 0.0) continue;
        column = columns.downwards(place.level, cosine, std::max(0.0, lowest_m));
      }
      light += lit * place.air_m *
               sunlight.behind({column.air + place.before.air, column.ozone + place.before.ozone});
    }
    return light;
  }
};

}  // namespace

ErrorBound LimbAir::error(int, const PlanFacts& f) {
  return f.without_light([&](const SkySample&) { return f.limb_air_e; });
}

double LimbAir::cost_s(int level, const PlanFacts& f) {
  return f.scene.limb_in_field ? level * 120e-9 * f.pixels() : 0.0;
}

struct LimbAirTable::Nodes {
  ScatteredSunlight sunlight;
  std::vector<Sight> sights;  // by tangent height
  /// Logarithms, by Sun, azimuth and height; those of one Sun and azimuth are made together.
  std::vector<std::vector<float>> log_scattered =
      std::vector<std::vector<float>>(sun_nodes_deg.size() * azimuths);
  std::unique_ptr<std::once_flag[]> made =
      std::make_unique<std::once_flag[]>(sun_nodes_deg.size() * azimuths);

  explicit Nodes(const Band& band) : sunlight(band) {
    for (std::size_t i = 0; i < tangent_nodes; ++i) sights.emplace_back(tangent_node_m(i));
  }
  const float* of(std::size_t sun, std::size_t azimuth) {
    const std::size_t i = sun * azimuths + azimuth;
    std::vector<float>& here = log_scattered[i];
    std::call_once(made[i], [&] {
      here.resize(tangent_nodes);
      for (std::size_t k = 0; k < tangent_nodes; ++k) {
        const double light =
            sights[k].scattered(sunlight, sun_nodes_deg[sun] * deg, towards_sun_of_node(azimuth));
        here[k] = light > 0.0 ? std::max(darkest_air_log, float(std::log(light))) : darkest_air_log;
      }
    });
    return here.data();
  }
};

LimbAirTable::LimbAirTable(const Band& band) : nodes_(std::make_unique<Nodes>(band)) {}
LimbAirTable::~LimbAirTable() = default;
LimbAirTable::LimbAirTable(LimbAirTable&&) noexcept = default;

double LimbAirTable::integrated(const LimbSun& at) const {
  if (!(at.tangent_height_m >= 0.0 && at.tangent_height_m < top_m)) return 0.0;
  return Sight(at.tangent_height_m).scattered(nodes_->sunlight, at.sun_zenith_rad, at.towards_sun);
}

double LimbAirTable::scattered(const LimbSun& at) const {
  if (!(at.tangent_height_m >= 0.0 && at.tangent_height_m < top_m)) return 0.0;
  if (!(at.sun_zenith_rad < sun_nodes_deg.back() * deg)) return 0.0;
  const TablePlace h = table_place(node_of_tangent(at.tangent_height_m), tangent_nodes);
  const TablePlace z = between_suns(at.sun_zenith_rad);
  const TablePlace a =
      table_place(node_of_towards_sun(std::clamp(at.towards_sun, -1.0, 1.0)), azimuths);
  const auto of = [&](std::size_t sun, std::size_t azimuth) {
    const float* const log = nodes_->of(sun, azimuth) + h.node;
    return std::lerp(double(log[0]), double(log[1]), h.part);
  };
  const double log =
      std::lerp(std::lerp(of(z.node, a.node), of(z.node, a.node + 1), a.part),
                std::lerp(of(z.node + 1, a.node), of(z.node + 1, a.node + 1), a.part), z.part);
  return log > 0.5 * double(darkest_air_log) ? std::exp(log) : 0.0;
}

LimbAirRadiance::LimbAirRadiance(const Band& band, const Vec<Gcrs>& sun_m, const OblateEarth& earth)
    : sun_(unit(sun_m)), stretched_sun_(unit(earth.stretched(sun_m))) {
  static KeptTables<Band, LimbAirTable> tables;
  table_ = tables.of(band, [&] { return LimbAirTable(band); });
  const double au = norm(sun_m) / au_m;
  at_distance_ = 1.0 / (au * au);
}

double LimbAirRadiance::photons_per_s_m2_sr(const LimbLine& line,
                                            const Vec<Gcrs>& direction) const {
  const double height_m = line.tangent_height_m();
  if (line.meets_ground() || !(height_m < LimbAirTable::top_m)) return 0.0;
  // Only the air ahead counts: air along the line falls off as a Gaussian from the lowest place.
  constexpr double scale_height_m = 7e3;
  const double ahead =
      0.5 * std::erfc(line.from_m / std::sqrt(2.0 * line.nearest_m * scale_height_m));
  if (!(ahead > 1e-9)) return 0.0;
  const double cos_zenith =
      std::clamp(dot(line.nearest, stretched_sun_) / line.nearest_m, -1.0, 1.0);
  const double sine = std::sqrt(1.0 - cos_zenith * cos_zenith);
  const LimbSun at{.tangent_height_m = std::max(0.0, height_m),
                   .sun_zenith_rad = std::acos(cos_zenith),
                   .towards_sun = sine > 1e-9 ? dot(line.line, stretched_sun_) / sine : 0.0};
  // Sunlight comes from the Sun and goes against the direction of sight.
  return at_distance_ * ahead * rayleigh_phase(dot(direction, sun_)) * table_->scattered(at) *
         line.true_scale;
}

}  // namespace dmise
