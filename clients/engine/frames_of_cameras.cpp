#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "clients/engine/arrays.h"
#include "clients/engine/engine.h"
#include "clients/engine/interruptible.h"
#include "core/astrometry/calibrated_detection.h"
#include "core/config/load_star_catalogue.h"
#include "core/detection/detection_lines.h"
#include "core/ingest/any_frame.h"
#include "core/ingest/star_trails.h"
#include "core/wcs/wcs.h"

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

CalibratedDetector::Result detected_in(const FrameFile& file, const Frame& frame,
                                       Threads& threads) {
  CalibratedDetector detector(load_star_catalogue(file.catalogue, "catalogue"));
  detector.after_solution = [&](const CountImage& counts, FrameHeader& solved) {
    set_trails_of_solved(counts, threads, solved);
  };
  return of_frame(file, [&] { return detector.detect(frame, threads, file.blind); });
}

/// A frame, what is known of its camera, and the noise of its sky.
struct Calibrated {
  Frame frame;
  FrameHeader header;
  FrameNotes notes;
  double noise_e = 0.0;
};

Calibrated calibrated_in(const FrameFile& file) {
  Threads threads(file.threads);
  Frame frame = frame_of(file, threads);
  auto found = detected_in(file, frame, threads);
  return {std::move(frame), std::move(found.header), std::move(found.notes),
          found.detection.report.noise_e};
}

struct Detected {
  std::vector<std::string> lines;
  std::string report;
  FrameNotes notes;
};

Detected detect_in(const FrameFile& file) {
  Threads threads(file.threads);
  const Frame frame = frame_of(file, threads);
  auto found = detected_in(file, frame, threads);
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

/// Directions of pixels, n x 3: unit vectors of ICRS.
nb::object directions_of(const Wcs& wcs, const std::vector<double>& x,
                         const std::vector<double>& y) {
  std::vector<double> directions;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    const Vec<Gcrs> to = wcs_direction(wcs, {x[i], y[i]});
    directions.insert(directions.end(), {to.x, to.y, to.z});
  }
  const std::size_t count = directions.size() / 3;
  return array_of(std::move(directions), {count, 3});
}

/// Pixels of directions, n x 2: NaN of one that has none.
nb::object pixels_of(const Wcs& wcs, const std::vector<std::array<double, 3>>& directions) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> pixels;
  for (const auto& [x, y, z] : directions) {
    const auto at = wcs_pixel(wcs, Vec<Gcrs>{x, y, z});
    pixels.insert(pixels.end(), {at ? at->x_px : none, at ? at->y_px : none});
  }
  return array_of(std::move(pixels), {directions.size(), 2});
}

void add_calibrated(nb::module_& module) {
  nb::class_<Wcs>(module, "Wcs").def("directions", &directions_of).def("pixels", &pixels_of);
  nb::class_<Calibrated>(module, "Calibrated")
      .def_prop_ro("count_zero", [](const Calibrated& c) { return c.frame.count_zero; })
      .def_prop_ro("count_step", [](const Calibrated& c) { return c.frame.count_step; })
      .def_prop_ro("wcs", [](const Calibrated& c) { return c.header.wcs; })
      .def_prop_ro("start_utc", [](const Calibrated& c) { return c.header.start_utc; })
      .def_prop_ro("exposure_s", [](const Calibrated& c) { return c.header.exposure_s; })
      .def_prop_ro("mount", [](const Calibrated& c) { return c.header.mount; })
      .def_prop_ro("gain_e_per_dn", [](const Calibrated& c) { return c.header.gain_e_per_dn; })
      .def_prop_ro("saturation_dn", [](const Calibrated& c) { return c.header.saturation_dn; })
      .def_prop_ro("psf_fwhm_px", [](const Calibrated& c) { return c.header.psf_fwhm_px; })
      .def_prop_ro("zero_point_mag",
                   [](const Calibrated& c) { return c.header.v_solar_zero_point_mag(); })
      .def_prop_ro("unknown", [](const Calibrated& c) { return c.header.unknown.text(); })
      .def_prop_ro("simulated",
                   [](const Calibrated& c) { return !c.header.scenario_digest.empty(); })
      .def_prop_ro("noise_e", [](const Calibrated& c) { return c.noise_e; })
      .def_prop_ro("missing", [](const Calibrated& c) { return c.notes.missing; })
      .def_prop_ro("assumed", [](const Calibrated& c) { return c.notes.assumed; });
  module.def("calibrate", [](const nb::bytes& bytes, std::string name, std::string catalogue,
                             bool blind, int threads) {
    auto file = file_of(bytes, std::move(name), std::move(catalogue), blind, threads);
    return interruptible<std::shared_ptr<Calibrated>>(
        [file = std::move(file)] { return std::make_shared<Calibrated>(calibrated_in(file)); });
  });
}

}  // namespace

void add_frames_of_cameras(nb::module_& module) {
  add_calibrated(module);
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
