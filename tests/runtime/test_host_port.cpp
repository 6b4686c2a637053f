#include "nodes/runtime/process/host_port.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

TEST(HostPort, IsReadAndWrittenWithBracketsAboutIpv6) {
  for (const auto& [text, host, port] : {std::tuple("127.0.0.1:0", "127.0.0.1", 0),
                                         {"localhost:9100", "localhost", 9100},
                                         {"[::1]:65535", "::1", 65535},
                                         {"[fe80::1%eth0]:80", "fe80::1%eth0", 80}}) {
    const auto address = host_and_port(text);
    ASSERT_TRUE(address) << text;
    EXPECT_EQ(address->host, host);
    EXPECT_EQ(address->port, port);
    EXPECT_EQ(text_of(*address), text);
  }
}

TEST(HostPort, OtherTextsAreNone) {
  for (const char* text : {"", ":", ":80", "host", "host:", "host:x", "host:65536", "host:-1",
                           "host:80 ", "::1:80", "[]:80", "[::1:80", "a/b:80", "a b:80"})
    EXPECT_FALSE(host_and_port(text)) << text;
}

}  // namespace
}  // namespace dmise
