// Files in a directory of keys that are no keys: said at once, with file and reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <future>

#include "core/base/error.h"
#include "nodes/runtime/security/keys.h"
#include "nodes/runtime/security/security.h"
#include "tests/runtime/key_directory.h"

namespace dmise {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// What a process says when it begins with these keys; "" when it is content.
std::string fault_of(const std::string& directory, const std::string& name = "time-master") {
  auto fault = std::async(std::launch::async, [=] {
    try {
      const Security security(directory, name);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  });
  if (fault.wait_for(std::chrono::seconds(20)) == std::future_status::ready) return fault.get();
  // It waits for a writer: one comes, so that the test can end.
  for (const auto& file : std::filesystem::directory_iterator(directory))
    if (file.is_fifo()) std::ofstream(file.path()) << "public x\n";
  return "said nothing: " + fault.get();
}

void write(const std::string& path, const std::string& text) {
  std::filesystem::remove(path);
  std::ofstream(path) << text;
  chmod(path.c_str(), 0600);
}

class KeyFiles : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return keys.directory + "/" + name; }
  test::Keys keys{{"time-master", "a"}};
};

TEST_F(KeyFiles, AreAcceptedAsMade) { EXPECT_EQ(fault_of(keys.directory), ""); }

TEST_F(KeyFiles, TruncatedAnywhereAreSaid) {
  for (const char* name : {"a.pub", "time-master.pub", "time-master.key"}) {
    std::ifstream file(path(name));
    const std::string whole{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
      write(path(name), whole.substr(0, length));
      EXPECT_THAT(fault_of(keys.directory), StartsWith(path(name) + ": not a key of dmise keygen"))
          << length;
    }
    write(path(name), whole);
  }
  EXPECT_EQ(fault_of(keys.directory), "");
}

TEST_F(KeyFiles, ThatAreNoFilesAreSaidAtOnce) {
  for (const char* name : {"a.pub", "all.pubs", "time-master.key"}) {
    const std::string kept = path("kept");
    const bool was_there = std::filesystem::exists(path(name));
    if (was_there) std::filesystem::rename(path(name), kept);
    ASSERT_EQ(mkfifo(path(name).c_str(), 0600), 0);
    EXPECT_EQ(fault_of(keys.directory), path(name) + ": is a FIFO, not a regular file");
    std::filesystem::remove(path(name));
    if (was_there) std::filesystem::rename(kept, path(name));
  }
  std::filesystem::create_directory(path("b.pub"));
  EXPECT_EQ(fault_of(keys.directory), path("b.pub") + ": is a directory");
  std::filesystem::remove(path("b.pub"));
  std::filesystem::create_symlink("nowhere", path("b.pub"));
  EXPECT_EQ(fault_of(keys.directory), path("b.pub") + ": No such file or directory");
}

TEST_F(KeyFiles, WithoutEndAreSaid) {
  std::filesystem::create_symlink("/dev/zero", path("b.pub"));
  EXPECT_EQ(fault_of(keys.directory), path("b.pub") + ": is a device, not a regular file");
  std::filesystem::remove(path("b.pub"));
  std::ofstream(path("b.pub")).close();
  std::filesystem::resize_file(path("b.pub"), std::uintmax_t(1) << 40);  // sparse
  EXPECT_EQ(fault_of(keys.directory), path("b.pub") + ": larger than 16777216 bytes");
}

// A run that has begun goes on: whoever has no good file is refused.
TEST_F(KeyFiles, ThatAreNoneAreLeftOutByWhoHasBegun) {
  ASSERT_EQ(mkfifo(path("b.pub").c_str(), 0600), 0);
  write(path("c.pub"), "public 0123");
  std::vector<std::string> left_out;
  EXPECT_EQ(read_allowed(keys.directory, &left_out).size(), 2u);
  EXPECT_EQ(left_out.size(), 2u);
}

}  // namespace
}  // namespace dmise
