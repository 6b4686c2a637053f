#include "bench/validation/brightness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

#include "core/base/algebra/least_squares.h"
#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/photometry/magnitude.h"

namespace dmise {
namespace {

constexpr double bin_s = 1.0;               // length of a mean within a track
constexpr std::uint64_t seed = 1;           // draws the glints
constexpr std::size_t least_of_a_half = 3;  // as many as a phase law has numbers

struct Family {
  const char *model, *what, *file, *source;
  double inclination_deg = 0.0, height_m = 0.0;  // orbit of the satellite, for light curves
  Halves halves = Halves::by_track;
  double target_median_mag = 0.2, target_scatter_mag = 0.0;
};

constexpr std::array<Family, 3> families{{
    {"starlink-v1.5", "Starlink v1.5 by Pomenis", "pomenis_even.csv",
     "Fankhauser, Tyson & Askari 2023, AB, the band taken as V", 0.0, 0.0, Halves::by_time, 0.15,
     0.85},
    {"oneweb", "OneWeb by MMT-9", "mmt_oneweb_1200km.csv.gz",
     "MMT-9, 10 Hz, about V; NASA CARA analysis tools", 87.9, 1200e3},
    {"iridium-next", "Iridium NEXT by MMT-9", "mmt_iridium_next_780km.csv.gz",
     "MMT-9, 10 Hz, about V; NASA CARA analysis tools", 86.4, 780e3},
}};

double mean_of(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double x : values) mean += x / double(values.size());
  return mean;
}

double standard_deviation(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double mean = mean_of(values);
  double square = 0.0;
  for (const double x : values) square += (x - mean) * (x - mean);
  return std::sqrt(square / double(values.size() - 1));
}

double median_or_zero(const std::vector<double>& values) {
  return values.empty() ? 0.0 : median_of(values);
}

/// Magnitude at 1000 km.
double at_range(double mag, const ComparedLight& light) {
  return mag - 5.0 * std::log10(light.range_m / 1e6);
}

using Chosen = std::vector<const ComparedLight*>;

Chosen half_of(const std::vector<ComparedLight>& lights, bool held_out) {
  Chosen half;
  for (const auto& light : lights)
    if (light.held_out == held_out) half.push_back(&light);
  return half;
}

/// What a parabola in phase, fitted to `fitted`, leaves of the magnitudes of `judged`.
double phase_law_scatter_mag(const Chosen& fitted, const Chosen& judged) {
  std::vector<double> a, b;
  for (const auto* light : fitted) {
    a.insert(a.end(), {1.0, light->phase_rad, light->phase_rad * light->phase_rad});
    b.push_back(at_range(light->measured_mag, *light));
  }
  const auto c = least_squares(std::move(a), 3, std::move(b), 1);
  std::vector<double> left;
  for (const auto* light : judged)
    left.push_back(at_range(light->measured_mag, *light) - c[0] - c[1] * light->phase_rad -
                   c[2] * light->phase_rad * light->phase_rad);
  return standard_deviation(left);
}

/// Standard deviation within each track of means over a second of a value; 0 for single exposures.
double within_tracks_mag(const std::map<std::size_t, Chosen>& tracks,
                         const std::function<double(const ComparedLight&)>& value) {
  std::vector<double> all;
  for (const auto& [track, lights] : tracks) {
    std::map<std::int64_t, std::vector<double>> bins;
    for (const auto* light : lights)
      bins[std::int64_t(std::floor(light->time_s / bin_s))].push_back(value(*light));
    std::vector<double> means;
    for (const auto& [bin, values] : bins) means.push_back(mean_of(values));
    if (means.size() >= 3) all.push_back(standard_deviation(means));
  }
  return median_or_zero(all);
}

BrightnessFigures figures_of(const Chosen& half, const Chosen& fitted, bool curves) {
  std::vector<double> differences;
  std::map<std::size_t, Chosen> tracks;
  for (const auto* light : half) {
    differences.push_back(light->difference_mag());
    tracks[light->track].push_back(light);
  }
  std::vector<double> medians;
  for (const auto& [track, lights] : tracks) {
    std::vector<double> of_track;
    for (const auto* light : lights) of_track.push_back(light->difference_mag());
    medians.push_back(median_of(of_track));
  }
  BrightnessFigures f{.lights = half.size(),
                      .tracks = tracks.size(),
                      .median_mag = median_or_zero(differences),
                      .mean_mag = mean_of(differences),
                      .scatter_mag = standard_deviation(differences),
                      .phase_law_scatter_mag = phase_law_scatter_mag(fitted, half),
                      .track_scatter_mag = standard_deviation(medians)};
  if (!curves) return f;
  f.within_measured_mag =
      within_tracks_mag(tracks, [](const ComparedLight& l) { return at_range(l.measured_mag, l); });
  f.within_predicted_mag = within_tracks_mag(
      tracks, [](const ComparedLight& l) { return at_range(l.predicted_mag, l); });
  f.within_difference_mag =
      within_tracks_mag(tracks, [](const ComparedLight& l) { return l.difference_mag(); });
  return f;
}

/// What a V magnitude of sunlight is in the set's system.
double less_v_mag(MagnitudeSystem system) {
  if (system != MagnitudeSystem::ab) return 0.0;
  const Band& v = johnson_v();
  return magnitude_of_light(sunlight_photons_per_s_m2(0.0, v) / ab_zero_point_photons_per_s_m2(v));
}

/// The tracks of a half.
std::vector<PassLightCurve> curves_of(const std::vector<ComparedLight>& lights,
                                      const std::vector<std::uint32_t>& objects, bool held_out,
                                      const ModelLight& model) {
  std::map<std::size_t, std::vector<std::size_t>> tracks;
  for (std::size_t i = 0; i < lights.size(); ++i)
    if (lights[i].held_out == held_out) tracks[lights[i].track].push_back(i);
  std::vector<PassLightCurve> curves;
  for (const auto& [track, points] : tracks) {
    PassLightCurve curve;
    for (const std::size_t i : points) {
      curve.time_s.push_back(lights[i].time_s);
      curve.measured_mag.push_back(at_range(lights[i].measured_mag, lights[i]));
      curve.smooth_mag.push_back(at_range(lights[i].smooth_mag, lights[i]));
    }
    curve.glints_mag = [&lights, &objects, &model, points = points](std::uint64_t of_seed) {
      std::vector<double> mag;
      for (const std::size_t i : points)
        mag.push_back(model.glints_mag(of_seed, objects[i], lights[i].to_sun, lights[i].to_viewer));
      return mag;
    };
    curves.push_back(std::move(curve));
  }
  return curves;
}

FamilyBrightness compare(const Family& family, const std::string& directory, std::size_t every) {
  const bool curves = family.halves == Halves::by_track;
  const std::string path = directory + "/brightness/" + family.file;
  const ObservedSet set =
      curves ? read_light_curves(path, family.inclination_deg * deg, family.height_m)
             : read_exposures(path);
  const auto model = shipped_object_model(family.model);
  const ModelLight light_of(*model);
  const double to_system_mag = less_v_mag(set.system);
  FamilyBrightness result{
      .model = family.model,
      .what = family.what,
      .source = family.source,
      .split = curves ? "even tracks in order of time are fitted, odd ones are held out"
                      : "nights up to that of the middle one are fitted, later ones held out",
      .left_out = set.left_out,
      .worst_rms_m = set.worst_rms_m,
      .target_median_mag = family.target_median_mag,
      .target_scatter_mag = family.target_scatter_mag};
  if (set.lights.empty()) throw ConfigError(path + ": no measurement is in sunlight");
  const std::size_t middle_track = set.lights[(set.lights.size() - 1) / 2].track;
  std::vector<ComparedLight> all;
  std::vector<std::uint32_t> objects;
  for (std::size_t i = 0; i < set.lights.size(); i += curves ? 1 : every) {
    const ObservedLight& seen = set.lights[i];
    const Vec<Gcrs> line = seen.observer_m - seen.scene.position_m;
    ComparedLight light{.track = seen.track,
                        .time_s = seen.scene.time_s,
                        .measured_mag = seen.measured_mag,
                        .range_m = norm(line),
                        .phase_rad = angle_rad(line, seen.scene.sun_m - seen.scene.position_m),
                        .held_out = curves ? seen.track % 2 == 1 : seen.track > middle_track};
    light.smooth_mag = light_of.v_mag(seen, &light.to_sun, &light.to_viewer) + to_system_mag;
    light.predicted_mag =
        light.smooth_mag + light_of.glints_mag(seed, seen.object, light.to_sun, light.to_viewer);
    if (i % every == 0) result.lights.push_back(light);
    all.push_back(light);
    objects.push_back(seen.object);
  }
  const Chosen fitted = half_of(result.lights, false), held_out = half_of(result.lights, true);
  if (std::min(fitted.size(), held_out.size()) < least_of_a_half)
    throw ConfigError(path + formatted(": too few measurements in sunlight: %zu to fit and %zu to "
                                       "judge by, of each at least %zu are needed",
                                       fitted.size(), held_out.size(), least_of_a_half));
  result.fitted = figures_of(fitted, fitted, curves);
  result.held_out = figures_of(held_out, fitted, curves);
  if (curves) {
    result.fitted_power = curve_power(curves_of(all, objects, false, light_of));
    result.held_out_power = curve_power(curves_of(all, objects, true, light_of));
  }
  if (result.target_scatter_mag == 0.0)
    result.target_scatter_mag = 1.2 * result.held_out.phase_law_scatter_mag;
  return result;
}

}  // namespace

ModelLight::ModelLight(const ObjectModel& model)
    : model_(model), facets_(*model.geometry.mesh, johnson_v(), false) {
  if (model.glints) glints_.emplace(*model.glints);
}

double ModelLight::glints_mag(std::uint64_t of_seed, std::uint32_t object, const Vec<Body>& to_sun,
                              const Vec<Body>& to_viewer) const {
  if (!glints_) return 0.0;
  const RngKey key = glint_key(of_seed, model_.name, object);
  return magnitude_of_light(glints_->over_smooth(key, to_sun, to_viewer));
}

double ModelLight::v_mag(const ObservedLight& light, Vec<Body>* to_sun,
                         Vec<Body>* to_viewer) const {
  const auto body_from_gcrs = gcrs_from_body(model_.attitude.model, light.scene).inverse();
  const Vec<Gcrs> sun_m = light.scene.sun_m - light.scene.position_m;
  const Vec<Gcrs> viewer_m = light.observer_m - light.scene.position_m;
  const Vec<Body> sun = unit(body_from_gcrs * sun_m), viewer = unit(body_from_gcrs * viewer_m);
  if (to_sun) *to_sun = sun;
  if (to_viewer) *to_viewer = viewer;
  const double m2_per_sr = model_.panel
                               ? facets_.turned(*model_.panel, sun).reflected_m2_per_sr(sun, viewer)
                               : facets_.reflected_m2_per_sr(sun, viewer);
  const double distance_au = norm(sun_m) / au_m;
  const double share =
      light.sunlit * m2_per_sr / (dot(viewer_m, viewer_m) * distance_au * distance_au);
  return share > 0.0 ? std::min(darkest_mag, sun_v_mag + magnitude_of_light(share)) : darkest_mag;
}

std::vector<FamilyBrightness> compare_brightness(const std::string& directory, std::size_t every) {
  std::vector<FamilyBrightness> all;
  for (const auto& family : families) all.push_back(compare(family, directory, every));
  return all;
}

std::string brightness_csv(const std::vector<FamilyBrightness>& families) {
  std::string text =
      "model,held_out,track,time_s,measured_mag,predicted_mag,range_m,phase_deg,"
      "sun_x,sun_y,sun_z,viewer_x,viewer_y,viewer_z\n";
  for (const auto& family : families)
    for (const auto& l : family.lights)
      text += family.model +
              formatted(",%d,%zu,%.3f,%.4f,%.4f,%.0f,%.4f,%.7f,%.7f,%.7f,%.7f,%.7f,%.7f\n",
                        int(l.held_out), l.track, l.time_s, l.measured_mag, l.predicted_mag,
                        l.range_m, l.phase_rad / deg, l.to_sun.x, l.to_sun.y, l.to_sun.z,
                        l.to_viewer.x, l.to_viewer.y, l.to_viewer.z);
  return text;
}

}  // namespace dmise
