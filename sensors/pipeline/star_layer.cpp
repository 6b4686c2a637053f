#include "sensors/pipeline/star_layer.h"

#include <array>

#include "core/optics/deposit.h"
#include "core/optics/projection.h"
#include "core/sky/occultation.h"
#include "sensors/pipeline/light.h"

namespace dmise {
namespace {

/// Stars move by less than this between the catalogue's place and the apparent one: refraction at
/// the horizon 0.6 deg, aberration 0.006, Barnard's star over two centuries 0.6.
constexpr double widest_shift_rad = 1.3 * deg;

}  // namespace

StarLayer::StarLayer(const SensorConfig& sensor, std::shared_ptr<const StarMap> map)
    : map_(std::move(map)), light_(sensor.camera.band) {}

std::uint32_t StarLayer::draw(const View& view, const PsfTable& psf, RateImage& image,
                              Threads& threads, double faintest_v_mag,
                              std::vector<StarTruth>* truth) const {
  const auto& sensor = view.sensor();
  const auto& exposure = view.times();
  const auto& stars = map_->stars;
  const std::array<SimTime, 3> times{exposure.start, exposure.middle, exposure.end};

  // Candidates: around the boresight in the middle, wide enough for the field to have turned.
  const auto camera_middle = view.camera_from_gcrs(exposure.middle);
  const Vec<Gcrs> boresight = camera_middle.inverse() * Vec<CameraFrame>{0, 0, 1};
  double turned = 0.0;
  for (const SimTime t : times)
    turned = std::max(turned, angle_rad(boresight, view.camera_from_gcrs(t).inverse() *
                                                       Vec<CameraFrame>{0, 0, 1}));
  const double radius = half_diagonal_rad(sensor.camera.optics) + turned + widest_shift_rad;
  std::vector<std::uint32_t> found;
  query_cone(stars, map_->index, boresight, radius, faintest_v_mag, found);

  // Places at the three times, dropping what the Earth or the horizon hides in the middle.
  const StarColumns columns{.epoch_jyear = stars.epoch_jyear,
                            .ra_rad = stars.ra_rad,
                            .dec_rad = stars.dec_rad,
                            .pm_ra_cosdec_rad_per_yr = stars.pm_ra_cosdec_rad_per_yr,
                            .pm_dec_rad_per_yr = stars.pm_dec_rad_per_yr,
                            .parallax_rad = stars.parallax_rad};
  std::array<std::vector<Vec<Gcrs>>, 3> direction;
  std::array<Rotation<CameraFrame, Gcrs>, 3> camera;
  for (int k = 0; k < 3; ++k) {
    direction[k].resize(found.size());
    view.places(times[k]).stars(columns, found, direction[k]);
    camera[k] = view.camera_from_gcrs(times[k]);
  }
  const Hidden hidden(view, exposure.middle);
  const Light light(view);
  const double seconds = exposure.seconds();
  std::vector<Arc> arcs;
  std::vector<std::uint32_t> drawn;
  arcs.reserve(found.size());
  drawn.reserve(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (hidden.direction(direction[1][i])) continue;
    std::array<std::optional<PixelPosition>, 3> pixel;
    for (int k = 0; k < 3; ++k) pixel[k] = project(sensor.camera.optics, camera[k] * direction[k][i]);
    if (!pixel[0] || !pixel[1] || !pixel[2]) continue;
    const std::uint32_t star = found[i];
    const double signal_e = light_.photons_per_s_m2(stars.v_mag[star], stars.bv[star]) *
                            light.electrons_per_photon_m2() *
                            light.transmission(direction[1][i]) * seconds;
    arcs.push_back({*pixel[0], *pixel[1], *pixel[2], signal_e});
    drawn.push_back(star);
  }
  std::uint32_t inside = 0;
  const auto deposited = deposit(arcs, psf, image, threads);
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (deposited[i].signal_e <= 0.0) continue;
    ++inside;
    const std::uint32_t star = drawn[i];
    if (truth)
      truth->push_back({stars.id[star], stars.v_mag[star], stars.bv[star], deposited[i].x_px,
                        deposited[i].y_px, deposited[i].signal_e});
  }
  return inside;
}

}  // namespace dmise
