#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/engine/engine.h"
#include "clients/engine/interruptible.h"
#include "core/calibration/calibrated_detection.h"
#include "core/config/load_star_catalogue.h"
#include "core/detection/detection_lines.h"
#include "core/ingest/any_frame.h"
#include "core/ingest/star_trails.h"

namespace nb = nanobind;

namespace dmise {
namespace {

/// A FITS file in memory, and how it is read.
struct FrameFile {
  std::string bytes;
  std::string name = {};  // in messages
  std::string catalogue = {};
  bool blind = false;
  int threads = 1;
};

FrameFile file_of(const nb::bytes& bytes, std::string name, std::string catalogue, bool blind,
                  int threads) {
  return {.bytes = std::string(bytes.c_str(), bytes.size()),
          .name = std::move(name),
          .catalogue = std::move(catalogue),
          .blind = blind,
          .threads = checked_threads(threads)};
}

/// The only frame of a file.
Frame frame_of(const FrameFile& file, Threads& threads) {
  std::optional<Frame> found;
  decode_frames(file.bytes, file.name, {}, threads, [&](const Frame& frame) {
    if (found) throw ConfigError(file.name + ": holds several frames");
    found = frame;
  });
  if (!found) throw ConfigError(file.name + ": holds no frame");
  return std::move(*found);
}

/// Calls `work`; an error that is none of the input names the frame.
template <class F>
auto of_frame(const FrameFile& file, const F& work) {
  try {
    return work();
  } catch (const ConfigError&) {
    throw;
  } catch (const Error& error) {
    throw Error(file.name + ": " + error.what());
  }
}

struct Detected {
  std::vector<std::string> lines;
  std::string report;
  FrameNotes notes;
};

Detected detect_in(const FrameFile& file) {
  Threads threads(file.threads);
  const Frame frame = frame_of(file, threads);
  CalibratedDetector detector(load_star_catalogue(file.catalogue, "catalogue"));
  detector.after_solution = [&](const CountImage& counts, FrameHeader& solved) {
    set_trails_of_solved(counts, threads, solved);
  };
  auto found = of_frame(file, [&] { return detector.detect(frame, threads, file.blind); });
  auto lines = as_lines(std::move(found.detection), found.header, found.notes);
  return {std::move(lines.lines), std::move(lines.report), std::move(found.notes)};
}

struct Solved {
  std::string solution;
  std::vector<std::string> cards;
  FrameNotes notes;
};

Solved solve_in(const FrameFile& file) {
  Threads threads(file.threads);
  const Frame frame = frame_of(file, threads);
  if (frame.header.shutter_closed())
    throw Error(file.name + ": the shutter was closed: there are no stars in it");
  const auto stars = load_star_catalogue(file.catalogue, "catalogue");
  if (!stars) throw ConfigError("catalogue: solving takes stars, got none");
  const FrameSolution solution =
      of_frame(file, [&] { return solve_frame(frame, *stars, {.blind = file.blind}, threads); });
  FrameHeader header = solved_header(frame.header, solution);
  if (frame.header.unknown.has(FrameFact::pointing))
    set_trails_of_solved(frame.counts, threads, header);
  return {to_json(solution, frame.header, frame.notes), frame_file_cards(frame.counts, header),
          solution.notes};
}

}  // namespace

void add_frames_of_cameras(nb::module_& module) {
  module.def("detect", [](const nb::bytes& bytes, std::string name, std::string catalogue,
                          bool blind, int threads) {
    auto file = file_of(bytes, std::move(name), std::move(catalogue), blind, threads);
    Detected found = interruptible<Detected>([file = std::move(file)] { return detect_in(file); });
    return nb::make_tuple(found.lines, found.report, found.notes.missing, found.notes.assumed);
  });
  module.def("solve", [](const nb::bytes& bytes, std::string name, std::string catalogue,
                         bool blind, int threads) {
    auto file = file_of(bytes, std::move(name), std::move(catalogue), blind, threads);
    Solved found = interruptible<Solved>([file = std::move(file)] { return solve_in(file); });
    return nb::make_tuple(found.solution, found.cards, found.notes.missing, found.notes.assumed);
  });
}

}  // namespace dmise
