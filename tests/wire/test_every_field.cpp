#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>

#include "core/products/frame_report.h"
#include "core/products/product_json.h"
#include "dmise/v1/detection.pb.h"
#include "dmise/v1/environment.pb.h"
#include "dmise/v1/frame.pb.h"
#include "dmise/v1/state.pb.h"
#include "dmise/v1/task.pb.h"
#include "dmise/v1/track.pb.h"
#include "nodes/wire/codecs.h"
#include "tests/wire/examples.h"

// No codec and no JSON line forgets a field: whoever adds one to a message, and to nothing else,
// fails here. The descriptors of the messages are the list of fields.
namespace dmise {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using namespace test;

using Visit = std::function<void(const std::string& path)>;

/// Gives a singular field, or the first element of a repeated one, another value.
void change(Message& m, const FieldDescriptor* f) {
  const auto* r = m.GetReflection();
  const bool list = f->is_repeated();
#define DMISE_CHANGE(Type, value)                     \
  {                                                   \
    if (list) {                                       \
      const auto old = r->GetRepeated##Type(m, f, 0); \
      r->SetRepeated##Type(&m, f, 0, value);          \
    } else {                                          \
      const auto old = r->Get##Type(m, f);            \
      r->Set##Type(&m, f, value);                     \
    }                                                 \
  }                                                   \
  break
  switch (f->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      DMISE_CHANGE(Double, old == 0 ? 0.25 : old * 1.001);
    case FieldDescriptor::CPPTYPE_INT64:
      DMISE_CHANGE(Int64, old + 1'000'000);
    case FieldDescriptor::CPPTYPE_UINT64:
      DMISE_CHANGE(UInt64, old + 1);
    case FieldDescriptor::CPPTYPE_INT32:
      DMISE_CHANGE(Int32, old + 1);
    case FieldDescriptor::CPPTYPE_UINT32:
      DMISE_CHANGE(UInt32, old + 1);
    case FieldDescriptor::CPPTYPE_BOOL:
      DMISE_CHANGE(Bool, !old);
    case FieldDescriptor::CPPTYPE_ENUM:
      DMISE_CHANGE(EnumValue, (old + 1) % f->enum_type()->value_count());
    case FieldDescriptor::CPPTYPE_STRING:
      DMISE_CHANGE(String, old + "x");
    default:
      FAIL() << f->full_name() << ": a type that this test does not know";
  }
#undef DMISE_CHANGE
}

/// Calls `visit` once for each field of `m`, at any depth, while it alone has another value. The
/// first element of a list stands for all.
void for_each_changed_field(Message& m, const std::string& path, const Visit& visit) {
  const auto* r = m.GetReflection();
  for (int i = 0; i < m.GetDescriptor()->field_count(); ++i) {
    const FieldDescriptor* f = m.GetDescriptor()->field(i);
    const std::string here = path + f->name();
    if (f->is_repeated() && r->FieldSize(m, f) == 0) {
      ADD_FAILURE() << here << ": the example has none";
      continue;
    }
    if (f->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      if (!f->is_repeated() && !r->HasField(m, f) && f->containing_oneof()) continue;
      for_each_changed_field(
          f->is_repeated() ? *r->MutableRepeatedMessage(&m, f, 0) : *r->MutableMessage(&m, f),
          here + ".", visit);
      continue;
    }
    if (f->containing_oneof() && !r->HasField(m, f)) continue;  // would unset the one that is set
    std::unique_ptr<Message> before(m.New());
    before->CopyFrom(m);
    change(m, f);
    visit(here);
    m.CopyFrom(*before);
  }
}

const Example& example_of(const std::vector<Example>& all, std::size_t kind) {
  for (const Example& e : all)
    if (e.state.index() == kind) return e;
  throw Error("no example of state " + std::to_string(kind));
}

/// Fails for each field of `M` that the decoder leaves out. The decoder may refuse the change.
template <class M, class S>
void every_field_is_decoded(
    std::function<S(std::string_view payload, std::string_view arrays)> decode) {
  const auto all = examples(6);
  const Example& example = example_of(all, State(S{}).index());
  const S before = std::get<S>(example.state);
  const Encoded encoded = encode(example.state);
  M message = parse<M>(encoded.payload);
  int fields = 0;
  for_each_changed_field(message, "", [&](const std::string& path) {
    ++fields;
    try {
      EXPECT_FALSE(decode(message.SerializeAsString(), encoded.arrays) == before)
          << M::descriptor()->full_name() << " " << path << ": is not decoded";
    } catch (const Refused&) {
    }
  });
  EXPECT_GT(fields, 2);
}

TEST(EveryField, OfAMessageIsDecoded) {
  const auto alone = [](auto decode) {
    return [decode](std::string_view payload, std::string_view) { return decode(payload); };
  };
  every_field_is_decoded<v1::ObjectRoster, ObjectRoster>(decode_roster);
  every_field_is_decoded<v1::ObjectStates, ObjectStates>(decode_states);
  every_field_is_decoded<v1::EnvironmentState, EnvironmentState>(alone(decode_environment));
  every_field_is_decoded<v1::SiteState, SiteState>(alone(decode_site));
  every_field_is_decoded<v1::FrameReport, FrameReport>(alone(decode_report));
  every_field_is_decoded<v1::DetectionSet, DetectionSet>(alone(decode_detections));
  every_field_is_decoded<v1::TruthSet, TruthSet>(alone(decode_truths));
  every_field_is_decoded<v1::TrackSet, TrackSet>(alone(decode_tracks));
  every_field_is_decoded<v1::TaskSet, TaskSet>(alone(decode_tasks));
}

/// Fails for each field of `M` that makes no difference to the JSON line of what is decoded. The
/// decoder may refuse the change.
template <class M, class S>
void every_field_is_in_json(S (*decode)(std::string_view),
                            std::function<std::string(const S&)> json, M message) {
  const std::string before = json(decode(message.SerializeAsString()));
  for_each_changed_field(message, "", [&](const std::string& path) {
    try {
      EXPECT_NE(json(decode(message.SerializeAsString())), before)
          << M::descriptor()->full_name() << " " << path << ": is not in the JSON line";
    } catch (const Refused&) {
    }
  });
}

TEST(EveryField, OfWhatIsPublishedIsInItsJsonLine) {
  const UtcText utc = [](SimTime t) { return std::to_string(t.ns); };
  const auto all = examples(6);
  const auto payload = [&](const State& kind) {
    return encode(example_of(all, kind.index()).state).payload;
  };

  auto report = parse<v1::FrameReport>(payload(FrameReport{}));
  report.set_detection_off(false);  // true makes null of what was not measured
  every_field_is_in_json<v1::FrameReport, FrameReport>(
      decode_report, [&](const FrameReport& r) { return to_json(r, utc); }, report);

  // A projection with coefficients can't be changed for another by itself.
  auto other = decode_report(report.SerializeAsString());
  other.wcs.projection = Projection::stereographic;
  const std::string stereographic = to_json(other, utc);
  other.wcs.projection = Projection::gnomonic;
  EXPECT_NE(to_json(other, utc), stereographic);
  other.wcs.refraction->lens = Projection::equidistant;
  const std::string equidistant = to_json(other, utc);
  other.wcs.refraction->lens = Projection::stereographic;
  EXPECT_NE(to_json(other, utc), equidistant);

  // A line names sensor and frame by itself: those of the set are not in it.
  const auto of_line = [&](auto& set, auto* lines) {
    set.set_sensor(lines->Get(0).sensor()), set.set_frame(lines->Get(0).frame());
    lines->DeleteSubrange(1, lines->size() - 1);
  };
  auto detections = parse<v1::DetectionSet>(payload(DetectionSet{}));
  of_line(detections, detections.mutable_detections());
  every_field_is_in_json<v1::DetectionSet, DetectionSet>(
      decode_detections,
      [&](const DetectionSet& s) {
        return s.sensor + std::to_string(s.frame) + to_json(s.detections.at(0), utc);
      },
      detections);
  auto truths = parse<v1::TruthSet>(payload(TruthSet{}));
  of_line(truths, truths.mutable_truths());
  every_field_is_in_json<v1::TruthSet, TruthSet>(
      decode_truths,
      [&](const TruthSet& s) {
        return s.sensor + std::to_string(s.frame) + to_json(s.truths.at(0), utc);
      },
      truths);

  auto tracks = parse<v1::TrackSet>(payload(TrackSet{}));
  tracks.mutable_tracks()->DeleteSubrange(1, tracks.tracks_size() - 1);
  every_field_is_in_json<v1::TrackSet, TrackSet>(
      decode_tracks,
      [&](const TrackSet& s) {
        return s.node + std::to_string(s.tick) + std::to_string(s.time.ns) +
               std::to_string(s.live) + std::to_string(s.unassociated) +
               to_json(s.tracks.at(0), utc);
      },
      tracks);

  auto tasks = parse<v1::TaskSet>(payload(TaskSet{}));
  tasks.mutable_tasks()->DeleteSubrange(1, tasks.tasks_size() - 1);
  every_field_is_in_json<v1::TaskSet, TaskSet>(
      decode_tasks,
      [&](const TaskSet& s) {
        return s.node + s.sensor + std::to_string(s.tick) + std::to_string(s.time.ns) +
               to_json(s.tasks.at(0), utc);
      },
      tasks);
}

/// Fails for each field that no example sets to something else than its default: the codec may
/// have left it out when it encoded.
TEST(EveryField, IsEncoded) {
  std::map<std::string, bool> set;
  std::function<void(const Message&)> look = [&](const Message& m) {
    const auto* r = m.GetReflection();
    for (int i = 0; i < m.GetDescriptor()->field_count(); ++i) {
      const FieldDescriptor* f = m.GetDescriptor()->field(i);
      const int size = f->is_repeated() ? r->FieldSize(m, f) : r->HasField(m, f);
      set[f->full_name()] |= size > 0;
      if (f->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
      for (int k = 0; k < size; ++k)
        look(f->is_repeated() ? r->GetRepeatedMessage(m, f, k) : r->GetMessage(m, f));
    }
  };
  for (unsigned seed = 0; seed < 20; ++seed)
    for (const Example& example : examples(seed)) {
      const Encoded e = encode(example.state);
      std::unique_ptr<Message> m;
      switch (e.kind) {
        case MessageKind::object_roster:
          m = std::make_unique<v1::ObjectRoster>();
          break;
        case MessageKind::object_states:
          m = std::make_unique<v1::ObjectStates>();
          break;
        case MessageKind::environment_state:
          m = std::make_unique<v1::EnvironmentState>();
          break;
        case MessageKind::site_state:
          m = std::make_unique<v1::SiteState>();
          break;
        case MessageKind::frame_report:
          m = std::make_unique<v1::FrameReport>();
          break;
        case MessageKind::detection_set:
          m = std::make_unique<v1::DetectionSet>();
          break;
        case MessageKind::truth_set:
          m = std::make_unique<v1::TruthSet>();
          break;
        case MessageKind::track_set:
          m = std::make_unique<v1::TrackSet>();
          break;
        case MessageKind::task_set:
          m = std::make_unique<v1::TaskSet>();
          break;
        default:
          FAIL() << "a kind that this test does not know";
      }
      ASSERT_TRUE(m->ParseFromString(e.payload));
      look(*m);
    }
  for (const auto& [field, was_set] : set) EXPECT_TRUE(was_set) << field << ": is never encoded";
}

}  // namespace
}  // namespace dmise
