#include "core/products/track_fields.h"
#include "dmise/v1/track.pb.h"
#include "nodes/wire/codecs.h"

namespace dmise {
namespace {

void put_track(v1::Track* message, const Track& t) {
#define DMISE_VALUE(field, key) message->set_##field(t.field);
#define DMISE_TIME(field, key) message->set_##field##_ns(t.field.ns);
#define DMISE_NAME(field, key, Enum) message->set_##field(static_cast<v1::Enum>(t.field));
#define DMISE_LIST(field, ...) put(message->mutable_##field(), t.field);
#define DMISE_TEXTS(field, key) message->mutable_##field()->Add(t.field.begin(), t.field.end());
  DMISE_TRACK_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_LIST, DMISE_TEXTS)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_NAME
#undef DMISE_LIST
#undef DMISE_TEXTS
}

Track take_track(const v1::Track& message) {
  Track t;
#define DMISE_VALUE(field, key) t.field = message.field();
#define DMISE_TIME(field, key) t.field = {message.field##_ns()};
#define DMISE_NAME(field, key, Enum)                                                           \
  if (!v1::Enum##_IsValid(message.field())) throw Refused(Refusal::value, #field ": unknown"); \
  t.field = static_cast<Enum>(message.field());
#define DMISE_LIST(field, key, size) t.field = take<size>(message.field(), #field);
#define DMISE_VECTOR(field, key) t.field = take_vec<Gcrs>(message.field(), #field);
#define DMISE_TEXTS(field, key) t.field.assign(message.field().begin(), message.field().end());
  DMISE_TRACK_FIELDS(DMISE_VALUE, DMISE_TIME, DMISE_NAME, DMISE_LIST, DMISE_VECTOR, DMISE_TEXTS)
#undef DMISE_VALUE
#undef DMISE_TIME
#undef DMISE_NAME
#undef DMISE_LIST
#undef DMISE_VECTOR
#undef DMISE_TEXTS
  return t;
}

}  // namespace

Encoded encode_body(const TrackSet& set) {
  v1::TrackSet message;
  message.set_node(set.node);
  message.set_tick(set.tick);
  message.set_time_ns(set.time.ns);
  message.set_live(set.live);
  message.set_unassociated(set.unassociated);
  for (const Track& t : set.tracks) put_track(message.add_tracks(), t);
  return {MessageKind::track_set, message.SerializeAsString(), {}};
}

TrackSet decode_tracks(std::string_view payload) {
  const auto message = parse<v1::TrackSet>(payload);
  TrackSet set{.tick = message.tick(),
               .time = {message.time_ns()},
               .node = message.node(),
               .live = message.live(),
               .unassociated = message.unassociated(),
               .tracks = {}};
  set.tracks.reserve(std::size_t(message.tracks_size()));
  for (const auto& t : message.tracks()) set.tracks.push_back(take_track(t));
  return set;
}

}  // namespace dmise
