#include "dmise/v1/detection.pb.h"
#include "nodes/wire/codecs.h"

// Fields that have one name and type on both sides, in the order of the messages.
// clang-format off
#define DMISE_DETECTION_FIELDS(X) \
  X(id) X(sensor) X(frame) X(index) X(ra_rad) X(dec_rad) X(corrected_ra_rad) X(corrected_dec_rad) \
  X(light_time_removed) X(aberration_removed) X(refraction_removed) X(magnitude) \
  X(magnitude_sigma) X(band) X(snr) X(x_px) X(y_px) X(signal_e) X(end1_x_px) X(end1_y_px) \
  X(end2_x_px) X(end2_y_px) X(end1_ra_rad) X(end1_dec_rad) X(end2_ra_rad) X(end2_dec_rad) \
  X(direction_known) X(length_px) X(rate_rad_per_s) X(saturated) X(at_edge) X(star_like) \
  X(refraction_parallax_rad) X(refraction_parallax_sigma_rad)
// clang-format on

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

void put_detection(v1::Detection* message, const Detection& d) {
#define X(field) message->set_##field(d.field);
  DMISE_DETECTION_FIELDS(X)
#undef X
  message->set_kind(static_cast<v1::DetectionKind>(d.kind));
  message->set_epoch(static_cast<v1::ExposureEpoch>(d.epoch));
  message->set_time_ns(d.time.ns);
  message->set_end1_time_ns(d.end1_time.ns);
  message->set_end2_time_ns(d.end2_time.ns);
  put(message->mutable_covariance_rad2(), d.covariance_rad2);
  put(message->mutable_covariance_px2(), d.covariance_px2);
  put(message->mutable_end1_covariance_rad2(), d.end1_covariance_rad2);
  put(message->mutable_end2_covariance_rad2(), d.end2_covariance_rad2);
  put(message->mutable_sensor_position_m(), d.sensor_position_m);
  put(message->mutable_sensor_velocity_m_per_s(), d.sensor_velocity_m_per_s);
  put(message->mutable_refraction_offset_m(), d.refraction_offset_m);
}

Detection take_detection(const v1::Detection& message) {
  Detection d;
#define X(field) d.field = message.field();
  DMISE_DETECTION_FIELDS(X)
#undef X
  if (!v1::DetectionKind_IsValid(message.kind())) throw Refused(Refusal::value, "kind: unknown");
  if (!v1::ExposureEpoch_IsValid(message.epoch())) throw Refused(Refusal::value, "epoch: unknown");
  d.kind = static_cast<DetectionKind>(message.kind());
  d.epoch = static_cast<ExposureEpoch>(message.epoch());
  d.time = {message.time_ns()};
  d.end1_time = {message.end1_time_ns()};
  d.end2_time = {message.end2_time_ns()};
  d.covariance_rad2 = take<3>(message.covariance_rad2(), "covariance_rad2");
  d.covariance_px2 = take<3>(message.covariance_px2(), "covariance_px2");
  d.end1_covariance_rad2 = take<3>(message.end1_covariance_rad2(), "end1_covariance_rad2");
  d.end2_covariance_rad2 = take<3>(message.end2_covariance_rad2(), "end2_covariance_rad2");
  d.sensor_position_m = take_vec<Gcrs>(message.sensor_position_m(), "sensor_position_m");
  d.sensor_velocity_m_per_s =
      take_vec<Gcrs>(message.sensor_velocity_m_per_s(), "sensor_velocity_m_per_s");
  d.refraction_offset_m = take_vec<Gcrs>(message.refraction_offset_m(), "refraction_offset_m");
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
    set.truths.push_back(std::move(truth));
  }
  return set;
}

}  // namespace dmise
