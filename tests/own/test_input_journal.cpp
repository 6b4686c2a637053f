#include "nodes/own/input_journal.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/error.h"

namespace dmise {
namespace {

class InputJournalTest : public testing::Test {
 public:
  ~InputJournalTest() override { std::filesystem::remove_all(directory_); }

 protected:
  /// Adds ticks in which as many frames of a sensor are heard as their number.
  static void add(InputJournal& journal, Tick from, Tick to) {
    for (Tick tick = from; tick < to; ++tick) {
      for (std::uint32_t frame = 1; frame <= std::uint32_t(tick); ++frame)
        journal.add({{{"detection/eye", tick - 1,
                       std::make_shared<State>(DetectionSet{"eye", frame, {}})}}});
      journal.end(tick);
    }
  }

  const std::string directory_ =
      (std::filesystem::path(testing::TempDir()) / "dmise-inputs").string();
  const std::string path_ = input_journal_path(directory_, "gnc");
};

TEST_F(InputJournalTest, IsReadWhileItIsWritten) {
  InputJournal journal(path_);
  journal.clear();
  InputReader early(path_), reader(path_);
  std::vector<Message> messages;
  EXPECT_FALSE(early.next(&messages));
  for (Tick tick = 0; tick < 3; ++tick) {
    add(journal, tick, tick + 1);
    messages.clear();
    ASSERT_TRUE(reader.next(&messages));
    ASSERT_EQ(Tick(messages.size()), tick);
    for (const Message& message : messages) {
      EXPECT_EQ(message.topic, "detection/eye");
      EXPECT_EQ(message.tick, tick - 1);
    }
  }
}

TEST_F(InputJournalTest, GoesOnAfterItsLastWholeTick) {
  {
    InputJournal journal(path_);
    EXPECT_EQ(journal.resume(), 0);
    add(journal, 0, 5);
  }
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 1);
  InputJournal journal(path_);
  EXPECT_EQ(journal.resume(), 4);
  add(journal, 4, 6);
  EXPECT_EQ(InputJournal::ticks_written(path_), 6);
  std::size_t heard = 0;
  journal.replay(4, 6, [&](Tick, std::span<const Message> inputs) { heard += inputs.size(); });
  EXPECT_EQ(heard, 9u);
  EXPECT_THROW(journal.replay(4, 7, [](Tick, std::span<const Message>) {}), Error);
}

}  // namespace
}  // namespace dmise
