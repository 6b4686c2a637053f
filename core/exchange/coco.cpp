#include "core/exchange/coco.h"

#include "core/base/files/json.h"
#include "core/exchange/export_format.h"
#include "core/exchange/image_label.h"
#include "core/products/frame_file.h"
#include "core/score/trail.h"

namespace dmise {
namespace {

constexpr int satellite = 1;

/// Images are numbered from 1 in the order of frames.jsonl.
std::size_t image_id(const RunProducts& run, const std::string& sensor, std::uint32_t frame) {
  return run.index_of(sensor, frame) + 1;
}

void write_box(JsonWriter& json, const PixelBox& box) {
  json.key("bbox").begin_array().value(box.left_px + 0.5).value(box.top_px + 0.5);
  json.value(box.right_px - box.left_px).value(box.bottom_px - box.top_px).end_array();
}

void write_images(const RunProducts& run, JsonWriter& json) {
  json.key("images").begin_array();
  for (const RunFrame& f : run.frames) {
    const RunSensor& camera = run.sensor(f.sensor);
    if (camera.columns == 0) continue;  // no image
    json.begin_object().field("id", image_id(run, f.sensor, f.frame));
    json.field("file_name", f.sensor + "/" + frame_file_name(f.frame))
        .field("width", camera.columns);
    json.field("height", camera.rows).field("date_captured", run.utc(f.middle)).end_object();
  }
  json.end_array();
}

void write_annotation(const RunProducts& run, const Truth& t, const ImageLabel& label,
                      std::size_t id, JsonWriter& json) {
  const RunSensor& camera = run.sensor(t.sensor);
  const auto outline = outline_of(label, camera.columns, camera.rows);
  json.begin_object().field("id", id).field("image_id", image_id(run, t.sensor, t.frame));
  json.field("category_id", satellite).field("iscrowd", 0);
  write_box(json, label.box);
  json.field("area", area_px2(outline)).key("segmentation").begin_array().begin_array();
  for (const PixelPosition& p : outline) json.value(p.x_px + 0.5).value(p.y_px + 0.5);
  json.end_array().end_array().key("keypoints").begin_array();
  int labelled = 0;  // those inside the image
  for (const PixelPosition& p : {label.start, label.end}) {
    const bool visible = p.x_px >= -0.5 && p.x_px < camera.columns - 0.5 && p.y_px >= -0.5 &&
                         p.y_px < camera.rows - 0.5;
    labelled += visible;
    if (visible)
      json.value(p.x_px + 0.5).value(p.y_px + 0.5).value(2);
    else
      json.value(0.0).value(0.0).value(0);
  }
  json.end_array().field("num_keypoints", labelled);
  json.field("object_name", t.name).field("catalogue_number", t.catalogue_number);
  json.field("magnitude", t.true_magnitude).field("sunlit", t.sunlit);
  json.field("signal_e", t.rendered_signal_e).end_object();
}

std::string results(const RunProducts& run) {
  JsonWriter json;
  json.begin_array();
  for (const Detection& d : run.detections)
    if (const auto label = label_of(d, run)) {
      json.begin_object().field("image_id", image_id(run, d.sensor, d.frame));
      json.field("category_id", satellite);
      write_box(json, label->box);
      json.field("score", d.snr).field("id", d.id).end_object();
    }
  return json.end_array().take() + "\n";
}

}  // namespace

std::string coco_json(const ExportRequest& request) {
  const RunProducts& run = request.run;
  if (request.kind == ProductKind::detections) return results(run);
  JsonWriter json;
  json.begin_object().key("info").begin_object();
  json.field("description", "scenario " + run.digest + ", seed " + std::to_string(run.seed));
  json.field("version", run.software).field("date_created", run.utc({0})).end_object();
  json.key("licenses").begin_array().end_array();
  write_images(run, json);
  json.key("annotations").begin_array();
  std::size_t id = 0;
  for (const Truth& t : run.truths)
    if (const auto label = label_of(t, run)) write_annotation(run, t, *label, ++id, json);
  json.end_array().key("categories").begin_array().begin_object().field("id", satellite);
  json.field("name", "satellite").field("supercategory", "space object").key("keypoints");
  json.begin_array().value("start").value("end").end_array().key("skeleton").begin_array();
  json.begin_array().value(1).value(2).end_array().end_array().end_object().end_array();
  return json.end_object().take() + "\n";
}

}  // namespace dmise
