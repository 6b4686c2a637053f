// Which files of a dashboard are served, and as what.
#include "nodes/gateway/static_files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace dmise {
namespace {

namespace fs = std::filesystem;

struct Directory {
  explicit Directory(const std::string& name) : path(testing::TempDir() + name) {
    fs::remove_all(path);
    fs::create_directories(path);
  }
  ~Directory() { fs::remove_all(path); }
  void add(const std::string& name, const std::string& content = "") const {
    fs::create_directories(fs::path(path + "/" + name).parent_path());
    std::ofstream(path + "/" + name) << content;
  }
  std::string path;
};

TEST(StaticFiles, AreThoseBelowTheDirectoryAlone) {
  const Directory directory("dmise-static");
  directory.add("index.html", "<html>");
  directory.add("assets/deep/a.js", "1;");
  directory.add("assets/empty.css");
  const StaticFiles files(directory.path);
  ASSERT_TRUE(files.find("index.html"));
  EXPECT_EQ(files.find("index.html")->content, "<html>");
  EXPECT_EQ(files.find("assets/deep/a.js")->content, "1;");
  EXPECT_EQ(files.find("assets/empty.css")->content, "");
  for (const char* path : {"", "assets", "/index.html", "../dmise-static/index.html",
                           "assets/../index.html", "index.htm"})
    EXPECT_FALSE(files.find(path)) << path;
  // Read once: what is written later is not served.
  directory.add("later.js", "2;");
  EXPECT_FALSE(files.find("later.js"));
}

// Reference: IANA, Media Types; RFC 9239 for JavaScript.
TEST(StaticFiles, TellTheirMediaType) {
  EXPECT_STREQ(media_type("assets/a.js"), "text/javascript; charset=utf-8");
  EXPECT_STREQ(media_type("index.html"), "text/html; charset=utf-8");
  EXPECT_STREQ(media_type("a.wasm"), "application/wasm");
  EXPECT_STREQ(media_type("a.html.unknown"), "application/octet-stream");
  EXPECT_STREQ(media_type(""), "application/octet-stream");
}

// Reference: sha256sum of nothing, and of "a".
TEST(StaticFiles, TagsAreDigestsOfTheContent) {
  const Directory directory("dmise-static-tags");
  directory.add("nothing.txt");
  directory.add("a.txt", "a");
  const StaticFiles files(directory.path);
  EXPECT_EQ(files.find("nothing.txt")->etag, "\"e3b0c44298fc1c149afbf4c8996fb924\"");
  EXPECT_EQ(files.find("a.txt")->etag, "\"ca978112ca1bbdcafac231b39a23dc4d\"");
}

TEST(StaticFiles, OfNoDirectoryThereAreNone) {
  EXPECT_TRUE(StaticFiles("").empty());
  EXPECT_TRUE(StaticFiles("/nowhere").empty());
}

}  // namespace
}  // namespace dmise
