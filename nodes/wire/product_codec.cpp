#include "dmise/v1/detection.pb.h"
#include "dmise/v1/frame.pb.h"
#include "dmise/v1/task.pb.h"
#include "dmise/v1/track.pb.h"
#include "nodes/wire/codecs.h"
#include "nodes/wire/product_message.h"

namespace dmise {
namespace {

template <class Product, class Messages>
std::vector<Product> take_products(const Messages& messages) {
  std::vector<Product> products;
  products.reserve(std::size_t(messages.size()));
  for (const auto& message : messages) products.push_back(take_product<Product>(message));
  return products;
}

}  // namespace

Encoded encode_body(const FrameReport& report) {
  v1::FrameReport message;
  put_product(message, report);
  return {MessageKind::frame_report, message.SerializeAsString(), {}};
}

FrameReport decode_report(std::string_view payload) {
  return take_product<FrameReport>(parse<v1::FrameReport>(payload));
}

Encoded encode_body(const DetectionSet& set) {
  v1::DetectionSet message;
  message.set_sensor(set.sensor);
  message.set_frame(set.frame);
  for (const Detection& d : set.detections) put_product(*message.add_detections(), d);
  return {MessageKind::detection_set, message.SerializeAsString(), {}};
}

DetectionSet decode_detections(std::string_view payload) {
  const auto message = parse<v1::DetectionSet>(payload);
  return {.sensor = message.sensor(),
          .frame = message.frame(),
          .detections = take_products<Detection>(message.detections())};
}

Encoded encode_body(const TruthSet& set) {
  v1::TruthSet message;
  message.set_sensor(set.sensor);
  message.set_frame(set.frame);
  for (const Truth& truth : set.truths) put_product(*message.add_truths(), truth);
  return {MessageKind::truth_set, message.SerializeAsString(), {}};
}

TruthSet decode_truths(std::string_view payload) {
  const auto message = parse<v1::TruthSet>(payload);
  return {.sensor = message.sensor(),
          .frame = message.frame(),
          .truths = take_products<Truth>(message.truths())};
}

Encoded encode_body(const TrackSet& set) {
  v1::TrackSet message;
  message.set_node(set.node);
  message.set_tick(set.tick);
  message.set_time_ns(set.time.ns);
  message.set_live(set.live);
  message.set_unassociated(set.unassociated);
  for (const Track& t : set.tracks) put_product(*message.add_tracks(), t);
  return {MessageKind::track_set, message.SerializeAsString(), {}};
}

TrackSet decode_tracks(std::string_view payload) {
  const auto message = parse<v1::TrackSet>(payload);
  return {.tick = message.tick(),
          .time = {message.time_ns()},
          .node = message.node(),
          .live = message.live(),
          .unassociated = message.unassociated(),
          .tracks = take_products<Track>(message.tracks())};
}

Encoded encode_body(const TaskSet& set) {
  v1::TaskSet message;
  message.set_node(set.node);
  message.set_sensor(set.sensor);
  message.set_tick(set.tick);
  message.set_time_ns(set.time.ns);
  for (const Task& t : set.tasks) put_product(*message.add_tasks(), t);
  return {MessageKind::task_set, message.SerializeAsString(), {}};
}

TaskSet decode_tasks(std::string_view payload) {
  const auto message = parse<v1::TaskSet>(payload);
  return {.tick = message.tick(),
          .time = {message.time_ns()},
          .node = message.node(),
          .sensor = message.sensor(),
          .tasks = take_products<Task>(message.tasks())};
}

}  // namespace dmise
