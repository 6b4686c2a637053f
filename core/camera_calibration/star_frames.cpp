#include "core/camera_calibration/star_frames.h"

#include <algorithm>
#include <cmath>

#include "core/astrometry/solve_frame.h"
#include "core/astrometry/star_sources.h"
#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/numeric/chi_square.h"
#include "core/base/numeric/quantile.h"
#include "core/camera_calibration/star_detector.h"
#include "core/camera_calibration/star_zero_point.h"
#include "core/detection/known/atmosphere.h"
#include "core/ingest/any_frame.h"
#include "core/sky/air/airmass.h"
#include "core/sky/variables/variable_stars.h"

namespace dmise {
namespace {

constexpr double fwhm_of_sigma = 2.354820045;
const double mag_per_relative = 2.5 / std::log(10.0);
constexpr double disagreeing_sigmas = 3.1;

/// Weighted mean; its deviation is scaled by the scatter where that is significant.
std::optional<MeasuredValue> joined(const std::vector<MeasuredValue>& values) {
  double weights = 0.0, sum = 0.0, chi2 = 0.0;
  for (const MeasuredValue& m : values) {
    const double weight = 1 / std::max(m.sigma * m.sigma, 1e-24);
    weights += weight;
    sum += weight * m.value;
  }
  if (!(weights > 0)) return std::nullopt;
  const double mean = sum / weights, degrees = double(values.size()) - 1;
  for (const MeasuredValue& m : values)
    chi2 += std::pow(m.value - mean, 2) / std::max(m.sigma * m.sigma, 1e-24);
  const bool disagree = degrees > 0 && chi2 > chi_square_of_normal(disagreeing_sigmas, degrees);
  return MeasuredValue{mean, std::sqrt((disagree ? chi2 / degrees : 1.0) / weights)};
}

/// What the frames of a set have shown so far.
struct StarValues {
  std::vector<MeasuredValue> focal;
  std::vector<MeasuredValue> zero_point;  // by single frames, from the light that solving measures
  std::vector<GaussianStar> images;
  std::vector<StarZeroPoint> light;   // within apertures
  double extinction_sigma_mag = 0.0;  // greatest error of what extinction adds to the light
  std::vector<LensFrame> lens;
  Projection projection;
};

/// A frame with its stars.
struct StarFrame {
  const CalibrationFrame& from;
  Frame frame;
  StarPixels pixels;
  std::vector<FoundStar> places;
  double fwhm_px = 0.0;  // width of the Gaussians, before pixels
};

/// The place of each match of a plate; the number of places if there is none.
std::vector<std::size_t> places_of(const StarFrame& in, const FrameSolution& solution) {
  constexpr double same_px = 0.7;
  std::vector<std::size_t> out;
  for (const PlateMatch& m : solution.plate.matches) {
    double least = same_px;
    out.push_back(in.places.size());
    for (std::size_t i = 0; i < in.places.size(); ++i) {
      const PixelPosition d = in.places[i].at - m.pixel;
      if (const double far = std::hypot(d.x_px, d.y_px); far < least) least = far, out.back() = i;
    }
  }
  return out;
}

/// Places that are no star of a plate.
std::vector<FoundStar> places_without(const StarFrame& in, std::span<const std::size_t> stars) {
  std::vector<char> is_star(in.places.size() + 1, 0);
  for (const std::size_t place : stars) is_star[place] = 1;
  std::vector<FoundStar> out;
  for (std::size_t i = 0; i < in.places.size(); ++i)
    if (!is_star[i]) out.push_back(in.places[i]);
  return out;
}

/// Places of a plate's stars; NaN where it images none.
std::vector<PixelPosition> places_of_stars(const PlateSolution& plate) {
  std::vector<PixelPosition> out;
  for (const SeenStar& star : plate.stars)
    out.push_back(
        plate.fit.model.pixel(star.direction).value_or(PixelPosition{std::nan(""), std::nan("")}));
  return out;
}

/// Light of the catalogue's other stars within a distance of a star, in its own.
double light_within(const PlateSolution& plate, std::span<const PixelPosition> at, std::size_t star,
                    double radius_px) {
  double sum = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const PixelPosition d = at[i] - at[star];
    if (i != star && std::hypot(d.x_px, d.y_px) < radius_px)
      sum += std::pow(10.0, 0.4 * double(plate.stars[star].v_mag - plate.stars[i].v_mag));
  }
  return sum;
}

/// Which places are stars of the catalogue without another one near: stars a width or two apart
/// are found as one place, which is wider than a star.
std::vector<char> single_stars(const StarFrame& in, const FrameSolution& solution) {
  constexpr double most_of_others = 0.002;
  const auto at = places_of_stars(solution.plate);
  const auto places = places_of(in, solution);
  std::vector<char> single(in.places.size(), 0);
  for (std::size_t k = 0; k < places.size(); ++k)
    if (solution.plate.fit.used[k] && places[k] < single.size())
      single[places[k]] = light_within(solution.plate, at, solution.plate.matches[k].star,
                                       1.5 * window_radius_px(in.fwhm_px)) < most_of_others;
  return single;
}

/// Images of stars: of those that the catalogue has, if the frame was solved.
std::vector<GaussianStar> images_of(const StarFrame& in, const FrameSolution* solution) {
  auto images = measure_star_images(in.pixels, in.places, in.fwhm_px);
  if (!solution) return images;
  const auto single = single_stars(in, *solution);
  std::erase_if(images, [&](const GaussianStar& image) { return !single[image.star]; });
  return images;
}

/// Sets the width halfway to the corners, which makes the window of the fits: the same for any
/// distribution of the bright stars over the field. A star that is no Gaussian is the wider, the
/// wider its window, so both are found together.
void set_width(const FrameSolution* solution, StarFrame& in) {
  constexpr int rounds = 6;
  constexpr double narrowest_px = 0.8, widest_px = 50.0, same = 2e-4;
  for (int round = 0; round < rounds; ++round) {
    const auto variance =
        usual_variance_px2(images_of(in, solution), in.pixels.columns, in.pixels.rows);
    if (!variance) return;
    const double fwhm_px =
        std::clamp(fwhm_of_sigma * std::sqrt(std::max(*variance, 0.02)), narrowest_px, widest_px);
    const bool found = std::abs(fwhm_px - in.fwhm_px) < same * fwhm_px;
    in.fwhm_px = fwhm_px;
    if (found) return;
  }
}

/// Light of a star's neighbours in the catalogue within an aperture, in its own.
double light_of_neighbours(const PlateSolution& plate, std::span<const PixelPosition> at,
                           std::size_t star, double fwhm_px) {
  const double radius_px = aperture_widths * fwhm_px;
  double sum = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const PixelPosition d = at[i] - at[star];
    const double beyond = (std::hypot(d.x_px, d.y_px) - radius_px) / fwhm_px;
    if (i == star || !(beyond < 1.5)) continue;
    // Share of a Gaussian past an edge as far away; its deviation is the width over 2.355.
    const double within = 0.5 * std::erfc(beyond * fwhm_of_sigma / std::sqrt(2.0));
    sum += within * std::pow(10.0, 0.4 * double(plate.stars[star].v_mag - plate.stars[i].v_mag));
  }
  return sum;
}

/// Adds the zero points on the axis that stars show by their light within apertures.
void add_light(const StarFrame& in, const FrameSolution& solution, const StarDetector& detector,
               const StarMap& stars, StarValues& values) {
  constexpr double min_snr_of_light = 20.0, most_of_neighbours = 0.1,
                   uncertain_beside = 0.1;  // by their colours
  const ZeroPoint& z = *solution.zero_point;
  const FrameHeader& h = in.frame.header;
  const PlateSolution& plate = solution.plate;
  const auto places = places_of(in, solution);
  const auto stars_at = places_of_stars(plate);
  const auto strangers = places_without(in, places);
  std::vector<PixelPosition> all_at = stars_at;
  for (const FoundStar& place : in.places) all_at.push_back(place.at);
  double airmasses = 0.0, shown = 0.0;
  for (std::size_t k = 0; k < plate.matches.size(); ++k) {
    const SeenStar& star = plate.stars[plate.matches[k].star];
    if (!plate.fit.used[k] || places[k] >= in.places.size() ||
        stars.stars.colour(star.index).kind != StarKind::most ||
        (stars.variables && stars.variables->find(star.index)))
      continue;
    const double beside = light_of_neighbours(plate, stars_at, plate.matches[k].star, in.fwhm_px);
    if (beside > most_of_neighbours) continue;
    const auto light =
        aperture_light(in.pixels, in.places[places[k]], strangers, all_at, in.fwhm_px,
                       [&](PixelPosition at) { return detector.illumination(at); });
    if (!light || !(light->flux_e > min_snr_of_light * light->sigma_e)) continue;
    const double x =
        h.site ? airmass(std::asin(std::clamp(dot(star.direction, unit(zenith_of(h))), -1.0, 1.0)))
               : 0.0;
    const double rate =
        light->flux_e / (1 + beside) / detector.illumination(plate.matches[k].pixel) / h.exposure_s;
    values.light.push_back(
        {double(star.v_mag) + 2.5 * std::log10(rate) + z.extinction_mag_per_airmass * x,
         mag_per_relative * std::hypot(light->sigma_e / light->flux_e, uncertain_beside * beside),
         double(star.bv), values.lens.size()});
    airmasses += x, ++shown;
  }
  if (z.extinction_fitted && shown > 0)
    values.extinction_sigma_mag =
        std::max(values.extinction_sigma_mag, airmasses / shown * z.sigma(2));
}

void add_solution(const StarFrame& in, const FrameSolution& solution, const StarDetector& detector,
                  const StarMap& stars, StarValues& values, StarMeasurement& out) {
  const PlateFit& fit = solution.plate.fit;
  ++out.frames;
  out.projection = fit.model.projection.name();
  values.projection = fit.model.projection;
  if (fit.free.focal_length)
    values.focal.push_back(
        {fit.model.focal_length_px, std::sqrt(fit.variance(3)) * fit.model.focal_length_px});
  LensFrame lens{fit.model.camera_from_gcrs, {}};
  for (std::size_t k = 0; k < solution.plate.matches.size(); ++k)
    if (fit.used[k]) lens.matches.push_back(solution.plate.matches[k]);
  values.lens.push_back(std::move(lens));
  if (fit.free.centre)
    out.notes.push_back(
        formatted("%s: the axis is at pixel (%.1f, %.1f); a camera's is in the middle",
                  in.from.name().c_str(), fit.model.centre.x_px, fit.model.centre.y_px));
  if (!solution.zero_point) return;
  const ZeroPoint& z = *solution.zero_point;
  values.zero_point.push_back({z.zero_point_mag, std::max(z.sigma(0), 1e-4)});
  add_light(in, solution, detector, stars, values);
  out.with_air = out.with_air || !z.extinction_fitted;
}

StarFrame star_frame(const CalibrationFrame& from, const FrameChoice& choice,
                     const StarDetector& detector, Threads& threads) {
  FrameChoice one = choice;
  one.plane = from.plane;
  StarFrame in{.from = from, .frame = read_any_frame(from.path, one, threads)};
  detector.set_facts(in.frame);
  in.pixels = detector.pixels(from, in.frame);
  return in;
}

void measure_frame(StarFrame& in, const StarDetector& detector, const StarMap& stars,
                   Threads& threads, StarValues& values, StarMeasurement& out) {
  const FrameHeader& h = in.frame.header;
  const StarSourceSettings search{
      .gain_e_per_dn = h.gain_e_per_dn,
      .saturation_dn = h.saturation_dn - 5 * h.read_noise_e / h.gain_e_per_dn,
      .psf_fwhm_px = h.psf_fwhm_px};
  for (const PlateSource& s : find_star_sources(in.frame.counts, search, threads))
    in.places.push_back({{s.x_px, s.y_px}, s.flux, s.saturated});
  const auto shape = measure_star_shape(in.frame.counts, search, threads);
  const bool sharp = shape && !(shape->length_px > 0);
  if (shape) in.fwhm_px = fwhm_of_sigma * shape->sigma_px;
  const bool blind = h.unknown.has(FrameFact::pointing) && !h.observation.ra_rad;
  std::optional<FrameSolution> solution;
  try {
    solution = solve_frame(in.frame, stars, {.blind = blind}, threads);
  } catch (const Error& error) {
    const std::string reason = error.what();
    out.notes.push_back(reason.starts_with(in.from.path) ? reason : in.from.name() + ": " + reason);
  }
  if (sharp) {
    const FrameSolution* known = solution ? &*solution : nullptr;
    set_width(known, in);
    for (GaussianStar image : images_of(in, known)) {
      image.frame = std::size_t(out.width_frames);
      values.images.push_back(image);
    }
    ++out.width_frames;
  }
  if (solution) add_solution(in, *solution, detector, stars, values, out);
}

}  // namespace

StarMeasurement measure_stars(const CalibrationSet& set, const DetectorCalibration& detector,
                              const FrameChoice& choice, const StarMap& stars, Threads& threads) {
  StarMeasurement out;
  StarValues values;
  const StarDetector marks(set, detector);
  for (const CalibrationFrame& from : set.of(FrameKind::light)) {
    try {
      StarFrame in = star_frame(from, choice, marks, threads);
      measure_frame(in, marks, stars, threads, values, out);
    } catch (const Error& error) {
      const std::string reason = error.what();
      out.notes.push_back(reason.starts_with(from.path) ? reason : from.name() + ": " + reason);
    }
  }
  out.focal_length_px = joined(values.focal);
  if (out.focal_length_px)
    out.lens = fit_lens(values.lens, values.projection, out.focal_length_px->value, set.columns(),
                        set.rows());
  if (out.lens) {
    out.focal_length_px = out.lens->focal_length_px;
    out.projection = out.lens->projection.name();
  }
  out.width = measure_width(values.images, set.columns(), set.rows());
  out.zero_point_mag = joint_zero_point(values.light);
  if (out.zero_point_mag)
    out.zero_point_mag->sigma = std::hypot(out.zero_point_mag->sigma, values.extinction_sigma_mag);
  else
    out.zero_point_mag = joined(values.zero_point);
  // Light is in electrons by the gain.
  if (const auto& gain = detector.transfer.gain_e_per_dn; gain && out.zero_point_mag)
    out.zero_point_mag->sigma =
        std::hypot(out.zero_point_mag->sigma, mag_per_relative * gain->sigma / gain->value);
  return out;
}

}  // namespace dmise
