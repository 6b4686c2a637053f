#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "core/calibration/calibrated_detection.h"
#include "core/detection/detection_lines.h"
#include "core/ingest/star_trails.h"
#include "launch/commands.h"
#include "launch/common_options.h"
#include "launch/frame_options.h"
#include "launch/star_catalogue_option.h"

namespace dmise {
namespace {

struct DetectOptions {
  std::string frame, catalogue;
  bool report = false, blind = false;
  int threads = 1;
  std::shared_ptr<FrameChoice> choice = std::make_shared<FrameChoice>();
};

CalibratedDetector::Result detected(const CalibratedDetector& detector, const DetectOptions& o,
                                    const Frame& frame, Threads& threads) {
  try {
    return detector.detect(frame, threads, o.blind);
  } catch (const ConfigError&) {
    throw;
  } catch (const Error& e) {
    throw Error(o.frame + ": " + e.what());
  }
}

void print_detections(const DetectOptions& o) {
  if (o.blind && o.catalogue == "none") throw ConfigError("--blind: takes a --catalogue");
  Threads threads(o.threads);
  CalibratedDetector detector(load_star_catalogue(o.catalogue));
  detector.after_solution = [&](const CountImage& counts, FrameHeader& solved) {
    set_trails_of_solved(counts, threads, solved);
  };
  FrameNotes last;
  read_frames_of(o.frame, *o.choice, threads, [&](const Frame& frame) {
    if (frame.header.shutter_closed())
      std::fprintf(stderr, "note: %s: the shutter was closed because of %s: nothing to detect\n",
                   o.frame.c_str(), excluding_text(frame.header.excluded).c_str());
    auto found = detected(detector, o, frame, threads);
    if (found.notes != last) print_notes(o.frame, found.notes);
    last = found.notes;
    if (found.solution)
      std::fprintf(stderr, "note: %s: solved: %d stars, %.3f px rms\n", o.frame.c_str(),
                   found.solution->plate.fit.count, found.solution->plate.fit.rms_px);
    const auto lines = as_lines(std::move(found.detection), found.header, found.notes);
    if (o.report) std::printf("%s\n", lines.report.c_str());
    for (const auto& line : lines.lines) std::printf("%s\n", line.c_str());
  });
}

}  // namespace

void add_detect_command(CLI::App& app) {
  auto o = std::make_shared<DetectOptions>();
  auto* command = app.add_subcommand(
      "detect",
      "Detects what is no star in a frame, from its counts and header and a catalogue of stars; "
      "JSON lines, the same as a run's detections.jsonl with the run's catalogue");
  command->add_option("frame", o->frame, "FITS file of a run, or of any camera")->required();
  command->add_flag("--report", o->report,
                    "print the frame's report, as in frames.jsonl, before its detections");
  add_frame_options(*command, o->choice);
  add_star_catalogue_option(*command, o->catalogue, true);
  command->add_flag("--blind", o->blind,
                    "find where the frame points by its stars alone, before detection");
  add_threads_option(*command, o->threads);
  command->callback([o] { print_detections(*o); });
}

}  // namespace dmise
