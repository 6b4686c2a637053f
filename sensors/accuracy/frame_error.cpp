#include "sensors/accuracy/frame_error.h"

#include <algorithm>
#include <cmath>

#include "core/detector/exposure/expected_noise.h"
#include "core/detector/exposure/expected_signal.h"
#include "core/effects/plan_facts.h"
#include "core/optics/psf_plan.h"
#include "sensors/accuracy/source_capsule.h"

namespace dmise {
namespace {

constexpr double widths = 3.0;            // margin around a trail, in widths of the point spread
constexpr double saturated_share = 0.9;   // brighter pixels are saturated; full well = 1
constexpr double rim_share = 0.1;         // part of a source's light: more around it is another's
constexpr double rim_begins = 0.8;        // part of the margin, counted from the source
constexpr double background_share = 0.5;  // noise = 1: more light of sources is no background

ExpectedElectronImage light_of(const FrameProducts& frame, double exposure_s) {
  ExpectedElectronImage light = frame.planes.background;
  for (std::size_t i = 0; i < light.pixels.size(); ++i)
    light.pixels[i] =
        float((double(light.pixels[i]) + frame.planes.sources.pixels[i]) * exposure_s);
  return light;
}

ExpectedElectronImage sky_of(const FrameProducts& frame, double exposure_s) {
  ExpectedElectronImage sky = frame.planes.background;
  for (float& e : sky.pixels) e = float(e * exposure_s);
  return sky;
}

/// Charge that a pixel holds and the converter can count.
double max_counted_e(const Detector& detector) {
  const double counts = std::exp2(detector.adc_bits) - 1.0 - detector.bias_dn;
  return std::min(detector.full_well_e, counts * detector.gain_e_per_dn);
}

/// Spreads true pixels by `by` along both axes.
std::vector<bool> spread(const std::vector<bool>& pixels, int columns, int rows, int by) {
  const auto along = [&](const std::vector<bool>& from, int count, int length, int step,
                         int across) {
    std::vector<bool> to(from.size());
    for (int line = 0; line < count; ++line) {
      int last = -by - 1;
      const auto at = [&](int k) {
        return std::size_t(line) * std::size_t(across) + std::size_t(k) * std::size_t(step);
      };
      for (int k = 0; k < length; ++k) {
        if (from[at(k)]) last = k;
        if (k - last <= by && last >= 0) to[at(k)] = true;
      }
      last = length + by;
      for (int k = length - 1; k >= 0; --k) {
        if (from[at(k)]) last = k;
        if (last - k <= by && last < length) to[at(k)] = true;
      }
    }
    return to;
  };
  return along(along(pixels, rows, columns, 1, columns), columns, rows, columns, 1);
}

}  // namespace

FrameComparison::Expected FrameComparison::expected(const FrameProducts& frame,
                                                    const EffectSet& effects) const {
  const auto exposure = scene_.exposure();
  const auto& detector = scene_.sensor().camera.detector;
  const auto light = light_of(frame, exposure.exposure_s);
  const auto sky = sky_of(frame, exposure.exposure_s);
  return {expected_signal(light, detector, exposure, effects, scene_.threads()),
          expected_signal(sky, detector, exposure, effects, scene_.threads()),
          expected_noise(light, detector, exposure, effects, scene_.threads())};
}

FrameComparison::FrameComparison(const SceneFrames& scene, const FrameProducts& reference,
                                 const EffectSet& effects)
    : scene_(scene), effects_(effects), light_(light_of(reference, scene.times().seconds())) {
  reference_ = expected(reference, effects);
  const Detector detector = acting_detector(scene.sensor().camera.detector, effects);
  const double rest_e2 = detector.dark_e_per_s * scene.times().seconds() +
                         detector.read_noise_e * detector.read_noise_e;
  full_e_ = saturated_share * max_counted_e(scene.sensor().camera.detector);
  const std::size_t pixels = light_.pixels.size();
  sigma_e_.resize(pixels);
  background_.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    sigma_e_[i] = float(std::sqrt(std::max(1.0, light_.pixels[i] + rest_e2)));
    const double sources_e = double(reference_.signal.pixels[i]) - reference_.sky.pixels[i];
    background_[i] =
        std::abs(sources_e) < background_share * sigma_e_[i] && light_.pixels[i] <= full_e_;
  }
  // Where charge has bled it bleeds elsewhere by a little less light.
  std::vector<bool> full(pixels);
  for (std::size_t i = 0; i < pixels; ++i) full[i] = reference_.signal.pixels[i] > full_e_;
  const int by = int(std::ceil(widths * std::hypot(1.0, reference.header.psf_fwhm_px)));
  const auto near_full = spread(full, light_.columns, light_.rows, by);
  for (std::size_t i = 0; i < pixels; ++i)
    if (near_full[i]) background_[i] = false;
  find_rounding();
  find_sources(reference);
}

// A transform in single precision rounds by the brightest pixel of a row, and the whole frame by
// the brightest of all: both the reference and what is compared with it.
void FrameComparison::find_rounding() {
  constexpr double of_row = 0x1p-21, of_frame = 0x1p-23;
  const SensorConfig& sensor = scene_.sensor();
  const Camera& camera = sensor.camera;
  const PsfPlan blur =
      plan_psf(camera.optics, camera.band.centre_m, sensor.seeing, scene_.times().seconds());
  rounding_e_.assign(std::size_t(light_.rows), 0.0f);
  if (blur.method != PointSpread::Method::transform) return;
  const auto columns = std::size_t(light_.columns);
  double brightest_e = 0.0;
  for (const float e : light_.pixels) brightest_e = std::max(brightest_e, double(e));
  for (int y = 0; y < light_.rows; ++y) {
    const auto row = light_.pixels.begin() + std::ptrdiff_t(std::size_t(y) * columns);
    const double row_e = *std::max_element(row, row + std::ptrdiff_t(columns));
    rounding_e_[std::size_t(y)] = float(of_row * row_e + of_frame * brightest_e);
  }
}

void FrameComparison::measure(ReferenceSource source) {
  double e = 0.0, x_e = 0.0, y_e = 0.0, snr2 = 0.0, peak_e = 0.0, rim_e = 0.0;
  double pixels = 0.0, rim_pixels = 0.0;
  bool saturated = false;
  const bool whole =
      for_capsule(source, light_.columns, light_.rows, [&](std::size_t i, int x, int y) {
        const double here = double(reference_.signal.pixels[i]) - reference_.sky.pixels[i];
        e += here;
        x_e += here * x;
        y_e += here * y;
        snr2 += here * here / (double(sigma_e_[i]) * sigma_e_[i]);
        saturated = saturated || light_.pixels[i] > full_e_;
        pixels += 1.0;
        if (distance_px({double(x), double(y)}, source) > rim_begins * source.margin_px) {
          rim_e += here;
          rim_pixels += 1.0;
        }
        if (here > peak_e) peak_e = here, source.peak_sigma = here / sigma_e_[i];
      });
  if (!(e > 0.0)) return;
  source.light_e = e;
  source.centroid = {x_e / e, y_e / e};
  source.snr = std::sqrt(snr2);
  source.whole = whole;
  const bool in_wings = rim_e * pixels > rim_share * e * rim_pixels;
  source.alone = !in_wings;
  source.counts = whole && !saturated && source.snr >= PlanFacts::min_snr;
  (source.snr >= PlanFacts::min_snr_of_source ? sources_ : faint_).push_back(std::move(source));
}

// Sources with a bright neighbour do not count: its light that moves over the edge of their capsule
// would be taken for an error.
void FrameComparison::leave_out_crowded() {
  struct Owner {
    std::uint32_t brightest = 0;  // source + 1
    float light_e = 0.0f, next_e = 0.0f;
  };
  std::vector<Owner> owners(light_.pixels.size());
  for (std::size_t s = 0; s < sources_.size(); ++s)
    for_capsule(sources_[s], light_.columns, light_.rows, [&](std::size_t i, int, int) {
      Owner& owner = owners[i];
      const auto e = float(sources_[s].light_e);
      background_[i] = false;
      if (e > owner.light_e)
        owner = {std::uint32_t(s + 1), e, owner.light_e};
      else
        owner.next_e = std::max(owner.next_e, e);
    });
  for (const auto& faint : faint_)
    for_capsule(faint, light_.columns, light_.rows, [&](std::size_t i, int, int) {
      owners[i].next_e = std::max(owners[i].next_e, float(faint.light_e));
    });
  for (std::size_t s = 0; s < sources_.size(); ++s)
    for_capsule(sources_[s], light_.columns, light_.rows, [&](std::size_t i, int, int) {
      const float other_e = owners[i].brightest == s + 1 ? owners[i].next_e : owners[i].light_e;
      if (other_e > PlanFacts::neighbour_share * sources_[s].light_e) sources_[s].alone = false;
    });
  for (auto& source : sources_) source.counts = source.counts && source.alone;
}

void FrameComparison::find_sources(const FrameProducts& reference) {
  const auto& optics = scene_.sensor().camera.optics;
  const double margin_px = widths * std::hypot(1.0, reference.header.psf_fwhm_px);
  for (const StarTruth& star : reference.stars) {
    measure({.name = "star " + std::to_string(star.id),
             .trail = line_along(star.start, star.middle, star.end),
             .margin_px = margin_px});
  }
  for (const Truth& object : reference.truths) {
    if (!object.in_frame) continue;
    double size_px = 0.0;
    for (const OwnObject& own : scene_.scenario().own_objects)
      if (own.name == object.name && own.geometry)
        size_px = (own.panel ? radius_m(*own.geometry->mesh, *own.panel)
                             : radius_m(*own.geometry->mesh)) /
                  std::max(1.0, object.true_range_m) / optics.pixel_angle_rad();
    measure({.name = object.name,
             .trail = line_along({object.start_x_px, object.start_y_px},
                                 {object.middle_x_px, object.middle_y_px},
                                 {object.end_x_px, object.end_y_px}),
             .margin_px = margin_px + size_px});
  }
  leave_out_crowded();
  // Light of sources beyond the frame may move in.
  const int rim_px = int(std::ceil(margin_px));
  for (int y = 0; y < light_.rows; ++y)
    for (int x = 0; x < light_.columns; ++x)
      if (std::min({x, y, light_.columns - 1 - x, light_.rows - 1 - y}) < rim_px)
        background_[std::size_t(y) * std::size_t(light_.columns) + std::size_t(x)] = false;
}

FrameError FrameComparison::error_of(const FrameProducts& frame, const EffectSet& effects) const {
  const Expected made = expected(frame, effects);
  FrameError error;
  ErrorBound& largest = error.largest;
  double sum2 = 0.0;
  const auto beyond = [](double value, double allowance) {
    return std::max(0.0, std::abs(value) - allowance);
  };
  for (std::size_t i = 0; i < sigma_e_.size(); ++i) {
    const double difference_e = double(made.signal.pixels[i]) - reference_.signal.pixels[i];
    const double rounding_e = rounding_e_[i / std::size_t(light_.columns)];
    const double difference = beyond(difference_e, rounding_e) / sigma_e_[i];
    sum2 += difference_e * difference_e / (double(sigma_e_[i]) * sigma_e_[i]);
    if (!background_[i]) continue;
    largest.background_sigma = std::max(largest.background_sigma, difference);
    // Light changes the noise, too: sqrt(s^2 + e) - s = e / 2s.
    const double noise = reference_.noise.pixels[i];
    const double in_noise_e = beyond(made.noise.pixels[i] - noise, 0.5 * rounding_e / noise);
    largest.noise = std::max(largest.noise, in_noise_e / noise);
  }
  error.residual_sigma = std::sqrt(sum2 / double(sigma_e_.size()));
  for (const auto& source : sources_) {
    double e = 0.0, x_e = 0.0, y_e = 0.0, rounding_e2 = 0.0;
    for_capsule(source, light_.columns, light_.rows, [&](std::size_t i, int x, int y) {
      rounding_e2 += double(rounding_e_[std::size_t(y)]) * rounding_e_[std::size_t(y)];
      const double difference = (double(made.signal.pixels[i]) - made.sky.pixels[i]) -
                                (double(reference_.signal.pixels[i]) - reference_.sky.pixels[i]);
      e += difference;
      x_e += difference * (x - source.centroid.x_px);
      y_e += difference * (y - source.centroid.y_px);
    });
    if (!source.counts) {
      // Too faint for photometry: the light that it lacks, in its brightest pixel.
      if (source.whole && source.alone && source.snr < PlanFacts::min_snr)
        largest.background_sigma =
            std::max(largest.background_sigma, std::abs(e) / source.light_e * source.peak_sigma);
      continue;
    }
    const double rounding_e = std::sqrt(rounding_e2);
    const double lost_e = std::copysign(beyond(e, rounding_e), e);
    const double moved_e = beyond(std::hypot(x_e, y_e), rounding_e * source.margin_px);
    const double ratio = std::max(1e-10, 1.0 + lost_e / source.light_e);
    largest.photometry_mag = std::max(largest.photometry_mag, std::abs(2.5 * std::log10(ratio)));
    largest.position_px = std::max(largest.position_px, moved_e / source.light_e);
  }
  largest.noise = std::max(largest.noise, skewness_error(effects));
  return error;
}

// The quantile of a distribution at 3 sigma lies at 3 + 4/3 of its skewness (Cornish and Fisher).
double FrameComparison::skewness_error(const EffectSet& effects) const {
  const EffectFacts& photons = PhotonNoise::facts;
  if (photons.levels[std::size_t(effects.level(photons))] != "gaussian") return 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < light_.pixels.size(); ++i)
    if (light_.pixels[i] <= full_e_)
      largest =
          std::max(largest, 4.0 / 9.0 * light_.pixels[i] / std::pow(double(sigma_e_[i]), 3.0));
  return largest;
}

std::size_t FrameComparison::background_pixels() const {
  return std::size_t(std::count(background_.begin(), background_.end(), true));
}

}  // namespace dmise
