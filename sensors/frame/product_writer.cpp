#include "sensors/frame/product_writer.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/files/json_record.h"
#include "core/base/files/paths.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/image/charts/marked_picture.h"
#include "core/image/fits_file.h"
#include "core/image/plane_file.h"
#include "core/pictures/picture_file.h"
#include "core/products/frame_file.h"
#include "core/products/product_json.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

template <class Carrier>
Plane plane(const char* name, const char* unit, const char* what,
            const Image<float, Carrier>& image) {
  return {name, unit, what, image.pixels, image.columns};
}

/// "2018-01-21T00:15:00.000" as Exif has it: "2018:01:21 00:15:00".
std::string exif_time(std::string utc) {
  utc.resize(std::min<std::size_t>(utc.size(), 19));
  std::replace(utc.begin(), utc.end(), '-', ':');
  std::replace(utc.begin(), utc.end(), 'T', ' ');
  return utc;
}

/// The whole band is channel Y; its parts are named by their middle, and described by attributes.
ExrImage radiance_exr(const FramePlanes& planes, const FrameHeader& h) {
  const RadianceMap& map = planes.radiance;
  ExrImage image{.columns = map.columns,
                 .rows = map.rows,
                 .channels = {{"Y", map.pixels.data()}},
                 .attributes = {{"quantity", "radiance in the band, at the aperture"},
                                {"unit", "photon s-1 m-2 sr-1"},
                                {"band", h.band.name},
                                {"band_centre_m", h.band.centre_m},
                                {"band_width_m", h.band.width_m},
                                {"sensor", h.sensor},
                                {"frame", double(h.frame)},
                                {"exposure_s", h.exposure_s},
                                {"start_utc", h.start_utc},
                                {"scenario_digest", h.scenario_digest},
                                {"software", h.software}},
                 .taken_utc = exif_time(h.start_utc)};
  for (const auto& [band, part] : planes.radiance_parts) {
    const std::string name = formatted("%08.2fnm", band.centre_m * 1e9);
    image.channels.push_back({name, part.pixels.data()});
    image.attributes.push_back({name + ".low_m", band.low_m()});
    image.attributes.push_back({name + ".high_m", band.high_m()});
  }
  return image;
}

/// A star's number in its catalogue, "S" and the number of a synthetic one, or a planet's name.
std::string name_of(const StarTruth& star) {
  if (star.id & synthetic_star_bit) return "S" + std::to_string(star.id & ~synthetic_star_bit);
  if (star.id & planet_bit) return std::string(facts_of(Planet(star.id & ~planet_bit)).name);
  return std::to_string(star.id);
}

/// Proportional set size of this process [MB]: its own memory and its share of what it shares.
double pss_mb() {
  std::ifstream file("/proc/self/smaps_rollup");
  std::string word;
  double kb = 0.0;
  while (file >> word)
    if (word == "Pss:" && file >> kb) return kb / 1e3;
  return 0.0;
}

}  // namespace

ProductWriter::ProductWriter(std::string directory, const OutputConfig& output, Clock clock)
    : directory_(std::move(directory)), output_(output), clock_(std::move(clock)) {
  make_directories(directory_);
}

std::string ProductWriter::frame_path(std::uint32_t frame, const char* ending) const {
  return directory_ + "/" + frame_file_name(frame, ending);
}

void ProductWriter::write_planes(const FrameProducts& f) const {
  const auto path = [&](const char* ending) { return frame_path(f.report.frame, ending); };
  const FramePlanes& p = f.planes;
  if (output_.sources)
    write_plane(path("-sources.fits"),
                plane("SOURCES", "electron/s", "expected of stars and objects", p.sources),
                f.header);
  if (output_.background)
    write_plane(path("-background.fits"),
                plane("BACKGROUND", "electron/s", "expected of the sky", p.background), f.header);
  if (output_.noise)
    write_plane(path("-noise.fits"),
                plane("NOISE", "electron", "expected standard deviation", p.noise), f.header);
  if (output_.radiance_exr) write_exr(path("-radiance.exr"), radiance_exr(p, f.header));
}

ProductWriter::~ProductWriter() {
  try {
    if (const std::string left = costs_.take(); !left.empty()) append(run_file::costs, left);
  } catch (const Error&) {
    // Costs of a few frames are lost, no product.
  }
}

void ProductWriter::append(const RunFile& table, const std::string& lines) const {
  const std::string path = path_in(directory_, table);
  if (lines.empty() && path_exists(path)) return;
  std::ofstream file(path, std::ios::app);
  file << lines << std::flush;
  if (!file) throw Error(path + ": can't be written: " + std::strerror(errno));
}

void ProductWriter::write(const FrameProducts& f) {
  const auto number = f.report.frame;
  if (output_.fits)
    write_frame(frame_path(number, ".fits"), f.counts, f.header,
                output_.fits_rice ? FitsCompression::rice : FitsCompression::none,
                output_.saturation ? &f.flags : nullptr);
  write_planes(f);
  if (output_.png) {
    const auto picture = preview(f.counts, output_.preview_width_px);
    write_picture(frame_path(number, ".png"), picture.picture);
    write_picture(frame_path(number, "-marked.png"),
                  marked_picture(picture, f.header, f.truths, f.detections));
  }
  if (output_.star_truth) {
    std::string csv = "id,v_mag,bv,x_px,y_px,signal_e\n";
    for (const auto& star : f.stars) {
      csv += formatted("%s,%.3f,%.3f,%.6f,%.6f,%.6g\n", name_of(star).c_str(), star.v_mag, star.bv,
                       star.x_px, star.y_px, star.signal_e);
    }
    write_file_whole(frame_path(number, ".stars.csv"), csv);
  }
  const auto utc = [this](SimTime t) { return format_utc(clock_.utc(t), 6); };
  std::string lines;
  if (output_.truth) {
    for (const auto& truth : f.truths) lines += to_json(truth, utc) + "\n";
    append(run_file::truth, lines);
  }
  lines.clear();
  for (const auto& detection : f.detections) lines += to_json(detection, utc) + "\n";
  append(run_file::detections, lines);

  append(run_file::costs, costs_.add(f, pss_mb()));
  append(run_file::frames, to_json(f.report, utc) + "\n");
}

long ProductWriter::keep_frames(std::uint32_t last) const {
  long detections = 0;
  for (const RunFile& table : run_file::of_sensor) {
    const std::string path = path_in(directory_, table);
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) continue;
    std::string kept;
    for_line_texts(path, quietly, [&](const std::string& line, const std::string& place) {
      if (JsonRecord(line, place).get<std::uint32_t>("frame") <= last) kept += line + "\n";
    });
    write_file_whole(path, kept);
    if (table.name == run_file::detections.name)
      detections = long(std::count(kept.begin(), kept.end(), '\n'));
  }
  return detections;
}

}  // namespace dmise
