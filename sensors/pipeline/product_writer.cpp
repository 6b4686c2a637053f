#include "sensors/pipeline/product_writer.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/text_file.h"
#include "core/detection/detection_json.h"
#include "core/image/fits_file.h"
#include "core/image/marked_picture.h"
#include "core/image/png_file.h"
#include "core/time/iso8601.h"

namespace dmise {

double pss_mb() {
  std::ifstream file("/proc/self/smaps_rollup");
  std::string word;
  double kb = 0.0;
  while (file >> word)
    if (word == "Pss:" && file >> kb) return kb / 1e3;
  return 0.0;
}

ProductWriter::ProductWriter(std::string directory, const OutputConfig& output, Clock clock)
    : directory_(std::move(directory)), output_(output), clock_(std::move(clock)) {
  std::error_code code;
  std::filesystem::create_directories(directory_, code);
  if (code) throw Error(directory_ + ": can't be made: " + code.message());
}

std::string ProductWriter::frame_path(std::uint32_t frame, const char* ending) const {
  char name[64];
  std::snprintf(name, sizeof name, "/frame-%06u%s", frame, ending);
  return directory_ + name;
}

void ProductWriter::append(const char* name, const std::string& lines) const {
  const std::string path = directory_ + "/" + name;
  std::ofstream file(path, std::ios::app);
  file << lines << std::flush;
  if (!file) throw Error(path + ": can't be written: " + std::strerror(errno));
}

void ProductWriter::write(const FrameProducts& f) {
  const auto number = f.report.frame;
  if (output_.fits) write_frame(frame_path(number, ".fits"), f.counts, f.header);
  if (output_.png) {
    const auto picture = preview(f.counts, {.max_width = output_.preview_width_px});
    write_png(frame_path(number, ".png"), picture.picture);
    write_png(frame_path(number, "-marked.png"),
              marked_picture(picture, f.header, f.truths, f.detections));
  }
  if (output_.star_truth) {
    std::string csv = "id,v_mag,bv,x_px,y_px,signal_e\n";
    for (const auto& star : f.stars) {
      char row[160];
      std::snprintf(row, sizeof row, "%u,%.3f,%.3f,%.6f,%.6f,%.6g\n", star.id, star.v_mag, star.bv,
                    star.x_px, star.y_px, star.signal_e);
      csv += row;
    }
    write_file_whole(frame_path(number, ".stars.csv"), csv);
  }
  const auto utc = [this](SimTime t) { return format_utc(clock_.utc(t), 6); };
  std::string lines;
  if (output_.truth) {
    for (const auto& truth : f.truths) lines += to_json(truth, utc) + "\n";
    append("truth.jsonl", lines);
  }
  lines.clear();
  for (const auto& detection : f.detections) lines += to_json(detection, utc) + "\n";
  append("detections.jsonl", lines);

  JsonWriter cost;
  cost.begin_object().field("sensor", f.report.sensor).field("frame", number);
  cost.field("total_s", f.total_s).field("detection_s", f.detection_s).field("pss_mb", pss_mb());
  cost.key("effects_s").begin_object();
  for (std::size_t i = 0; i < effect_count; ++i)
    cost.field(facts(static_cast<Effect>(i)).name, f.times.seconds[i]);
  cost.end_object().end_object();
  append("cost.jsonl", cost.take() + "\n");
  append("frames.jsonl", to_json(f.report, utc) + "\n");
}

}  // namespace dmise
