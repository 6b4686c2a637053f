#include "sensors/survey/exposure_forecast.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/units.h"
#include "core/detection/known/catalogue_sky.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "core/score/matched_filter.h"
#include "core/sky/air/airmass.h"
#include "sensors/forecast/detection_limit.h"
#include "sensors/objects/object_sampler.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/objects/state_window_source.h"
#include "sensors/sky/field_stars.h"
#include "sensors/sky/sky_light.h"
#include "sensors/sky/thermal_optics.h"
#include "sensors/survey/trail_in_frame.h"

namespace dmise {
namespace {

/// Samples of a trail whose light changes by more than a half; others have three.
constexpr std::size_t many_samples = 33;
constexpr double abrupt_ratio = 0.5;

DrawnStars drawn_of(const SurveyScene& scene, const SensorConfig& sensor) {
  if (!scene.stars() || !sensor.effects.has(StarBackground::facts)) return {};
  const double faintest_v_mag = scene.scenario().faintest_star_mag;
  return FieldStars(sensor, scene.stars(), faintest_v_mag).drawn(faintest_v_mag, sensor.effects);
}

/// Sets the lengths of a look that compare its trail with a star's at its centroid.
void compare_with_star(ExpectedDetection& look, const std::vector<ObjectSample>& samples,
                       const Optics& optics, const ExposureInstant& start,
                       const ExposureInstant& middle, const ExposureInstant& end) {
  const auto &a = samples.front().pixel, &b = samples.back().pixel;
  const auto direction = unproject(optics, look.centroid);
  if (!a || !b || !direction) return;
  const Vec<Gcrs> star = middle.camera.inverse() * *direction;
  const auto star_a = project(optics, start.camera * star),
             star_b = project(optics, end.camera * star);
  if (!star_a || !star_b) return;
  const double x = b->x_px - a->x_px, y = b->y_px - a->y_px;
  const double star_x = star_b->x_px - star_a->x_px, star_y = star_b->y_px - star_a->y_px;
  look.star_px = std::hypot(star_x, star_y);
  // Trails have no direction.
  look.unlike_px = std::min(std::hypot(x - star_x, y - star_y), std::hypot(x + star_x, y + star_y));
}

}  // namespace

ExposureForecaster::ExposureForecaster(const SurveyScene& scene, const SensorConfig& sensor)
    : scene_(scene),
      sensor_(sensor),
      shapes_(scene.scenario().own_objects, sensor.camera.band, sensor.effects,
              models_of(scene.scenario().objects)),
      noise_(sensor, scene.scenario().seed),
      blur_(sensor),
      drawn_(drawn_of(scene, sensor)),
      complete_to_v_mag_(scene.stars() ? CatalogueSky(scene.stars()).complete_to_v_mag()
                                       : -std::numeric_limits<double>::infinity()) {
  for (const std::size_t i : needed_objects(sensor, *scene.roster()))
    needed_.push_back(std::uint32_t(i));
  if (std::holds_alternative<SiteConfig>(sensor.place))
    mask_sine_ = std::sin(sensor.mask_deg * deg);
}

std::optional<ExposureForecast> ExposureForecaster::of(
    const FrameTimes& commanded, std::span<const std::uint32_t> objects) const {
  ExposureForecast out;
  std::vector<std::uint32_t> all(objects.begin(), objects.end());
  all.insert(all.end(), needed_.begin(), needed_.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const ExposureSpan span = exposure_span(sensor_, commanded);
  const StateWindow window = window_of_some(scene_.roster(), scene_.environment(span.start),
                                            scene_.environment(commanded.middle)->earth, span,
                                            std::move(all), scene_.source());
  for (const std::uint32_t i : needed_)
    for (const SimTime t : {span.start, commanded.start, commanded.end, span.end})
      if (!window.has_state(i, t)) return std::nullopt;
  const View view(sensor_, commanded, window, scene_.scenario().seed);
  if (view.shutter_closed()) {
    out.closed = true;
    return out;
  }
  const FrameTimes& times = view.times();
  const Optics& optics = sensor_.camera.optics;
  const ObjectSampler sampler(view, &shapes_);
  const ExposureInstant start(view, times.start), middle(view, times.middle), end(view, times.end);
  const Vec<Gcrs> up = view.up(times.middle);
  const EarthShadow shadow(view.environment().sun_m, view.surface());
  const bool draws = sensor_.effects.has(SpaceObjects::facts);
  const bool has_sky = sensor_.effects.has(SkyBackground::facts);
  std::optional<SkyModel> sky;  // made for the first object with light
  const auto gcrs_from_camera = middle.camera.inverse();
  const auto enu_from_gcrs = view.enu_from_gcrs(times.middle);
  const auto itrs_from_gcrs = view.earth().itrs_from_gcrs(times.middle);
  const Throughput throughput(view);
  const double electrons_per_photon = throughput.electrons_per_photon_m2() * times.seconds();
  const PixelFunction warm_e = thermal_optics_electrons(view);
  const auto sky_at = [&](const PixelPosition& pixel) {
    const auto direction = unproject(optics, pixel);
    if (!direction) return 0.0;
    const double heat_e = warm_e(pixel.x_px, pixel.y_px);
    if (!has_sky) return heat_e;
    if (!sky) sky.emplace(sky_over(view, drawn_));
    return heat_e + sky->photons_per_s_m2_sr(enu_from_gcrs * (gcrs_from_camera * *direction)) *
                        electrons_per_photon * pixel_solid_angle_sr(optics, pixel) *
                        view.illumination(pixel);
  };
  const double zero_point_mag = throughput.zero_point_mag();
  const double extinction_mag = throughput.extinction_mag_per_airmass();
  // Light above which the catalogue knows every star, in the direction of `line`.
  const auto complete_e = [&](const Vec<Gcrs>& line) {
    const double dimmed_mag =
        view.on_ground() ? extinction_mag * airmass(elevation_over(up, unit(line))) : 0.0;
    return times.seconds() *
           std::pow(10.0, 0.4 * (zero_point_mag - dimmed_mag - complete_to_v_mag_));
  };
  // No pixel has less noise: what is too faint with it needs no sky.
  const double min_noise_e = noise_.noise_e(0.0);

  std::vector<ObjectSample> samples;
  for (const std::uint32_t object : objects) {
    if (view.platform() == object || !window.has_state(object, times.start) ||
        !window.has_state(object, times.middle) || !window.has_state(object, times.end))
      continue;
    const Motion motion = window.motion(object, times.middle);
    const Vec<Gcrs> line = motion.position_m - middle.observer.position_m;
    if (!(dot(line, line) > 1.0) || dot(up, line) < mask_sine_ * norm(line)) continue;
    samples.assign({sampler.sample(object, start), sampler.sample(object, middle),
                    sampler.sample(object, end)});
    if (samples[1].pixel && in_frame(optics, *samples[1].pixel) &&
        !(middle.earth && middle.earth->hides_object(motion.position_m, unit(line)))) {
      ++out.in_field;
      out.sunlit += shadow.sunlit_fraction(motion.position_m) >= lit_fraction;
    }
    double least = samples[0].electrons_per_s, most = least;
    for (const auto& s : samples) {
      least = std::min(least, s.electrons_per_s);
      most = std::max(most, s.electrons_per_s);
    }
    if (!draws || !(most > 0.0)) continue;
    TrailInFrame trail = trail_in_frame(samples, times.seconds(), optics);
    if (!(trail.signal_e > 0.0)) continue;
    const auto look_at = [&](const TrailInFrame& lit) {
      ExpectedDetection look{.object = object,
                             .signal_e = lit.signal_e,
                             .length_px = lit.length_px,
                             .star_known = lit.signal_e >= complete_e(line),
                             .centroid = lit.centroid};
      compare_with_star(look, samples, optics, start, middle, end);
      return look;
    };
    ExpectedDetection look = look_at(trail);
    const double blur_px = blur_.sigma_px(norm(line));
    const double sigma_px = std::sqrt(std::max(0.0, blur_px * blur_px - 1.0 / 12));  // no pixel
    look.snr = matched_filter_snr({trail.signal_e, trail.length_px, min_noise_e, sigma_px});
    const bool telling = look.snr >= detection_limits::min_snr ||
                         detection_probability(scene_.model(), look.trail()) >= min_probability;
    if (least < abrupt_ratio * most && telling) {
      samples.clear();
      for (std::size_t k = 0; k < many_samples; ++k)
        samples.push_back(sampler.sample(
            object, ExposureInstant(view, times.at(double(k) / double(many_samples - 1)))));
      trail = trail_in_frame(samples, times.seconds(), optics);
      if (!(trail.signal_e > 0.0)) continue;
      look = look_at(trail);
    }
    const auto under = to_spherical(itrs_from_gcrs * motion.position_m);
    look.longitude_rad = under[0];
    look.latitude_rad = under[1];
    const double sky_e = telling ? sky_at(trail.centroid) : 0.0;
    look.noise_e = noise_.noise_e(sky_e);
    look.snr = 0.0;  // on a saturated sky
    if (sky_e < noise_.full_sky_e())
      look.snr = matched_filter_snr({look.signal_e, look.length_px, look.noise_e, sigma_px});
    if (telling) look.probability = detection_probability(scene_.model(), look.trail());
    out.looks.push_back(look);
  }
  return out;
}

}  // namespace dmise
