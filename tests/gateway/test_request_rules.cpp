// Which pages are asked for: targets, encodings.
#include "nodes/gateway/request_rules.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

const std::string viewer(16, 'v');

TEST(Targets, AreRead) {
  EXPECT_EQ(parse_target("/"), (RequestTarget{FileRequest{"index.html"}, ""}));
  EXPECT_EQ(parse_target("/?a=b&token=" + viewer),
            (RequestTarget{FileRequest{"index.html"}, viewer}));
  EXPECT_EQ(parse_target("/assets/a-1.js"), (RequestTarget{FileRequest{"assets/a-1.js"}, ""}));
  EXPECT_EQ(parse_target("/live?token=" + viewer), (RequestTarget{LiveRequest{}, viewer}));
  EXPECT_EQ(parse_target("/frames/alpha/12.png"), (RequestTarget{FrameRequest{"alpha", 12}, ""}));
  EXPECT_EQ(parse_target("/frames/a%20b%C3%A9/1.png"),
            (RequestTarget{FrameRequest{"a b\xc3\xa9", 1}, ""}));
}

TEST(Targets, OfOtherFilesAreRefused) {
  for (const char* target : {"",
                             "x",
                             "//",
                             "/a//b",
                             "/../etc/passwd",
                             "/a/../b",
                             "/a/..",
                             "/.git/config",
                             "/a/.b",
                             "/a/",
                             "/a%2e",
                             "/a\\b",
                             "/a b",
                             "/\x01",
                             "/frames/",
                             "/frames/a",
                             "/frames/a/1",
                             "/frames/a/.png",
                             "/frames/a/-1.png",
                             "/frames/a/+1.png",
                             "/frames/a/1x.png",
                             "/frames/a/99999999999.png",
                             "/frames//1.png",
                             "/frames/../1.png",
                             "/frames/..%2f..%2fx/1.png",
                             "/frames/.a/1.png",
                             "/frames/a%2/1.png",
                             "/frames/a%zz/1.png",
                             "/frames/a%00/1.png",
                             "/frames/a/b/1.png"})
    EXPECT_FALSE(parse_target(target)) << target;
  EXPECT_FALSE(parse_target("/" + std::string(2000, 'a')));
  EXPECT_FALSE(parse_target("/frames/" + std::string(200, 'a') + "/1.png"));
}

TEST(Targets, KeepAllButTheirToken) {
  EXPECT_EQ(without_token("/?token=" + viewer), "/");
  EXPECT_EQ(without_token("/frames/a%20b/2.png?token=" + viewer), "/frames/a%20b/2.png");
  EXPECT_EQ(without_token("/?a=b&token=" + viewer + "&c=d"), "/?a=b&c=d");
}

// RFC 9110, 12.5.3.
TEST(Encodings, AdmitGzip) {
  for (const char* encodings :
       {"gzip", "gzip, deflate, br, zstd", "br;q=1.0, gzip;q=0.8", "deflate ,gzip ; q=0.001"})
    EXPECT_TRUE(takes_gzip(encodings)) << encodings;
  for (const char* encodings :
       {"", "identity", "br, deflate", "gzip;q=0", "gzip; q=0.000", "xgzip"})
    EXPECT_FALSE(takes_gzip(encodings)) << encodings;
}

}  // namespace
}  // namespace dmise
