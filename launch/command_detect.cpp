#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/detection/detect_file.h"
#include "launch/commands.h"
#include "launch/frame_options.h"

namespace dmise {
namespace {

struct DetectOptions {
  std::string frame;
  bool report = false;
  int threads = 1;
  std::shared_ptr<FrameChoice> choice = std::make_shared<FrameChoice>();
};

void print_detections(const DetectOptions& o) {
  Threads threads(o.threads);
  FrameNotes last;
  read_frames_of(o.frame, *o.choice, threads, [&](const Frame& frame) {
    if (frame.notes != last) print_notes(o.frame, frame.notes);
    last = frame.notes;
    const FileDetections found = detect_frame(frame, {}, threads);
    if (o.report) std::printf("%s\n", found.report.c_str());
    for (const auto& line : found.lines) std::printf("%s\n", line.c_str());
  });
}

}  // namespace

void add_detect_command(CLI::App& app) {
  auto o = std::make_shared<DetectOptions>();
  auto* command =
      app.add_subcommand("detect",
                         "Detects moving objects in a frame, from its counts and header "
                         "alone; JSON lines as in detections.jsonl");
  command->add_option("frame", o->frame, "FITS file of a run, or of any camera")->required();
  command->add_flag("--report", o->report,
                    "print the frame's report, as in frames.jsonl, before its detections");
  add_frame_options(*command, o->choice);
  command->add_option("--threads", o->threads, "number of threads")
      ->default_val(1)
      ->check(CLI::Range(1, 256));
  command->callback([o] { print_detections(*o); });
}

}  // namespace dmise
