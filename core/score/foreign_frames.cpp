#include "core/score/foreign_frames.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"
#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/ingest/any_frame.h"
#include "core/optics/psf_table.h"
#include "core/products/frame_report.h"
#include "core/score/scored_run.h"
#include "core/score/trail.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

const std::string sensor_name = "frames";  // all files of a directory count as one sensor's

const std::vector<std::string> columns_known = {"file",      "id",        "x_px",      "y_px",
                                                "end1_x_px", "end1_y_px", "end2_x_px", "end2_y_px",
                                                "magnitude", "signal_e",  "ra_deg",    "dec_deg"};

/// One row by the names of its columns.
class Row {
 public:
  Row(const std::vector<std::string>& header, std::vector<std::string> fields, std::string place)
      : place_(std::move(place)) {
    if (fields.size() != header.size())
      throw ConfigError(place_ + ": must have " + std::to_string(header.size()) + " fields, got " +
                        std::to_string(fields.size()));
    for (std::size_t i = 0; i < header.size(); ++i) fields_[header[i]] = std::move(fields[i]);
  }
  [[noreturn]] void fail(const std::string& column, const std::string& reason) const {
    const auto field = fields_.find(column);
    throw ConfigError(place_ + ": " + column + ": " + reason +
                      got(field == fields_.end() ? "" : field->second));
  }
  std::string text(const std::string& column) const {
    const std::string& value = fields_.at(column);
    if (value.empty()) fail(column, "must not be empty");
    return value;
  }
  std::optional<double> number(const std::string& column, double least, double most) const {
    const auto field = fields_.find(column);
    if (field == fields_.end() || field->second.empty()) return {};
    const auto value = parse_real(field->second);
    if (!value || !(*value >= least && *value <= most))
      fail(column, formatted("must be a number in %g..%g", least, most));
    return value;
  }
  /// Two numbers that are given together.
  std::optional<PixelPosition> pair(const std::string& x, const std::string& y, double low_x,
                                    double high_x, double low_y, double high_y) const {
    const auto a = number(x, low_x, high_x), b = number(y, low_y, high_y);
    if (a.has_value() != b.has_value()) fail(a ? y : x, "is missing beside " + (a ? x : y));
    if (!a) return {};
    return PixelPosition{*a, *b};
  }

 private:
  std::map<std::string, std::string> fields_;
  std::string place_;
};

std::vector<std::string> header_of(std::string_view line, const std::string& place) {
  auto header = csv_fields(line);
  for (const auto& name : header) {
    if (std::ranges::count(header, name) > 1)
      throw ConfigError(place + ": " + printable(name, 80) + ": column is there twice");
    if (std::ranges::find(columns_known, name) != columns_known.end()) continue;
    throw ConfigError(place + ": unknown column" + got(name) + did_you_mean(name, columns_known));
  }
  for (const char* name : {"file", "id", "x_px", "y_px"})
    if (std::ranges::find(header, name) == header.end())
      throw ConfigError(place + ": " + name + ": column is missing");
  return header;
}

std::vector<std::string> fits_files(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    std::string name = entry.path().filename().string();
    for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
    const std::filesystem::path file = name;
    const auto packed = file.extension() == ".gz" || file.extension() == ".fz";
    const auto ending = (packed ? file.stem() : file).extension();
    if (ending == ".fits" || ending == ".fit" || ending == ".fts")
      names.push_back(entry.path().filename().string());
  }
  if (error) throw ConfigError(printable(directory) + ": " + error.message());
  if (names.empty()) throw ConfigError(printable(directory) + ": has no FITS files");
  std::ranges::sort(names);
  return names;
}

}  // namespace

std::vector<TrueSource> read_truth_csv(const std::string& path,
                                       const std::vector<std::string>& files) {
  return parse_truth_csv(read_text_file(path), printable(path), files);
}

std::vector<TrueSource> parse_truth_csv(const std::string& text, const std::string& name,
                                        const std::vector<std::string>& files) {
  LineReader lines(without_byte_order_mark(text));
  const auto first = lines.next();
  if (!first) throw ConfigError(name + ": is empty");
  const auto header = header_of(*first, name + ":1");
  std::vector<TrueSource> truths;
  std::set<std::pair<std::string, std::string>> seen;
  while (const auto line = lines.next()) {
    if (line->empty()) continue;
    const Row row(header, csv_fields(*line), name + ":" + std::to_string(lines.line()));
    constexpr double far = 1e7;
    TrueSource t{.sensor = sensor_name, .frame = row.text("file"), .id = row.text("id")};
    if (std::ranges::find(files, t.frame) == files.end())
      row.fail("file", "is not in the directory");
    if (!seen.emplace(t.frame, t.id).second) row.fail("id", "is there twice for this file");
    row.text("x_px"), row.text("y_px");
    const auto light = row.pair("x_px", "y_px", -far, far, -far, far);
    const auto end1 = row.pair("end1_x_px", "end1_y_px", -far, far, -far, far);
    const auto end2 = row.pair("end2_x_px", "end2_y_px", -far, far, -far, far);
    if (end1.has_value() != end2.has_value())
      row.fail(end1 ? "end2_x_px" : "end1_x_px", "is missing beside the other end");
    t.start = end1.value_or(*light);
    t.middle = *light;
    t.end = end2.value_or(*light);
    t.light = light;
    t.magnitude = row.number("magnitude", -50.0, 50.0);
    t.signal_e = row.number("signal_e", 1e-9, 1e15);
    if (const auto place = row.pair("ra_deg", "dec_deg", 0.0, 360.0, -90.0, 90.0)) {
      t.ra_rad = place->x_px * deg;
      t.dec_rad = place->y_px * deg;
    }
    truths.push_back(std::move(t));
  }
  return truths;
}

namespace {

ScoredFrame frame_of_report(const FrameReport& report, const UnknownFacts& unknown) {
  ScoredFrame frame;
  if (report.noise_e > 0.0) frame.noise_e = report.noise_e;
  frame.exposure_s = (report.end - report.start).seconds();
  if (!unknown.has(FrameFact::pointing) && !unknown.has(FrameFact::exposure))
    frame.scale_rad_per_px = wcs_scale_rad_per_px(report.wcs);
  return frame;
}

/// Truth that a frame's detections cannot be compared with is not scored.
void leave_unknown(const std::string& file, const UnknownFacts& unknown,
                   std::vector<TrueSource>& truths) {
  const bool no_light = unknown.has(FrameFact::zero_point);
  const bool no_place = unknown.has(FrameFact::pointing) || unknown.has(FrameFact::site);
  for (TrueSource& t : truths) {
    if (t.frame != file) continue;
    if (no_light || unknown.has(FrameFact::exposure)) t.magnitude.reset();
    if (no_place || unknown.has(FrameFact::time)) t.ra_rad.reset(), t.dec_rad.reset();
  }
}

}  // namespace

ScoreInput read_frames(const std::string& directory, const std::string& truth_csv, Threads& threads,
                       const ReadProgress& progress, const CalibratedDetector& detector) {
  const auto files = fits_files(directory);
  ScoreInput in{.source = directory, .status = "complete"};
  in.truths = read_truth_csv(truth_csv, files);
  std::map<std::string, const ScoredFrame*> frame_of_file;
  in.frames.reserve(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    progress(double(i) / double(files.size()), files[i]);
    const std::string path = directory + "/" + files[i];
    const Frame pixels = read_any_frame(path, {}, threads);
    const auto result = detector.detect(pixels, threads);
    const DetectionResult& found = result.detection;
    const UnknownFacts& unknown = result.header.unknown;
    ScoredFrame frame = frame_of_report(found.report, unknown);
    frame.sensor = sensor_name;
    frame.frame = files[i];
    frame.columns = pixels.counts.columns;
    frame.rows = pixels.counts.rows;
    if (pixels.header.psf_fwhm_px > 0.0)
      frame.sigma_px = pixels.header.psf_fwhm_px / fwhm_per_sigma;
    in.frames.push_back(std::move(frame));
    leave_unknown(files[i], unknown, in.truths);
    frame_of_file[files[i]] = &in.frames.back();
    for (const Detection& d : found.detections) {
      FoundSource source{sensor_name, files[i], d, unknown};
      source.detection.id = files[i] + "/" + std::to_string(source.detection.index);
      in.detections.push_back(std::move(source));
    }
  }
  for (TrueSource& t : in.truths) {
    const ScoredFrame& frame = *frame_of_file.at(t.frame);
    const auto inside = [&](PixelPosition p) { return is_inside(p, frame.columns, frame.rows); };
    t.whole = inside(t.start) && inside(t.end);
    if (!inside(*t.light)) t.light.reset();
  }
  return in;
}

}  // namespace dmise
