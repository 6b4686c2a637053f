#include "sensors/pipeline/star_layer.h"

#include <algorithm>
#include <array>

#include "core/optics/deposit.h"
#include "core/optics/projection.h"
#include "sensors/pipeline/light.h"
#include "sensors/pipeline/place_costs.h"
#include "sensors/pipeline/star_snapshots.h"
#include "sensors/pipeline/stopwatch.h"

namespace dmise {
namespace {

/// Stars move by less than this between the catalogue's place and the apparent one: refraction at
/// the horizon 0.6 deg, aberration 0.006, Barnard's star over two centuries 0.6.
constexpr double widest_shift_rad = 1.3 * deg;

/// A star's way over the detector.
struct Trail {
  std::uint32_t star = 0;
  Vec<Gcrs> middle;                    // apparent direction in mid exposure
  std::array<PixelPosition, 3> pixel;  // start, middle, end
};

/// Trails of those stars that the projection can image throughout the exposure.
std::vector<Trail> trails_of(const View& view, const StarColumns& columns,
                             const std::vector<std::uint32_t>& stars) {
  const auto& optics = view.sensor().camera.optics;
  const SimTime times[3] = {view.times().start, view.times().middle, view.times().end};
  std::vector<Trail> trails(stars.size());
  std::vector<bool> imaged(stars.size(), true);
  std::vector<Vec<Gcrs>> direction(stars.size());
  for (std::size_t k = 0; k < 3; ++k) {
    view.places(times[k]).stars(columns, stars, direction);
    const auto camera = view.camera_from_gcrs(times[k]);
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const auto pixel = project(optics, camera * direction[i]);
      imaged[i] = imaged[i] && pixel;
      if (pixel) trails[i].pixel[k] = *pixel;
      if (k == 1) trails[i].middle = direction[i];
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < stars.size(); ++i) {
    if (!imaged[i]) continue;
    trails[kept] = trails[i];
    trails[kept++].star = stars[i];
  }
  trails.resize(kept);
  return trails;
}

}  // namespace

/// Stars around the boresight of mid exposure, wide enough for the field to have turned.
std::vector<std::uint32_t> StarLayer::candidates(const View& view, double faintest_v_mag) const {
  const auto boresight = [&](SimTime t) {
    return view.camera_from_gcrs(t).inverse() * Vec<CameraFrame>{0, 0, 1};
  };
  const Vec<Gcrs> middle = boresight(view.times().middle);
  const double turned = std::max(angle_rad(middle, boresight(view.times().start)),
                                 angle_rad(middle, boresight(view.times().end)));
  std::vector<std::uint32_t> found;
  query_cone(map_->stars, map_->index, middle,
             half_diagonal_rad(view.sensor().camera.optics) + turned + widest_shift_rad,
             faintest_v_mag, found);
  return found;
}

StarLayer::StarLayer(const SensorConfig& sensor, std::shared_ptr<const StarMap> map)
    : map_(std::move(map)),
      light_(sensor.camera.band),
      faintest_filled_v_mag_(dmise::faintest_filled_v_mag(map_->stars)) {}

std::uint32_t StarLayer::draw(const View& view, OpticsStage& optics, const Screen& screen,
                              RateImage& image, double faintest_v_mag,
                              std::vector<StarTruth>* truth, EffectTimes& times) const {
  const auto& exposure = view.times();
  const auto& stars = map_->stars;
  const StarColumns columns{.epoch_jyear = stars.epoch_jyear,
                            .ra_rad = stars.ra_rad,
                            .dec_rad = stars.dec_rad,
                            .pm_ra_cosdec_rad_per_yr = stars.pm_ra_cosdec_rad_per_yr,
                            .pm_dec_rad_per_yr = stars.pm_dec_rad_per_yr,
                            .parallax_rad = stars.parallax_rad};
  std::vector<std::uint32_t> found;
  std::vector<Trail> trails;
  std::vector<Arc> arcs;
  {
    Stopwatch timing(times[Effect::stars]);
    found = candidates(view, faintest_v_mag);
    trails = trails_of(view, columns, found);
  }
  times[Effect::stars] -= add_place_costs(view, columns, found, 3 * found.size(), times);
  times[Effect::stars] = std::max(0.0, times[Effect::stars]);
  {
    Stopwatch timing(times[Effect::earth_occultation]);
    const Hidden hidden(view, exposure.middle);
    std::erase_if(trails, [&](const Trail& t) { return hidden.direction(t.middle); });
  }
  const int snapshots = view.sensor().effects.snapshots();
  const Light light(view);
  std::vector<double> transmission(trails.size());
  {
    Stopwatch timing(times[Effect::extinction]);
    for (std::size_t i = 0; i < trails.size(); ++i)
      transmission[i] = light.air_transmission(trails[i].middle, stars.bv[trails[i].star]);
  }
  {
    Stopwatch timing(times[Effect::clouds]);
    for (std::size_t i = 0; i < trails.size(); ++i)
      transmission[i] *= light.cloud_transmission(trails[i].middle);
  }
  {
    Stopwatch timing(times[Effect::scintillation]);
    for (std::size_t i = 0; i < trails.size(); ++i)
      transmission[i] *=
          light.flicker(trails[i].middle, Light::Flickering::star, stars.id[trails[i].star]);
  }
  {
    Stopwatch timing(times[Effect::stars]);
    const double electrons_per_rate = light.electrons_per_photon_m2() * exposure.seconds();
    const auto& camera = view.sensor().camera.optics;
    arcs.reserve(trails.size());
    for (std::size_t i = 0; i < trails.size(); ++i) {
      const auto& t = trails[i];
      arcs.push_back({t.pixel[0], t.pixel[1], t.pixel[2],
                      light_.photons_per_s_m2(stars.v_mag[t.star], stars.bv[t.star]) *
                          electrons_per_rate * transmission[i] *
                          (snapshots ? 1.0 : relative_illumination(camera, t.pixel[1]))});
    }
  }
  std::vector<Deposited> deposited;
  {
    Stopwatch timing(times[Effect::psf]);
    if (snapshots) {
      std::vector<std::uint32_t> drawn;
      std::vector<double> signal_e;
      for (std::size_t i = 0; i < arcs.size(); ++i) {
        drawn.push_back(trails[i].star);
        signal_e.push_back(arcs[i].signal_e);
      }
      deposited =
          draw_star_snapshots(view, columns, drawn, signal_e, snapshots, optics, screen, image);
    } else if (screen.empty()) {
      deposited = optics.add(arcs, image);
    } else {
      std::vector<Arc> free;
      std::vector<std::size_t> star;
      for (std::size_t i = 0; i < arcs.size(); ++i)
        for (const Arc& part : screen.past({&arcs[i], 1})) {
          free.push_back(part);
          star.push_back(i);
        }
      deposited.resize(arcs.size());
      const auto parts = optics.add(free, image);
      for (std::size_t k = 0; k < parts.size(); ++k)
        deposited[star[k]] = deposited[star[k]] + parts[k];
    }
  }
  std::uint32_t inside = 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (deposited[i].signal_e <= 0.0) continue;
    ++inside;
    const std::uint32_t star = trails[i].star;
    if (truth)
      truth->push_back({stars.id[star], stars.v_mag[star], stars.bv[star], deposited[i].x_px,
                        deposited[i].y_px, deposited[i].signal_e});
  }
  return inside;
}

}  // namespace dmise
