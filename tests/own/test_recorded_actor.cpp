#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "nodes/own/recorded_actor.h"
#include "tests/own/sample_recording.h"

namespace dmise {
namespace {

using testing::EndsWith;

class RecordedActorTest : public testing::Test {
 public:
  ~RecordedActorTest() override { std::filesystem::remove(path_); }

 protected:
  /// The actor of a file with these records.
  RecordedActor actor(const std::string& records) const {
    std::ofstream(path_, std::ios::binary) << test::mcap_magic << records;
    return {test::sample_scenario(), "gnc", test::sample_digest, path_};
  }
  std::string refusal_of(const std::string& records) const {
    try {
      actor(records);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "none";
  }

  const std::string path_ =
      (std::filesystem::path(testing::TempDir()) / "dmise-recording").string();
};

TEST_F(RecordedActorTest, SaysTheStatesOfAPlainOrPackedRecording) {
  const std::string records = test::sample_records();
  for (const std::string& form :
       {records, test::chunk_record(records, false), test::chunk_record(records, true)}) {
    RecordedActor actor = this->actor(form);
    for (Tick tick = 0; tick <= test::sample_last_tick; ++tick) {
      const auto& states = std::get<ObjectStates>(*actor.step(tick, {}).at(0).state);
      EXPECT_EQ(states.position(0), (Vec<Gcrs>{7e6, 0, double(tick)}));
    }
  }
}

TEST_F(RecordedActorTest, RefusesChunksInChunks) {
  std::string nested = test::chunk_record("", false);
  for (int depth = 0; depth < 1000; ++depth) nested = test::chunk_record(nested, false);
  EXPECT_THAT(refusal_of(nested), EndsWith(": damaged: a chunk in a chunk"));
}

TEST_F(RecordedActorTest, TakesNoMemoryForASizeThatZstdContradicts) {
  std::string chunk = test::chunk_record(test::sample_records(), true);
  const std::uint64_t size = std::uint64_t(1) << 30;
  chunk.replace(9 + 16, sizeof size, test::bytes_of(size));  // after the head and the times
  EXPECT_THAT(refusal_of(chunk), EndsWith(": damaged: a chunk of another size than it says"));
}

TEST_F(RecordedActorTest, RefusesStatesOfAnotherTime) {
  ObjectStates states = test::states_at(1);
  states.time.ns += 1;
  const std::string records =
      test::sample_records(0) + test::message_record(2, test::recorded(states));
  EXPECT_THAT(refusal_of(records), EndsWith(": tick 1 of node gnc is not at its time"));
}

}  // namespace
}  // namespace dmise
