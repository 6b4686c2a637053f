#include "bench/validation/real_frames.h"

#include <algorithm>
#include <cmath>

#include "bench/validation/real_cameras.h"
#include "core/astrometry/calibrated_detection.h"
#include "core/base/error.h"
#include "core/base/files/fits_guard.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/config/make_clock.h"
#include "core/config/scenario_text.h"
#include "core/detection/light/psf.h"
#include "core/detection/pixels/components.h"
#include "core/image/fits_image.h"
#include "core/ingest/any_frame.h"
#include "core/photometry/magnitude.h"
#include "sensors/forecast/sensor_forecast.h"
#include "sensors/objects/state_window_source.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

constexpr double nanomaggy_mag = 22.5;

constexpr const char* about_real_frames = R"(
## Frames of survey telescopes

Pieces of four real frames, those of trailblazer's tests (dirac-institute/trailblazer at 78abe53). What `dmise check` predicts of the exposure, by the
published facts of the camera, stands beside what `dmise detect` measures in the pixels. Cells have the predicted figure, then the measured.
Magnitudes are AB in the frame's band, the zero point behind the air of the exposure, the limit above it. Electrons are by the published gain.

- **zero point**: of 1 e-/s. Only the calibrated frame tells one; no catalogue of stars is as deep as the pieces.
- **sky**: electrons of a pixel. Predicted: with the twilight, in brackets, of it. Measured: the level above the bias, and what the noise asks for beside read-out.
- **noise**: of a pixel, rms.
- **limit**: of points, for the width that points have in the frame and the predicted zero point. It shows by how much a wrong sky moves it.
- **found**: by `dmise detect` without a catalogue; a streak whose ends are outside the frame has an SNR by its unknown ends.

| camera, band | elevation of the boresight, the Sun, deg | zero point, mag | sky predicted, e- | sky by level, noise, e- | noise, e- | limit, mag | is in it | found |
|---|---|---|---|---|---|---|---|---|
)";

constexpr const char* what_differs_in_real_frames = R"(
What differs: SDSS's frame was taken early in the evening, and skies differ by half a magnitude between nights and hours. Hyper Suprime-Cam
looks low on the side of the Sun, where twilight is less well known than at the zenith. VATT's sky is known as well as its throughput.

This does not show: throughputs but that of SDSS, skies but those of four nights, fields, distortion, or completeness: four pieces are no statistics.
)";

/// The middle of the pixels that see no light.
double bias_of(const FitsImage& image, const std::vector<double>& values, const RealFrame& frame) {
  std::vector<double> dark;
  for (int y = 0; y < image.rows(); ++y)
    for (int x = 0; x < frame.dark_columns; ++x)
      dark.push_back(values[std::size_t(y) * std::size_t(image.columns()) +
                            std::size_t(frame.first_dark_column + x)]);
  return median_of(std::move(dark));
}

/// What the frame's pixels and header say beyond what `dmise detect` reads.
struct OwnFacts {
  FrameChoice choice;
  double nanomaggies_per_count = 0.0;
};

OwnFacts facts_of(const std::string& path, const RealFrame& frame) {
  OwnFacts facts;
  facts.choice.stated = frame.stated;
  const std::string bytes = read_fits_file(path);
  FitsImage image(bytes, path);
  if (frame.dark_columns > 0) {
    std::vector<double> values;
    image.add_plane(0, values);
    facts.choice.stated["BIASLVL"] = formatted("%.9g", bias_of(image, values, frame));
  }
  if (*frame.calibration) {
    const auto card = image.values().find(frame.calibration);
    const auto number = card == image.values().end() ? std::nullopt : parse_real(card->second);
    if (!number || !(*number > 0.0))
      throw ConfigError(path + ": " + frame.calibration + ": must be a number > 0");
    facts.nanomaggies_per_count = *number;
    facts.choice.stated["EGAIN"] = formatted("%.9g", frame.e_per_count / *number);
  }
  return facts;
}

/// Sky of a pixel in mid exposure.
double sky_of(const View& view) { return background_at_centre(view, {}).electrons; }

/// By the same code as `dmise check`, with the width that points have in the frame.
PredictedFrame predicted(Scenario scenario, double fwhm_px, Threads& threads) {
  SensorConfig& sensor = scenario.sensors.front();
  sensor.camera.optics.psf_fwhm_px = fwhm_px;
  const Clock clock = make_clock(scenario);
  const ObjectPopulation none;
  const SensorForecast forecast =
      sensor_forecast(scenario, sensor, none, clock, nullptr, threads, {.max_frames = 0});
  const FrameForecast& middle = *forecast.mid_run;
  const FrameTimes times = frame_times(sensor, middle.frame);
  const StateWindowSource windows(scenario, sensor, clock);
  const StateSource source(none, clock, threads);
  const StateWindow window = windows.around(times, none, source);
  const Throughput throughput(View(sensor, times, window, scenario.seed));
  SensorConfig without = sensor;
  without.sky.parts.twilight.reset();
  const double colour_mag = sensor.camera.magnitudes.solar_colour_mag;
  return {.zero_point_mag = throughput.zero_point_mag() + colour_mag - middle.extinction_mag,
          .sky_e = middle.background.electrons,
          .twilight_e =
              middle.background.electrons - sky_of(View(without, times, window, scenario.seed)),
          .noise_e = middle.background.noise_e,
          .limit_mag = middle.point_limit_v_mag.value_or(NAN) + colour_mag,
          .sun_deg = middle.sun_elevation_rad.value_or(0.0) / deg,
          .boresight_deg = middle.boresight_elevation_rad.value_or(0.0) / deg};
}

/// What the detection of a frame tells by itself.
MeasuredFrame measured(const CalibratedDetector::Result& result) {
  const FrameReport& report = result.detection.report;
  MeasuredFrame out{.noise_e = report.noise_e, .detections = result.detection.detections};
  if (!result.header.unknown.has(FrameFact::bias)) out.sky_e = report.background_e;
  return out;
}

/// Sets what takes the camera's facts.
void add_figures(const RealFrame& frame, const OwnFacts& facts, const SensorConfig& sensor,
                 double fwhm_px, ComparedFrame& out) {
  MeasuredFrame& m = out.measured;
  const double read_noise_e = sensor.camera.detector.read_noise_e;
  m.sky_by_noise_e = m.noise_e * m.noise_e - read_noise_e * read_noise_e;
  if (*frame.calibration)
    m.zero_point_mag = nanomaggy_mag + magnitude_of_light(facts.nanomaggies_per_count *
                                                          sensor.exposure_s / frame.e_per_count);
  // At the same zero point: the difference is that of noise.
  const double sigma_px = sigma_with_pixel(fwhm_px);
  m.limit_mag = out.predicted->limit_mag +
                magnitude_of_light(limiting_point_e(m.noise_e, sigma_px) /
                                   limiting_point_e(out.predicted->noise_e, sigma_px));
}

ComparedFrame compared_frame(const std::string& path, const RealFrame& frame, Threads& threads) {
  const OwnFacts facts = facts_of(path, frame);
  const Frame pixels = read_any_frame(path, facts.choice, threads);
  const auto result = CalibratedDetector(nullptr).detect(pixels, threads);
  ComparedFrame out{.name = frame.name,
                    .camera = frame.camera,
                    .about = frame.about,
                    .measured = measured(result),
                    .wanted_streaks = frame.wanted_streaks};
  if (!frame.scenario) return out;
  const double fwhm_px = result.detection.report.psf_fwhm_px;
  const Scenario scenario = scenario_of_text(frame.scenario, frame.file);
  out.predicted = predicted(scenario, fwhm_px, threads);
  add_figures(frame, facts, scenario.sensors.front(), fwhm_px, out);
  return out;
}

std::string pair_text(double predicted, const std::optional<double>& measured, int digits) {
  return measured ? formatted(" %.*f, %.*f |", digits, predicted, digits, *measured)
                  : formatted(" %.*f, - |", digits, predicted);
}

std::string found_text(const ComparedFrame& frame) {
  std::string text;
  for (const Detection& d : frame.measured.detections)
    text +=
        (text.empty() ? "" : "; ") + (d.kind == DetectionKind::streak
                                          ? formatted("streak of %.0f px, SNR %.0f%s", d.length_px,
                                                      d.snr, d.at_edge ? ", at the edge" : "")
                                          : formatted("point, SNR %.0f", d.snr));
  return text.empty() ? "nothing" : text;
}

std::string frame_row(const ComparedFrame& frame) {
  std::string text = "| " + frame.camera + " |";
  const MeasuredFrame& m = frame.measured;
  if (!frame.predicted) {
    text += formatted(" | | | | -, %.1f | |", m.noise_e);
  } else {
    const PredictedFrame& p = *frame.predicted;
    text += formatted(" %.1f, %.1f |", p.boresight_deg, p.sun_deg);
    text += pair_text(p.zero_point_mag, m.zero_point_mag, 2);
    text += formatted(" %.0f (%.0f) |", p.sky_e, p.twilight_e);
    text += m.sky_e ? formatted(" %.0f, %.0f |", *m.sky_e, *m.sky_by_noise_e)
                    : formatted(" -, %.0f |", *m.sky_by_noise_e);
    text += pair_text(p.noise_e, m.noise_e, 1);
    text += pair_text(p.limit_mag, m.limit_mag, 2);
  }
  return text + (frame.wanted_streaks ? " one streak |" : " nothing |") + " " + found_text(frame) +
         " |\n";
}

}  // namespace

int ComparedFrame::streaks() const {
  return int(std::ranges::count(measured.detections, DetectionKind::streak, &Detection::kind));
}

bool ComparedFrame::as_wanted() const {
  return streaks() == wanted_streaks && int(measured.detections.size()) == wanted_streaks;
}

std::vector<ComparedFrame> compare_frames(const std::string& data, Threads& threads) {
  std::vector<ComparedFrame> out;
  for (const RealFrame& frame : real_frames())
    out.push_back(compared_frame(data + "/frames/" + frame.file, frame, threads));
  return out;
}

std::string frames_section(const std::vector<ComparedFrame>& frames) {
  std::string text = about_real_frames;
  for (const ComparedFrame& frame : frames) text += frame_row(frame);
  text += '\n';
  for (const ComparedFrame& frame : frames) text += "- " + std::string(frame.about) + "\n";
  return text + what_differs_in_real_frames;
}

}  // namespace dmise
