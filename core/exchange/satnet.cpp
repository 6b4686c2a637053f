#include "core/exchange/satnet.h"

#include <algorithm>

#include "core/base/files/json.h"
#include "core/base/files/paths.h"
#include "core/base/formatted.h"
#include "core/base/units.h"
#include "core/exchange/export_format.h"
#include "core/exchange/image_label.h"
#include "core/products/frame_file.h"

namespace dmise {
namespace {

void write_object(const Truth& t, const ImageLabel& label, const RunSensor& camera, int number,
                  double exposure_s, JsonWriter& json) {
  const auto x = [&](PixelPosition p) { return (p.x_px + 0.5) / camera.columns; };
  const auto y = [&](PixelPosition p) { return (p.y_px + 0.5) / camera.rows; };
  const auto [left, right] = std::minmax({x(label.start), x(label.middle), x(label.end)});
  const auto [top, bottom] = std::minmax({y(label.start), y(label.middle), y(label.end)});
  json.begin_object().field("class_name", "Satellite").field("class_id", 1);
  json.field("y_min", top).field("x_min", left).field("y_max", bottom).field("x_max", right);
  json.field("y_center", (top + bottom) / 2.0).field("x_center", (left + right) / 2.0);
  json.field("bbox_height", bottom - top + 2.0 * label.margin_px / camera.rows);
  json.field("bbox_width", right - left + 2.0 * label.margin_px / camera.columns);
  json.field("source", "dmise").field("magnitude", t.true_magnitude);
  json.field("pe_per_sec", t.rendered_signal_e / exposure_s);
  json.field("y_start", y(label.start)).field("x_start", x(label.start));
  json.field("y_mid", y(label.middle)).field("x_mid", x(label.middle));
  json.field("y_end", y(label.end)).field("x_end", x(label.end));
  json.field("seg_id", number).field("object_name", t.name);
  json.field("object_id", t.catalogue_number > 0 ? std::to_string(t.catalogue_number) : "");
  json.field("ra", t.true_ra_rad / deg).field("dec", t.true_dec_rad / deg).end_object();
}

std::string annotation(const RunProducts& run, const RunFrame& frame, const std::string& file,
                       const std::vector<const Truth*>& truths) {
  const RunSensor& camera = run.sensor(frame.sensor);
  JsonWriter json;
  json.begin_object().key("data").begin_object().key("file").begin_object();
  json.field("dirname", frame.sensor).field("sequence", 0).field("filename", file);
  json.field("sequence_id", frame.frame).end_object().key("sensor").begin_object();
  json.field("height", camera.rows).field("width", camera.columns);
  json.field("iFOVy", frame.row_step_deg).field("iFOVx", frame.column_step_deg).end_object();
  json.key("objects").begin_array();
  int number = 0, written = 0;
  for (const Truth* t : truths) {
    ++number;
    const auto label = label_of(*t, run);
    if (!label) continue;
    write_object(*t, *label, camera, number, (t->end - t->start).seconds(), json);
    ++written;
  }
  json.end_array().key("stats").begin_object().field("num_obs_initial", number);
  json.field("num_obs", written).end_object().key("metadata").begin_object();
  json.field("time", run.utc(frame.middle)).field("exposure_s", frame.exposure_s());
  return json.end_object().end_object().end_object().take() + "\n";
}

}  // namespace

std::vector<ExportedFile> satnet_files(const ExportRequest& request) {
  const RunProducts& run = request.run;
  std::vector<std::vector<const Truth*>> truths(run.frames.size());
  for (const Truth& t : run.truths) truths[run.index_of(t.sensor, t.frame)].push_back(&t);
  std::vector<ExportedFile> files;
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const RunFrame& f = run.frames[i];
    if (run.sensor(f.sensor).columns == 0) continue;  // no image
    const std::string stem = f.sensor + formatted(".%04u", f.frame);
    const std::string source = run.directory + "/" + f.sensor + "/" + frame_file_name(f.frame);
    files.push_back({f.sensor + "/Annotations/" + stem + ".json",
                     annotation(run, f, stem + ".fits", truths[i]), ""});
    if (path_exists(source))
      files.push_back({f.sensor + "/ImageFiles/" + stem + ".fits", "", source});
  }
  return files;
}

}  // namespace dmise
