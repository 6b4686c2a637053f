#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/products/frame_report.h"
#include "nodes/wire/state_codec.h"
#include "nodes/wire/state_rules.h"
#include "tests/wire/examples.h"

namespace dmise {
namespace {

using namespace test;

using Views = std::vector<std::string_view>;

Views views_of(const Frames& f) {
  Views v{f.topic, f.envelope, f.payload};
  if (!f.arrays.empty()) v.push_back(f.arrays);
  return v;
}

/// The reason for which one changed message is refused; none if it is accepted.
std::optional<Refusal> refusal(const Frames& frames) {
  Receiver receiver = receiver_of_examples();
  if (receiver.receive(views_of(frames))) return std::nullopt;
  for (std::size_t i = 0; i < std::size_t(Refusal::count); ++i)
    if (receiver.refused(Refusal(i)) > 0) return Refusal(i);
  ADD_FAILURE() << "refused and not counted";
  return std::nullopt;
}

Example states_example() { return examples(1)[1]; }

Envelope opened(const Frames& frames) { return open(views_of(frames)); }

/// The example with another envelope, sealed again.
Frames with_envelope(const Example& example, void (*change)(Envelope&)) {
  Frames frames = sealed(example);
  Envelope envelope = opened(frames);
  change(envelope);
  return seal(frames.topic, envelope, frames.payload, frames.arrays);
}

TEST(Wire, EveryStateComesBackBitByBit) {
  for (unsigned seed = 0; seed < 200; ++seed)
    for (const Example& example : examples(seed)) {
      Receiver receiver = receiver_of_examples();
      const Frames frames = sealed(example, seed + 1);
      const auto received = receiver.receive(views_of(frames));
      ASSERT_TRUE(received) << receiver.last_refusal();
      ASSERT_TRUE(*received->state == example.state) << example.topic;
      const Encoded again = encode(*received->state);  // bits that == does not see, such as -0
      ASSERT_TRUE(again.payload == frames.payload && again.arrays == frames.arrays);
      EXPECT_EQ(received->envelope.sequence, seed + 1);
      EXPECT_TRUE(received->envelope.last_of_tick);
    }
}

TEST(Wire, KeepsTheSignOfZeroAndDenormals) {
  const Example example = states_example();
  Receiver receiver = receiver_of_examples();
  const auto received = receiver.receive(views_of(sealed(example)));
  const auto& states = std::get<ObjectStates>(*received->state);
  EXPECT_TRUE(std::signbit(states.position_m[3]));
  EXPECT_EQ(states.slope_m_per_s[4], 5e-324);
}

// CRC-32C finds every single-byte change.
TEST(Wire, RefusesEveryMessageWithOneByteChanged) {
  for (const Example& example : examples(3)) {
    const Frames good = sealed(example);
    for (std::string Frames::*part :
         {&Frames::topic, &Frames::envelope, &Frames::payload, &Frames::arrays})
      for (std::size_t i = 0; i < (good.*part).size(); ++i) {
        Frames bad = good;
        (bad.*part)[i] = static_cast<char>((bad.*part)[i] ^ (1 << (i % 8)));
        ASSERT_TRUE(refusal(bad)) << example.topic << " byte " << i;
      }
  }
}

TEST(Wire, RefusesEveryTruncatedMessage) {
  for (const Example& example : examples(4)) {
    const Frames good = sealed(example);
    for (std::string Frames::*part :
         {&Frames::topic, &Frames::envelope, &Frames::payload, &Frames::arrays})
      for (std::size_t size = 0; size < (good.*part).size(); ++size) {
        Frames bad = good;
        (bad.*part).resize(size);
        ASSERT_TRUE(refusal(bad)) << example.topic << " cut at " << size;
      }
  }
}

// With the seal made good again, what is left is the meaning: refused, or a valid other state.
TEST(Wire, MutatedContentUnderAGoodSealIsRefusedOrMeansSomething) {
  std::mt19937_64 random(5);
  int refused = 0, accepted = 0;
  for (int trial = 0; trial < 4000; ++trial)
    for (const Example& example : examples(unsigned(trial % 7))) {
      Frames frames = sealed(example);
      const Envelope envelope = opened(frames);
      for (int changes = 0; changes < 1 + trial % 3; ++changes) {
        std::string& part =
            random() % 4 == 0 && !frames.arrays.empty() ? frames.arrays : frames.payload;
        if (part.empty()) continue;
        if (random() % 8 == 0)
          part.resize(random() % part.size());
        else
          part[random() % part.size()] = static_cast<char>(random());
      }
      Receiver receiver = receiver_of_examples();
      const Frames changed = seal(frames.topic, envelope, frames.payload, frames.arrays);
      const auto received = receiver.receive(views_of(changed));
      if (!received) {
        ++refused;
      } else {
        ++accepted;
        EXPECT_NO_THROW(check(*received->state));
      }
    }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(accepted, 1000);  // low bits of a number may change: still a number
}

TEST(Wire, RefusesTheWrongNumberOfFrames) {
  const Frames frames = sealed(states_example());
  Receiver receiver = receiver_of_examples();
  EXPECT_FALSE(receiver.receive(Views{}));
  EXPECT_FALSE(receiver.receive(Views{frames.topic, frames.envelope}));
  EXPECT_FALSE(receiver.receive(Views{frames.topic, frames.envelope, frames.payload, "", ""}));
  EXPECT_FALSE(receiver.receive(Views{frames.topic, frames.envelope, frames.payload, ""}));
  EXPECT_EQ(receiver.refused(Refusal::frames), 4u);
  EXPECT_EQ(receiver.refused(), 4u);
}

TEST(Wire, RefusesWhatIsNotOfThisRunPublisherTopicOrTick) {
  const Example e = states_example();
  EXPECT_EQ(refusal(sealed(e)), std::nullopt);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { ++v.run_id; })), Refusal::run);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { v.publisher = "b"; })), Refusal::topic);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { ++v.incarnation; })), Refusal::topic);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { v.tick = -1; })), Refusal::tick);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { v.tick = 25; })), Refusal::tick);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { ++v.time.ns; })), Refusal::tick);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { v.sequence = 0; })), Refusal::envelope);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { v.kind = MessageKind(77); })),
            Refusal::envelope);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { v.kind = MessageKind::watermark; })),
            Refusal::payload);
  EXPECT_EQ(refusal(with_envelope(e, [](Envelope& v) { v.kind = MessageKind::truth_set; })),
            Refusal::payload);
  Frames other = sealed(e);
  other = seal("state/other", opened(other), other.payload, other.arrays);
  EXPECT_EQ(refusal(other), Refusal::topic);
}

TEST(Wire, RefusesAStateOnATopicThatIsNotItsOwn) {
  Example e = examples(1)[2];
  for (const std::string& topic : {std::string(objects_topic), std::string(actor_prefix) + "gnc"}) {
    e.topic = topic;
    EXPECT_EQ(refusal(sealed(e)), Refusal::topic);
  }
}

TEST(Wire, AnActorHasStatesOnATopicOfItsOwn) {
  Example e = states_example();
  e.topic = std::string(actor_prefix) + "gnc";
  EXPECT_EQ(refusal(sealed(e)), std::nullopt);
  ++e.tick;
  EXPECT_EQ(refusal(sealed(e)), Refusal::tick);
}

TEST(Wire, RefusesAStateOfAnotherTickThanItsEnvelope) {
  Example e = states_example();
  ++e.tick;
  EXPECT_EQ(refusal(sealed(e)), Refusal::tick);
}

TEST(Wire, RefusesATickAtAnotherTimeThanItsOwn) {
  const Example e = states_example();
  Envelope end = envelope_of(e, MessageKind::watermark);
  EXPECT_EQ(refusal(seal(e.topic, end, "", "")), std::nullopt);
  ++end.time.ns;
  EXPECT_EQ(refusal(seal(e.topic, end, "", "")), Refusal::tick);
}

/// Changes the example of type `S` and tries to send it.
template <class S>
void expect_unsent(void (*change)(S&)) {
  for (Example& example : examples(2)) {
    auto* state = std::get_if<S>(&example.state);
    if (!state) continue;
    change(*state);
    try {
      encode(example.state);
      ADD_FAILURE() << "sent on " << example.topic;
    } catch (const Refused& refused) {
      EXPECT_EQ(refused.reason, Refusal::value) << refused.what();
    }
    return;
  }
}

TEST(Wire, DoesNotSendWhatItWouldRefuse) {
  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  expect_unsent<ObjectStates>([](auto& s) { s.position_m[0] = nan; });
  expect_unsent<ObjectStates>([](auto& s) { s.position_m.pop_back(); });
  expect_unsent<ObjectStates>([](auto& s) { s.velocity_m_per_s[2] = 4e8; });
  expect_unsent<ObjectRoster>([](auto& s) { s.objects[0].sphere = {1, 0}; });
  expect_unsent<ObjectRoster>([](auto& s) { s.objects[0].sphere = {-1, 0.2}; });
  expect_unsent<ObjectRoster>([](auto& s) { s.objects[0].name = "\xff\xfe"; });
  expect_unsent<EnvironmentState>([](auto& s) { s.earth.cirs_from_gcrs.m[0][0] += 1e-6; });
  expect_unsent<EnvironmentState>([](auto& s) { s.earth_beside->back().era_rad = nan; });
  expect_unsent<EnvironmentState>([](auto& s) { s.earth_beside->back().time = s.time; });
  expect_unsent<EnvironmentState>([](auto& s) { s.sun_m.x = infinity; });
  expect_unsent<EnvironmentState>([](auto& s) {
    for (double& x : s.earth.itrs_from_tirs.m[2]) x = -x;  // a mirror
  });
  expect_unsent<FrameReport>([](auto& s) { s.wcs.a.pop_back(); });
  expect_unsent<FrameReport>([](auto& s) { s.wcs.refraction->zenith = {0, 0, 2}; });
  expect_unsent<FrameReport>([](auto& s) { s.wcs.refraction->pressure_hpa = -1; });
  expect_unsent<FrameReport>([](auto& s) { s.wcs.refraction->cell_px = 0; });
  expect_unsent<FrameReport>([](auto& s) { s.frame = 0; });
  expect_unsent<FrameReport>([](auto& s) { s.end.ns = -8; });
  expect_unsent<DetectionSet>([](auto& s) { s.detections[1].dec_rad = 1.6; });
  expect_unsent<DetectionSet>([](auto& s) { s.detections[1].covariance_px2[1] = 3; });
  expect_unsent<DetectionSet>([](auto& s) { s.detections[1].sensor = "b"; });
  expect_unsent<TruthSet>([](auto& s) { s.truths[0].sunlit = 1.0001; });
}

// The layout that docs/wire.md states: anybody can read the arrays without this code.
TEST(Wire, ArraysLieInTheStatedOrder) {
  const Example example = states_example();
  const auto& states = std::get<ObjectStates>(example.state);
  const Frames frames = sealed(example);
  const std::size_t m = states.attitude_object.size(), attitudes = states.count * 73;
  ASSERT_EQ(frames.arrays.size(), attitudes + m * 60);
  double y_of_second = 0;
  std::memcpy(&y_of_second, frames.arrays.data() + 8 * (states.count + 1), 8);
  EXPECT_EQ(y_of_second, states.position(1).y);
  EXPECT_EQ(static_cast<unsigned char>(frames.arrays[attitudes - 1]), 255);
  std::uint32_t second_with_attitude = 0;
  std::memcpy(&second_with_attitude, frames.arrays.data() + attitudes + 4, 4);
  EXPECT_EQ(second_with_attitude, states.attitude_object[1]);
  double x_of_first = 0;  // after the w of all
  std::memcpy(&x_of_first, frames.arrays.data() + attitudes + 4 * m + 8 * m, 8);
  EXPECT_EQ(x_of_first, states.gcrs_from_body[m]);
}

// Nine rows of one number for each object that SGP4 moves.
TEST(Wire, ElementSetsOfARosterLieInTheStatedOrder) {
  const auto all = examples(1);
  const Example& example = all[0];
  const auto& elements = std::get<ObjectRoster>(example.state).elements;
  const Frames frames = sealed(example);
  ASSERT_EQ(frames.arrays.size(), 9 * 8 * elements.size());
  const auto number = [&](std::size_t row, std::size_t object) {
    double value = 0;
    std::memcpy(&value, frames.arrays.data() + 8 * (row * elements.size() + object), 8);
    return value;
  };
  EXPECT_EQ(number(0, 1), elements[1].epoch_jd1);
  EXPECT_EQ(number(3, 2), elements[2].eccentricity);
  EXPECT_EQ(number(8, 0), elements[0].bstar_per_earth_radius);
  expect_unsent<ObjectRoster>([](auto& r) { r.elements.resize(6); });  // there are 5 objects
  expect_unsent<ObjectRoster>([](auto& r) { r.elements[1].eccentricity = NAN; });
}

TEST(Wire, AttitudesMustBeRotationsOfObjectsThatAreThere) {
  expect_unsent<ObjectStates>([](auto& s) { s.attitude_object[1] = 7; });   // there are 7 objects
  expect_unsent<ObjectStates>([](auto& s) { s.attitude_object[1] = 0; });   // not ascending
  expect_unsent<ObjectStates>([](auto& s) { s.gcrs_from_body[0] = 0.6; });  // not of length 1
  expect_unsent<ObjectStates>(
      [](auto& s) { s.gcrs_from_body[1] = 1.0; });  // an object without a state
  expect_unsent<ObjectStates>([](auto& s) { s.gcrs_from_body.pop_back(); });
  expect_unsent<ObjectStates>([](auto& s) {  // two of one object, each a rotation
    s.attitude_object[1] = 0;
    s.gcrs_from_body = {0.5, 0.5, -0.5, -0.5, 0.5, 0.5, 0.5, 0.5};
  });
  expect_unsent<ObjectStates>([](auto& s) { s.attitude_rate_rad_per_s[0] = 1e300; });
}

TEST(Wire, StatesWithoutAttitudesTravelAsBefore) {
  Example example = states_example();
  auto states = std::get<ObjectStates>(example.state);
  states.attitude_object.clear();
  states.gcrs_from_body.clear();
  states.attitude_rate_rad_per_s.clear();
  example.state = states;
  const Frames frames = sealed(example);
  EXPECT_EQ(frames.arrays.size(), states.count * 73);
  Receiver receiver = receiver_of_examples();
  const auto received = receiver.receive(views_of(frames));
  ASSERT_TRUE(received) << receiver.last_refusal();
  EXPECT_TRUE(*received->state == example.state);
}

// A tag of Protocol Buffers is field << 3 | wire type; 5 is fixed32.
TEST(Wire, TheSealEndsTheEnvelopeAsAFieldOfItsOwn) {
  const Frames frames = seal("state/objects", {.run_id = 1, .publisher = "orbit"});
  const std::string& e = frames.envelope;
  EXPECT_EQ(static_cast<unsigned char>(e[e.size() - 5]), 15 << 3 | 5);  // field 15, fixed32
  EXPECT_EQ(open(Views{frames.topic, frames.envelope, frames.payload}).publisher, "orbit");
}

}  // namespace
}  // namespace dmise
