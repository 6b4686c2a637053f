#include "core/products/detection_fields.h"
#include "dmise/v1/detection.pb.h"
#include "nodes/wire/codecs.h"

// Fields of a truth with the same name and type on both sides, in the order of the messages.
// clang-format off
#define DMISE_TRUTH_FIELDS(X) \
  X(sensor) X(frame) X(catalogue_number) X(name) X(true_range_m) X(true_ra_rad) X(true_dec_rad) \
  X(apparent_ra_rad) X(apparent_dec_rad) X(true_elevation_rad) X(phase_angle_rad) X(sunlit) \
  X(true_magnitude) X(rendered_signal_e) X(rendered_x_px) X(rendered_y_px) X(start_x_px) \
  X(start_y_px) X(middle_x_px) X(middle_y_px) X(end_x_px) X(end_y_px) X(in_frame) X(whole) \
  X(resolved)
// clang-format on

namespace dmise {
namespace {

#define DMISE_NONE(...)

void put_detection(v1::Detection* message, const Detection& d) {
#define DMISE_VALUE(field, key, unit) message->set_##field(d.field);
#define DMISE_TIME(field, key) message->set_##field##_ns(d.field.ns);
#define DMISE_NAME(field, key, Enum) message->set_##field(static_cast<v1::Enum>(d.field));
#define DMISE_LIST(field, ...) put(message->mutable_##field(), d.field);
#define DMISE_PAIR(x, y, key) message->set_##x(d.x), message->set_##y(d.y);
#define DMISE_WHERE(field, key) message->set_##field(d.field);
#define DMISE_MEASURED(field, key) \
  if (d.field) message->set_##field(*d.field);
  DMISE_DETECTION_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_LIST, DMISE_PAIR,
                         DMISE_NONE, DMISE_WHERE, DMISE_MEASURED)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_NAME
#undef DMISE_LIST
#undef DMISE_PAIR
#undef DMISE_WHERE
#undef DMISE_MEASURED
}

Detection take_detection(const v1::Detection& message) {
  Detection d;
#define DMISE_VALUE(field, key, unit) d.field = message.field();
#define DMISE_TIME(field, key) d.field = {message.field##_ns()};
#define DMISE_NAME(field, key, Enum)                                                           \
  if (!v1::Enum##_IsValid(message.field())) throw Refused(Refusal::value, #field ": unknown"); \
  d.field = static_cast<Enum>(message.field());
#define DMISE_LIST(field, key, unit) d.field = take<3>(message.field(), #field);
#define DMISE_VECTOR(field, key) d.field = take_vec<Gcrs>(message.field(), #field);
#define DMISE_PAIR(x, y, key) d.x = message.x(), d.y = message.y();
#define DMISE_WHERE(field, key) d.field = message.field();
#define DMISE_MEASURED(field, key) \
  if (message.has_##field()) d.field = message.field();
  DMISE_DETECTION_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_VECTOR, DMISE_PAIR,
                         DMISE_NONE, DMISE_WHERE, DMISE_MEASURED)
#undef DMISE_NONE
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_NAME
#undef DMISE_LIST
#undef DMISE_VECTOR
#undef DMISE_PAIR
#undef DMISE_WHERE
#undef DMISE_MEASURED
  return d;
}

}  // namespace

Encoded encode_body(const DetectionSet& set) {
  v1::DetectionSet message;
  message.set_sensor(set.sensor);
  message.set_frame(set.frame);
  for (const Detection& d : set.detections) put_detection(message.add_detections(), d);
  return {MessageKind::detection_set, message.SerializeAsString(), {}};
}

DetectionSet decode_detections(std::string_view payload) {
  const auto message = parse<v1::DetectionSet>(payload);
  DetectionSet set{.sensor = message.sensor(), .frame = message.frame(), .detections = {}};
  set.detections.reserve(std::size_t(message.detections_size()));
  for (const auto& d : message.detections()) set.detections.push_back(take_detection(d));
  return set;
}

Encoded encode_body(const TruthSet& set) {
  v1::TruthSet message;
  message.set_sensor(set.sensor);
  message.set_frame(set.frame);
  for (const Truth& truth : set.truths) {
    auto* t = message.add_truths();
#define X(field) t->set_##field(truth.field);
    DMISE_TRUTH_FIELDS(X)
#undef X
    t->set_start_ns(truth.start.ns);
    t->set_middle_ns(truth.middle.ns);
    t->set_end_ns(truth.end.ns);
    put(t->mutable_true_position_m(), truth.true_position_m);
    put(t->mutable_true_velocity_m_per_s(), truth.true_velocity_m_per_s);
    if (const auto& q = truth.camera_from_gcrs)
      put(t->mutable_camera_from_gcrs(), std::array<double, 4>{q->w, q->x, q->y, q->z});
  }
  return {MessageKind::truth_set, message.SerializeAsString(), {}};
}

TruthSet decode_truths(std::string_view payload) {
  const auto message = parse<v1::TruthSet>(payload);
  TruthSet set{.sensor = message.sensor(), .frame = message.frame(), .truths = {}};
  set.truths.reserve(std::size_t(message.truths_size()));
  for (const auto& t : message.truths()) {
    Truth truth;
#define X(field) truth.field = t.field();
    DMISE_TRUTH_FIELDS(X)
#undef X
    truth.start = {t.start_ns()};
    truth.middle = {t.middle_ns()};
    truth.end = {t.end_ns()};
    truth.true_position_m = take_vec<Gcrs>(t.true_position_m(), "true_position_m");
    truth.true_velocity_m_per_s =
        take_vec<Gcrs>(t.true_velocity_m_per_s(), "true_velocity_m_per_s");
    if (t.camera_from_gcrs_size() > 0) {
      const auto q = take<4>(t.camera_from_gcrs(), "camera_from_gcrs");
      truth.camera_from_gcrs = Quaternion{q[0], q[1], q[2], q[3]};
    }
    set.truths.push_back(std::move(truth));
  }
  return set;
}

}  // namespace dmise
