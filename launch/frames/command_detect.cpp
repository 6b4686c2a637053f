#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/astrometry/calibrated_detection.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/units.h"
#include "core/detection/detection_lines.h"
#include "core/image/known_defects.h"
#include "core/ingest/any_frame.h"
#include "core/ingest/star_trails.h"
#include "core/sequences/detect_sequence.h"
#include "core/sequences/sequence_frame.h"
#include "core/sequences/sequence_lines.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/command/notes.h"
#include "launch/frames/frame_options.h"
#include "launch/run/progress.h"
#include "launch/run/star_catalogue_option.h"

namespace dmise {
namespace {

/// A frame of a file as one of a sequence, without the pixels that its camera knows to be hot.
SequenceFrame frame_of_sequence(const std::string& path, const Frame& frame) {
  if (const auto calibrated = without_hot_pixels(frame))
    return {path, calibrated->counts, calibrated->header, calibrated->unusable};
  return {path, frame.counts, frame.header, frame.unusable};
}

/// Prints what moves over frames, a line of JSON each. `max_rate_rad_per_s`: 0 for the default.
void print_sequence(std::vector<SequenceFrame> frames, double max_rate_rad_per_s,
                    Threads& threads) {
  Progress progress;
  SequenceSearch search;
  if (max_rate_rad_per_s > 0) search.max_rate_rad_per_s = max_rate_rad_per_s;
  search.progress = [&](double share) { progress.show_share(share, "shifting and adding frames"); };
  const SequenceResult found = detect_sequence(std::move(frames), search, threads);
  progress.clear_line();
  for (const std::string& note : found.notes) print_note(note);
  for (std::size_t i = 0; i < found.tracks.size(); ++i)
    std::printf("%s\n", to_json(found.tracks[i], std::uint32_t(i + 1)).c_str());
}

struct DetectOptions {
  std::vector<std::string> frames;
  std::string catalogue;
  bool report = false, blind = false, sequence = false, light_curves = false;
  double max_rate_arcsec_per_s = 0.0;  // 0: by the frames
  int threads = 1;
  std::shared_ptr<FrameChoice> choice = std::make_shared<FrameChoice>();
};

CalibratedDetector::Result detected(const CalibratedDetector& detector, const DetectOptions& o,
                                    const std::string& path, const Frame& frame, Threads& threads) {
  try {
    return detector.detect(frame, threads, o.blind);
  } catch (const ConfigError&) {
    throw;
  } catch (const Error& e) {
    throw Error(path + ": " + e.what());
  }
}

void print_notes_of(const std::string& path, const CalibratedDetector::Result& found,
                    FrameNotes& last) {
  if (found.notes != last) print_notes(path, found.notes);
  last = found.notes;
  if (found.solution)
    std::fprintf(stderr, "note: %s: solved: %d stars, %.3f px rms\n", path.c_str(),
                 found.solution->plate.fit.count, found.solution->plate.fit.rms_px);
}

void print_detections_in(const std::string& path, const DetectOptions& o,
                         const CalibratedDetector& detector, Threads& threads) {
  FrameNotes last;
  read_frames_of(path, *o.choice, threads, [&](const Frame& frame) {
    if (frame.header.shutter_closed())
      std::fprintf(stderr, "note: %s: %s: nothing to detect\n", path.c_str(),
                   frame.header.closed_text().c_str());
    auto found = detected(detector, o, path, frame, threads);
    print_notes_of(path, found, last);
    const auto lines = as_lines(std::move(found.detection), found.header, found.notes);
    if (o.report) std::printf("%s\n", lines.report.c_str());
    for (const auto& line : lines.lines) std::printf("%s\n", line.c_str());
  });
}

/// Links the frames of all files. With a catalogue each is solved where its header is wrong.
void print_sequence_of(const DetectOptions& o, const CalibratedDetector& detector,
                       Threads& threads) {
  std::vector<SequenceFrame> frames;
  for (const std::string& path : o.frames) {
    FrameNotes last;
    read_frames_of(path, *o.choice, threads, [&](const Frame& frame) {
      frames.push_back(frame_of_sequence(path, frame));
      if (o.catalogue == "none") return;
      const auto found = detected(detector, o, path, frame, threads);
      print_notes_of(path, found, last);
      frames.back().header = found.header;
    });
  }
  print_sequence(std::move(frames), o.max_rate_arcsec_per_s * arcsec, threads);
}

void check_options(const DetectOptions& o) {
  if (o.blind && o.catalogue == "none") throw ConfigError("--blind: takes a --catalogue");
  if (o.sequence && o.report) throw ConfigError("--report: is of single frames, not --sequence");
  if (o.sequence && o.light_curves)
    throw ConfigError("--light-curves: is of single frames, not --sequence");
  if (!o.sequence && o.max_rate_arcsec_per_s > 0) throw ConfigError("--max-rate: takes --sequence");
}

void print_detections(const DetectOptions& o) {
  check_options(o);
  Threads threads(o.threads);
  CalibratedDetector detector(load_star_catalogue(o.catalogue));
  detector.settings.light_curves = o.light_curves;
  detector.after_solution = [&](const CountImage& counts, FrameHeader& solved) {
    set_trails_of_solved(counts, threads, solved);
  };
  if (o.sequence) return print_sequence_of(o, detector, threads);
  for (const std::string& path : o.frames) print_detections_in(path, o, detector, threads);
}

void add_detect_options(CLI::App& command) {
  auto o = std::make_shared<DetectOptions>();
  command
      .add_option("frame", o->frames,
                  "FITS files of a run, or of any camera: each is searched alone, or all with "
                  "--sequence")
      ->required();
  command.add_flag("--sequence", o->sequence,
                   "find what moves over the frames: three or more of one sensor, of one exposure "
                   "time and of one field");
  command
      .add_option("--max-rate", o->max_rate_arcsec_per_s,
                  "greatest rate against the detector that --sequence searches [arcsec/s]; else "
                  "that at which a point trails by twice the PSF's width")
      ->check(number_between(1e-3, 1e5));
  command.add_flag("--report", o->report,
                   "print the frame's report, as in frames.jsonl, before its detections");
  command.add_flag("--light-curves", o->light_curves,
                   "measure the light along each streak over time, and its period");
  add_frame_options(command, o->choice);
  add_star_catalogue_option(command, o->catalogue, true);
  command.add_flag("--blind", o->blind,
                   "find where the frame points by its stars alone, before detection");
  add_threads_option(command, o->threads);
  command.callback([o] { print_detections(*o); });
}

}  // namespace

Command detect_command() {
  return {
      .group = CommandGroup::frames,
      .summary =
          "Detects what is no star in frames, by their counts, headers and a catalogue of stars",
      .details = "Prints JSON lines, the same as a run's detections.jsonl with the run's catalogue",
      .add_options = add_detect_options};
}

}  // namespace dmise
