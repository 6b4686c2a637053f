// Any bytes are a table of truth, or lines of a run's files, or one ConfigError; what is read is
// scored, and no figure of the score is infinite or none.
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/products/product_json.h"
#include "core/score/foreign_frames.h"
#include "core/score/score.h"
#include "core/score/score_text.h"
#include "core/score/scored_run.h"

using namespace dmise;

namespace {

/// A frame that is searched, whatever is read of it.
ScoredFrame frame(const std::string& sensor, const std::string& name) {
  return {.sensor = sensor,
          .frame = name,
          .columns = 640,
          .rows = 480,
          .noise_e = 10.0,
          .sigma_px = 0.8,
          .exposure_s = 1.0,
          .scale_rad_per_px = 1e-4};
}

/// A truth where a detection is, and the other way round, so that their errors are computed.
TrueSource truth_of(const FoundSource& found) {
  const Detection& d = found.detection;
  return {.frame = found.frame,
          .start = {d.end1_x_px, d.end1_y_px},
          .middle = {d.x_px, d.y_px},
          .end = {d.end2_x_px, d.end2_y_px},
          .light = PixelPosition{d.x_px, d.y_px},
          .signal_e = 1e4,
          .magnitude = 10.0,
          .ra_rad = 1.0,
          .dec_rad = 0.5,
          .start_time = SimTime{0},
          .end_time = SimTime{1'000'000'000}};
}

FoundSource detection_of(const TrueSource& truth) {
  FoundSource found{.frame = truth.frame};
  Detection& d = found.detection;
  d.x_px = truth.middle.x_px, d.y_px = truth.middle.y_px;
  d.end1_x_px = truth.start.x_px, d.end1_y_px = truth.start.y_px;
  d.end2_x_px = truth.end.x_px, d.end2_y_px = truth.end.y_px;
  d.kind = DetectionKind::streak;
  d.covariance_px2 = {0.01, 0.0, 0.01};
  d.covariance_rad2 = {1e-10, 0.0, 1e-10};
  d.signal_e = 1e4;
  d.magnitude_sigma = 0.1;
  return found;
}

void require_figures(const std::string& text) {
  for (const char* none : {"nan", "inf"})
    for (auto at = text.find(none); at != std::string::npos; at = text.find(none, at + 1)) {
      const auto is_letter = [&](std::size_t k) {
        return k < text.size() && std::isalpha(static_cast<unsigned char>(text[k]));
      };
      // Names of sensors and objects are in quotes, and of other letters.
      if (!(at > 0 && is_letter(at - 1)) && !is_letter(at + 3)) std::abort();
    }
}

void score_all(ScoreInput input) {
  if (input.truths.empty())
    for (const FoundSource& f : input.detections) input.truths.push_back(truth_of(f));
  else if (input.detections.empty())
    for (const TrueSource& t : input.truths) input.detections.push_back(detection_of(t));
  int number = 0;
  for (TrueSource& t : input.truths) t.sensor = "x", t.id = std::to_string(number++);
  for (FoundSource& f : input.detections) f.sensor = f.detection.sensor = f.detection.id = "x";
  for (ScoredFrame& f : input.frames) f.sensor = "x";
  if (input.frames.empty() && !input.truths.empty())
    input.frames.push_back(frame("x", input.truths.front().frame));
  try {
    const Score result = score(std::move(input), {});
    require_figures(score_json(result));
    require_figures(score_table(result));
    require_figures(score_csv(result));
  } catch (const Error&) {
  }
}

void read_table(const std::string& text) {
  ScoreInput input;
  try {
    input.truths = parse_truth_csv(text, "fuzz.csv", {"a.fits", "b.fits"});
  } catch (const ConfigError&) {
    return;
  }
  score_all(std::move(input));
}

/// One line each of frames.jsonl, truth.jsonl and detections.jsonl, in any order: which it is, its
/// keys tell.
void read_lines(const std::string& text) {
  ScoreInput input;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    try {
      const JsonRecord record(text.substr(begin, end - begin), "fuzz.jsonl:1");
      if (record.has("rendered_signal_e")) {
        input.truths.push_back(source_of(dmise::truth_of(record)));
      } else if (record.has("snr")) {
        FoundSource found{.detection = dmise::detection_of(record)};
        found.frame = std::to_string(found.detection.frame);
        input.detections.push_back(std::move(found));
      } else if (record.has("existence")) {
        track_of(record);
      } else {
        const RunSensor sensor{.name = "x", .columns = 640, .rows = 480};
        input.frames.push_back(frame_of(report_of(record), sensor));
      }
    } catch (const ConfigError&) {
    }
    begin = end + 1;
  }
  score_all(std::move(input));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  text.starts_with("{") ? read_lines(text) : read_table(text);
  return 0;
}
