#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "core/base/error.h"
#include "core/base/files/regular_file.h"
#include "core/base/files/whole_file.h"
#include "core/camera_calibration/calibrate_camera.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/command/notes.h"
#include "launch/frames/frame_options.h"
#include "launch/run/star_catalogue_option.h"

namespace dmise {
namespace {

struct CalibrateOptions {
  std::vector<std::string> frames, biases, darks, flats, lights;
  std::string out, catalogue;
  bool json = false;
  int threads = 1;
  StatedCamera stated;
  std::shared_ptr<FrameChoice> choice = std::make_shared<FrameChoice>();
};

std::vector<CalibrationFile> files_of(const CalibrateOptions& o) {
  std::vector<CalibrationFile> files;
  const auto add = [&](const std::vector<std::string>& paths, FrameKind kind) {
    for (const std::string& path : paths) files.push_back({path, kind});
  };
  add(o.frames, FrameKind::unknown);
  add(o.biases, FrameKind::bias);
  add(o.darks, FrameKind::dark);
  add(o.flats, FrameKind::flat);
  add(o.lights, FrameKind::light);
  return files;
}

void calibrate(const CalibrateOptions& o) {
  const auto files = files_of(o);
  const std::string out = o.out.empty() ? "" : file_to_write("--out", o.out);
  std::error_code none;
  for (const CalibrationFile& file : files)
    if (!out.empty() && std::filesystem::equivalent(file.path, out, none))
      throw ConfigError("--out: must not be one of the frames, got " + o.out);
  Threads threads(o.threads);
  const auto stars = load_star_catalogue(o.catalogue);
  const CameraCalibration camera =
      calibrate_camera(files, *o.choice, o.stated, stars.get(), threads);
  for (const std::string& note : camera.notes) print_note(note);
  if (!out.empty()) write_file_whole(out, to_yaml(camera));
  if (o.json)
    std::printf("%s\n", to_json(camera).c_str());
  else
    std::printf("%s", to_table(camera).c_str());
}

void add_stated_options(CLI::App& command, StatedCamera& stated) {
  const auto number = [&](const char* name, std::optional<double>& to, double low, double high,
                          double unit, const char* what) {
    command
        .add_option_function<double>(
            name, [&to, unit](const double& value) { to = value * unit; }, what)
        ->check(number_between(low, high));
  };
  command.add_option("--name", stated.name, "name of the camera");
  command
      .add_option("--band", stated.band,
                  "filter of the camera (dmise list filters), or a CSV file of its transmission")
      ->capture_default_str();
  number("--pixel-um", stated.pixel_pitch_m, 0.1, 1000, 1e-6, "distance between pixels [um]");
  number("--focal-mm", stated.focal_length_m, 0.1, 1e8, 1e-3, "focal length [mm]");
  number("--aperture-mm", stated.aperture_m, 0.1, 1e8, 1e-3, "diameter of the aperture [mm]");
  number("--obscuration", stated.obscuration, 0, 0.99, 1,
         "diameter of the secondary in that of the primary");
  number("--transmission", stated.transmission, 1e-6, 1, 1, "share of light through the optics");
  number("--quantum-efficiency", stated.quantum_efficiency, 1e-6, 1, 1,
         "photo-electrons a photon; if not given it is in the transmission");
}

void add_calibrate_options(CLI::App& command) {
  auto o = std::make_shared<CalibrateOptions>();
  o->stated.band = "bessell-V";
  command.add_option("frames", o->frames,
                     "FITS files, sorted by IMAGETYP, else by exposure, level and stars");
  command.add_option("--bias", o->biases, "frames without light and time");
  command.add_option("--dark", o->darks, "frames without light");
  command.add_option("--flat", o->flats, "frames of even light");
  command.add_option("--light", o->lights, "frames of stars");
  command.add_option("--out", o->out, "camera file to write (YAML)");
  command.add_flag("--json", o->json, "print one line of JSON");
  add_stated_options(command, o->stated);
  add_frame_options(command, o->choice);
  add_star_catalogue_option(command, o->catalogue, true);
  add_threads_option(command, o->threads, "number of threads; the result does not depend on it");
  command.footer("docs/howto/calibrate-a-camera.md shows how, and how well it measures");
  command.callback([o] { calibrate(*o); });
}

}  // namespace

Command calibrate_command() {
  return {
      .group = CommandGroup::frames,
      .summary = "Measures a camera by its own frames, and writes the camera file with deviations",
      .details = "From frames of bias, dark, flat and stars. The file is one for scenarios",
      .add_options = add_calibrate_options};
}

}  // namespace dmise
