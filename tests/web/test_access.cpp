// Who may do what: tokens, hosts, origins, cookies, passwords.
#include "nodes/web/access.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"

namespace dmise {
namespace {

const std::string viewer(16, 'v'), referee(16, 'r'), operator_(16, 'o');

AccessTokens tokens_of(const std::string& text, mode_t mode = 0600) {
  const std::string path = testing::TempDir() + "/dmise-tokens";
  std::ofstream(path) << text;
  chmod(path.c_str(), mode);
  return read_access_tokens(path);
}

TEST(AccessTokens, AreReadFromAFileOfTheirOwner) {
  const AccessTokens tokens =
      tokens_of("view " + viewer + "\n\noperator " + operator_ + "\ntruth " + referee + "\n");
  EXPECT_EQ(tokens.view, viewer);
  EXPECT_EQ(tokens.control, operator_);
  EXPECT_EQ(tokens.truth, referee);
  EXPECT_EQ(tokens_of("view " + viewer).control, "");
  EXPECT_EQ(tokens_of("# who may watch\nview " + viewer + "  # from the corridor\n").view, viewer);
  EXPECT_THROW(tokens_of("view " + viewer, 0644), ConfigError);
  for (const std::string& text : std::vector<std::string>{
           "", "view short", "view " + std::string(129, 'a'), "view " + viewer + " x", "view a b",
           "watch " + viewer, "view " + viewer + "\nview " + viewer,
           "view " + viewer + "\noperator " + viewer, "truth " + viewer + "\noperator " + viewer,
           "view " + viewer + "\ntruth " + viewer, "view " + std::string(16, '&')})
    EXPECT_THROW(tokens_of(text), ConfigError) << text;
  EXPECT_THROW(read_access_tokens("/nowhere/tokens"), ConfigError);
}

TEST(Access, IsThatOfTheToken) {
  const AccessTokens all{viewer, operator_, referee}, view_alone{viewer, "", ""},
      control_alone{"", operator_, ""};
  EXPECT_EQ(access_of(all, viewer), Access::view);
  EXPECT_EQ(access_of(all, operator_), Access::control);
  EXPECT_EQ(access_of(all, referee), Access::truth);
  EXPECT_EQ(access_of(view_alone, referee), Access::none);
  for (const std::string& wrong : {std::string(), viewer.substr(1), viewer + "v", std::string("x")})
    for (const AccessTokens& tokens : {all, view_alone, control_alone})
      EXPECT_EQ(access_of(tokens, wrong), Access::none) << wrong;
  EXPECT_EQ(access_of({}, ""), Access::control);
}

TEST(Hosts, OfLoopbackAreKnown) {
  for (const char* host : {"localhost", "localhost:80", "127.0.0.1:8080", "[::1]:8080", "[::1]"})
    EXPECT_TRUE(is_loopback_host(host)) << host;
  for (const char* host : {"", "evil.example", "127.0.0.1.evil.example:80", "localhost.evil", ":80",
                           "127.0.0.1:80:80", "LOCALHOST"})
    EXPECT_FALSE(is_loopback_host(host)) << host;
}

TEST(Origins, OfOtherPagesAreRefused) {
  EXPECT_TRUE(is_own_origin("", "127.0.0.1:80"));  // no browser
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:80", "127.0.0.1:80"));
  EXPECT_TRUE(is_own_origin("https://view.example", "view.example"));
  for (const char* origin : {"null", "http://", "http://evil.example", "http://127.0.0.1:81",
                             "http://127.0.0.1:80.evil.example", "ftp://127.0.0.1:80"})
    EXPECT_FALSE(is_own_origin(origin, "127.0.0.1:80")) << origin;
  EXPECT_FALSE(is_own_origin("http://", ""));
}

TEST(Cookies, AreFoundByTheirName) {
  EXPECT_EQ(cookie_value("a=b; dmise_token=" + viewer + "; c=d", "dmise_token"), viewer);
  EXPECT_EQ(cookie_value("dmise_token=" + viewer, "dmise_token"), viewer);
  for (const char* cookies : {"", ";;", "dmise_token", "dmise_token=", "dmise_token=short",
                              "xdmise_token=vvvvvvvvvvvvvvvv", "dmise_tokenx=vvvvvvvvvvvvvvvv"})
    EXPECT_EQ(cookie_value(cookies, "dmise_token"), "") << cookies;
}

TEST(Cookies, OfServersOnOtherPortsOfAHostHaveOtherNames) {
  EXPECT_EQ(cookie_name("view.example:8080"), "dmise_token_8080");
  EXPECT_EQ(cookie_name("127.0.0.1:8081"), "dmise_token_8081");
  EXPECT_EQ(cookie_name("[::1]:8081"), "dmise_token_8081");
  for (const char* host : {"", "view.example", "[::1]", "a:", "a:b", "a:80;x", "a:123456"})
    EXPECT_EQ(cookie_name(host), "dmise_token") << host;
}

// RFC 7617, 2: the example of the RFC has a password that is no token of ours.
TEST(Authorizations, AreTokensAsPasswords) {
  EXPECT_EQ(authorization_token("Basic YWxwYWNhOm9vb29vb29vb29vb29vb28="),
            operator_);                                                         // alpaca:o..
  EXPECT_EQ(authorization_token("Basic Om9vb29vb29vb29vb29vb28="), operator_);  // :o..
  EXPECT_EQ(authorization_token("Bearer " + viewer), viewer);
  for (const std::string& none :
       {std::string(), std::string("Basic"), std::string("Basic QWxhZGRpbjpvcGVuIHNlc2FtZQ=="),
        std::string("Basic !"), "Basic " + std::string(600, 'A'), "Digest " + viewer,
        std::string("Bearer short")})
    EXPECT_EQ(authorization_token(none), "") << none;
}

TEST(Escapes, AreDecodedOrRefused) {
  EXPECT_EQ(unescape("a%20b%2Bc"), "a b+c");
  for (const char* text : {"%", "%4", "%zz", "%00", "%1f", "%7F", "\n"})
    EXPECT_EQ(unescape(text), std::nullopt) << text;
}

}  // namespace
}  // namespace dmise
