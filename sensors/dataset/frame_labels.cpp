#include "sensors/dataset/frame_labels.h"

#include <array>
#include <charconv>

#include "core/base/files/json.h"
#include "core/base/units.h"
#include "core/base/version.h"
#include "core/products/product_json.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

constexpr int satellite = 1;  // category

void write_box(JsonWriter& json, const ObjectMask& mask) {
  json.list("bbox",
            std::array{mask.left, mask.top, mask.right - mask.left, mask.bottom - mask.top});
  json.field("area", std::uint64_t(mask.pixels.size()));
}

void write_mask(JsonWriter& json, const ObjectMask& mask) {
  json.key("segmentation").begin_object().list("size", std::array{mask.rows, mask.columns});
  json.field("counts", coco_counts(mask)).end_object();
}

void write_drawn(JsonWriter& json, const std::vector<DrawnValue>& drawn) {
  json.key("drawn").begin_object();
  for (const DrawnValue& value : drawn) {
    double number = 0.0;
    if (value.is_number) {
      const char* first = value.text.data() + (value.text.starts_with('+') ? 1 : 0);
      std::from_chars(first, value.text.data() + value.text.size(), number);
      json.field(value.path, number);
    } else {
      json.field(value.path, value.text);
    }
  }
  json.end_object();
}

/// Returns whether the place is in the image.
bool write_keypoint(JsonWriter& json, double x_px, double y_px, const ObjectMask& mask) {
  const bool inside =
      x_px >= -0.5 && y_px >= -0.5 && x_px < mask.columns - 0.5 && y_px < mask.rows - 0.5;
  json.value(inside ? x_px + 0.5 : 0.0).value(inside ? y_px + 0.5 : 0.0).value(inside ? 2 : 0);
  return inside;
}

}  // namespace

std::string labels_json(const LabelledFrame& l) {
  const auto utc = [&](SimTime t) { return format_utc(l.clock.utc(t), 6); };
  JsonWriter json;
  json.begin_object().field("key", l.key).field("seed", l.sample.scenario.seed);
  json.field("sensor", l.frame.report.sensor).field("frame", l.frame.report.frame);
  json.field("columns", l.columns()).field("rows", l.rows());
  json.field("software", software_name()).field("digest", l.digest);
  write_drawn(json, l.sample.drawn);
  json.key("objects").begin_array();
  for (std::size_t k = 0; k < l.objects.size(); ++k) {
    const ObjectLabel& object = l.objects[k];
    json.begin_object().field("label", std::uint64_t(k + 1)).field("name", object.truth.name);
    json.field("catalogue_number", object.truth.catalogue_number);
    json.field("snr", object.snr);
    write_box(json, object.mask);
    json.field("mask_share", object.mask.covered_e / object.mask.all_e);
    write_mask(json, object.mask);
    json.key("truth").raw(to_json(object.truth, utc)).end_object();
  }
  json.end_array().key("detections").begin_array();
  for (const Detection& detection : l.frame.detections) json.raw(to_json(detection, utc));
  json.end_array().key("report").raw(to_json(l.frame.report, utc));
  return json.end_object().take() + "\n";
}

std::string coco_image(const LabelledFrame& l, const std::string& file_name) {
  JsonWriter json;
  json.begin_object().field("file_name", file_name);
  json.field("width", l.columns()).field("height", l.rows());
  json.field("date_captured", format_utc(l.clock.utc(l.frame.report.middle), 9));
  json.field("key", l.key).field("seed", l.sample.scenario.seed);
  return json.field("sensor", l.frame.report.sensor)
      .field("frame", l.frame.report.frame)
      .end_object()
      .take();
}

std::vector<std::string> coco_annotations(const LabelledFrame& l) {
  std::vector<std::string> annotations;
  for (std::size_t k = 0; k < l.objects.size(); ++k) {
    const auto& [truth, mask, snr] = l.objects[k];
    JsonWriter json;
    json.begin_object().field("category_id", satellite).field("iscrowd", 0);
    write_box(json, mask);
    write_mask(json, mask);
    json.key("keypoints").begin_array();
    int inside = write_keypoint(json, truth.start_x_px, truth.start_y_px, mask);
    inside += write_keypoint(json, truth.end_x_px, truth.end_y_px, mask);
    json.end_array().field("num_keypoints", inside);
    json.field("label", std::uint64_t(k + 1)).field("object_name", truth.name);
    json.field("catalogue_number", truth.catalogue_number);
    json.field("magnitude", truth.true_magnitude).field("sunlit", truth.sunlit);
    json.field("signal_e", truth.rendered_signal_e).field("snr", snr);
    json.field("ra_deg", truth.true_ra_rad / deg).field("dec_deg", truth.true_dec_rad / deg);
    annotations.push_back(json.end_object().take());
  }
  return annotations;
}

std::string coco_categories() {
  JsonWriter json;
  json.begin_array().begin_object().field("id", satellite).field("name", "satellite");
  json.field("supercategory", "space object").key("keypoints").begin_array();
  json.value("start").value("end").end_array().key("skeleton").begin_array().begin_array();
  return json.value(1).value(2).end_array().end_array().end_object().end_array().take();
}

}  // namespace dmise
