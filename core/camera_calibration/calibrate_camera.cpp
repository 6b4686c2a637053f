#include "core/camera_calibration/calibrate_camera.h"

#include <algorithm>
#include <cmath>

#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/camera_calibration/detector/detector_calibration.h"
#include "core/camera_calibration/star_frames.h"
#include "core/ingest/raw_frame.h"
#include "core/optics/psf_table.h"
#include "core/photometry/band.h"
#include "core/photometry/magnitude.h"

namespace dmise {
namespace {

constexpr double default_pitch_m = 1e-5, default_focal_m = 1.0;
constexpr double default_focal_ratio = 4.0;

/// A number of the optics that no frame measures: the user's, a header's, else a default.
void add_stated(const std::string& key, const std::string& unit, std::optional<double> stated,
                std::optional<double> header, double assumed, CameraCalibration& camera) {
  const ValueOrigin origin = stated   ? ValueOrigin::stated
                             : header ? ValueOrigin::header
                                      : ValueOrigin::assumed;
  const std::string how = stated ? "" : header ? "of a frame" : "nothing tells it";
  camera.quantities.push_back({"optics." + key, unit, stated.value_or(header.value_or(assumed)),
                               std::nullopt, 0, origin, how});
  if (origin == ValueOrigin::assumed)
    camera.notes.push_back(formatted("%s: nothing tells it: %g%s is assumed", key.c_str(), assumed,
                                     unit.empty() ? "" : (" " + unit).c_str()));
}

void add_measured(const std::string& key, const std::string& unit, MeasuredValue value, int frames,
                  const std::string& how, CameraCalibration& camera) {
  camera.quantities.push_back(
      {"optics." + key, unit, value.value, value.sigma, frames, ValueOrigin::measured, how});
}

/// Collecting area of an aperture of 1 m, and electrons a second of a V of 0 with all light
/// passing.
double electrons_of_all_light(const StatedCamera& stated, const Band& band, double aperture_m) {
  const double obscuration = stated.obscuration.value_or(0.0);
  return sunlight_photons_per_s_m2(0.0, band) * pi / 4 * aperture_m * aperture_m *
         (1 - obscuration * obscuration) * stated.quantum_efficiency.value_or(1.0);
}

/// The share of light that passes by the zero point; or the aperture, if that is not known and
/// either the share is or the assumed aperture is too small for the stars.
void add_light(const CalibrationSet& set, const StatedCamera& stated, const StarMeasurement& stars,
               CameraCalibration& camera) {
  const double focal_m = camera.find("optics.focal_length_m")->value;
  const auto header_m = set.facts().aperture_m;
  const auto band = filter_named(stated.band);
  const double share = stated.transmission.value_or(1.0);
  if (stars.zero_point_mag)
    camera.quantities.push_back({"zero_point_mag", "mag", stars.zero_point_mag->value,
                                 stars.zero_point_mag->sigma, stars.frames, ValueOrigin::measured,
                                 "of 1 e-/s on the axis"});
  if (!stars.zero_point_mag || !band) {
    add_stated("aperture_m", "m", stated.aperture_m, header_m, focal_m / default_focal_ratio,
               camera);
    add_stated("transmission", "", stated.transmission, std::nullopt, 1.0, camera);
    return;
  }
  const double electrons = std::pow(10.0, 0.4 * stars.zero_point_mag->value);
  const double relative = 0.4 * std::log(10.0) * stars.zero_point_mag->sigma;
  const std::string how = formatted("zero point %.4f +- %.2g mag of 1 e-/s%s",
                                    stars.zero_point_mag->value, stars.zero_point_mag->sigma,
                                    stars.with_air ? ", dimmed by the air of the frames" : "");
  const double known_m =
      stated.aperture_m.value_or(header_m.value_or(focal_m / default_focal_ratio));
  const double passes = electrons / electrons_of_all_light(stated, *band, known_m);
  const bool assumed_m = !stated.aperture_m && !header_m;
  if ((stated.transmission && !stated.aperture_m) || (assumed_m && passes > 1)) {
    const double aperture_m =
        std::sqrt(electrons / (electrons_of_all_light(stated, *band, 1.0) * share));
    add_measured("aperture_m", "m", {aperture_m, 0.5 * relative * aperture_m}, stars.frames, how,
                 camera);
    add_stated("transmission", "", stated.transmission, std::nullopt, 1.0, camera);
    return;
  }
  add_stated("aperture_m", "m", stated.aperture_m, header_m, focal_m / default_focal_ratio, camera);
  if (passes > 1) {
    camera.notes.push_back(
        formatted("transmission: stars are brighter than the aperture can collect: %.3g; the file "
                  "has 1",
                  passes));
    camera.quantities.push_back(
        {"optics.transmission", "", 1.0, std::nullopt, 0, ValueOrigin::assumed, how});
    return;
  }
  add_measured("transmission", "", {passes, relative * passes}, stars.frames, how, camera);
}

/// The coefficients of the lens by its stars; comments, where these show none.
void add_distortion(const StarMeasurement& stars, CameraCalibration& camera) {
  if (!stars.lens) return;
  const LensFit& lens = *stars.lens;
  for (std::size_t k = 0; k < lens.coefficients.size(); ++k) {
    add_measured("distortion.k" + std::to_string(k + 1), "", lens.coefficients[k], stars.frames,
                 formatted("stars, %.2g px rms from the lens", lens.rms_px), camera);
    if (!lens.distorted) camera.quantities.back().origin = ValueOrigin::insignificant;
  }
}

/// FWHM [px] that a camera file has of a Gaussian's variance: diffraction comes on top there.
MeasuredValue fwhm_of_variance(MeasuredValue px2, const CameraCalibration& camera) {
  const auto number = [&](const char* key) { return camera.find(key)->value; };
  const Optics optics{.focal_length_m = number("optics.focal_length_m"),
                      .aperture_m = number("optics.aperture_m"),
                      .pixel_pitch_m = number("optics.pixel_pitch_m")};
  const auto band = filter_named(camera.band);
  const double diffraction_px = diffraction_sigma_px(optics, band.value_or(Band{}).centre_m);
  const double variance = px2.value - diffraction_px * diffraction_px;
  constexpr double narrowest_px = 0.3, widest_px = 50.0;
  const double width = fwhm_per_sigma * std::sqrt(std::max(variance, 1e-6));
  return {std::clamp(width, narrowest_px, widest_px),
          0.5 * fwhm_per_sigma * px2.sigma / std::sqrt(std::max(px2.value, 0.02))};
}

/// The width of stars: one for the field, or a table over it where stars show that it changes.
void add_width(const StarMeasurement& stars, CameraCalibration& camera) {
  constexpr double shown_sigmas_of_width = 5.0;
  if (!stars.width) return;
  const LensWidth& width = *stars.width;
  const auto shown = [](MeasuredValue m) {
    return std::abs(m.value) > shown_sigmas_of_width * m.sigma;
  };
  const bool elongated = !width.field.empty() && shown(width.elongation_px2);
  const bool changes = elongated || (!width.field.empty() && shown(width.growth_px2));
  const std::string how = "Gaussian that fits stars best";
  if (!changes) {
    add_measured("psf_fwhm_px", "px", fwhm_of_variance(width.even_px2, camera), stars.width_frames,
                 how + (width.field.empty() ? "" : ", even over the field"), camera);
    return;
  }
  CameraTable table{.key = "optics.psf_field",
                    .columns = {{"fwhm_radial_px", {}}},
                    .how = how + " in " + counted(std::size_t(stars.width_frames), "frame")};
  if (elongated) table.columns.push_back({"fwhm_tangential_px", {}});
  for (const FieldWidth& at : width.field) {
    table.radius_px.push_back(at.radius_px);
    const auto add = [&](std::size_t column, MeasuredValue px2) {
      table.columns[column].values.push_back(fwhm_of_variance(px2, camera));
    };
    add(0, elongated ? at.radial_px2 : at.mean_px2);
    if (elongated) add(1, at.tangential_px2);
  }
  camera.tables.push_back(std::move(table));
}

void add_optics(const CalibrationSet& set, const StatedCamera& stated, const StarMeasurement& stars,
                CameraCalibration& camera) {
  const CameraFacts& facts = set.facts();
  const auto whole = [&](const char* key, int number) {
    camera.quantities.push_back({std::string("optics.") + key, "px", double(number), std::nullopt,
                                 0, ValueOrigin::header, "of all frames"});
  };
  whole("columns", set.columns());
  whole("rows", set.rows());
  add_stated("pixel_pitch_m", "m", stated.pixel_pitch_m, facts.pixel_pitch_m, default_pitch_m,
             camera);
  const double pitch_m = camera.find("optics.pixel_pitch_m")->value;
  camera.projection = stars.projection;
  if (const auto& focal = stars.focal_length_px)
    add_measured("focal_length_m", "m", {focal->value * pitch_m, focal->sigma * pitch_m},
                 stars.frames, formatted("stars: %.3f +- %.2g px", focal->value, focal->sigma),
                 camera);
  else
    add_stated("focal_length_m", "m", stated.focal_length_m, facts.focal_length_m, default_focal_m,
               camera);
  if (stated.obscuration)
    add_stated("obscuration", "", stated.obscuration, std::nullopt, 0.0, camera);
  add_light(set, stated, stars, camera);
  add_distortion(stars, camera);
  add_width(stars, camera);
}

/// Vignetting as flats show it.
void add_vignetting(const FlatResponse& response, CameraCalibration& camera) {
  constexpr double min_loss = 0.005, min_sigmas = 5.0;
  if (response.field.empty()) return;
  double lowest = 1.0, sigma = 0.0;
  for (const FieldLight& light : response.field)
    if (light.relative.value < lowest) lowest = light.relative.value, sigma = light.relative.sigma;
  if (1 - lowest < std::max(min_loss, min_sigmas * sigma)) return;
  CameraTable table{.key = "optics.vignetting",
                    .columns = {{"relative_illumination", {}}},
                    .how = counted(std::size_t(response.frames), "flat")};
  for (const FieldLight& light : response.field) {
    table.radius_px.push_back(light.radius_px);
    table.columns[0].values.push_back(
        {std::clamp(light.relative.value, 0.0, 1.0), light.relative.sigma});
  }
  camera.tables.push_back(std::move(table));
}

std::string source_text(const CalibrationSet& set) {
  std::string text = "Measured by dmise calibrate from ";
  bool first = true;
  for (const FrameKind kind : {FrameKind::bias, FrameKind::dark, FrameKind::flat, FrameKind::light})
    if (const std::size_t n = set.of(kind).size(); n > 0) {
      text += (first ? "" : ", ") +
              counted(n, name_of(kind),
                      std::string(name_of(kind)) + (kind == FrameKind::bias ? "es" : "s"));
      first = false;
    }
  return text + (set.facts().camera.empty() ? "" : " of " + set.facts().camera);
}

}  // namespace

CameraCalibration calibrate_camera(const std::vector<CalibrationFile>& files,
                                   const FrameChoice& choice, const StatedCamera& stated,
                                   const StarMap* stars, Threads& threads) {
  const CalibrationSet set(files, choice);
  CameraCalibration camera{.name = stated.name.empty() ? "calibrated" : stated.name,
                           .source = source_text(set),
                           .band = stated.band};
  camera.notes = set.notes();
  const DetectorCalibration detector = calibrate_detector(set, threads);
  StarMeasurement by_stars;
  if (stars && !set.of(FrameKind::light).empty())
    by_stars = measure_stars(set, detector, choice, *stars, threads);
  add_optics(set, stated, by_stars, camera);
  camera.notes.insert(camera.notes.end(), by_stars.notes.begin(), by_stars.notes.end());
  add_vignetting(detector.response, camera);
  add_detector(set, detector, stated.quantum_efficiency, camera);
  return camera;
}

}  // namespace dmise
