#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/config/sensors/instrument_config.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

std::vector<Malfunction> read(const std::string& text) {
  return read_malfunctions(*YamlMap(YamlValue::parse("m: " + text, "s.yaml")).find("m"));
}
std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(MalfunctionConfig, SaysWhatActsWhen) {
  const auto malfunctions = read(
      "[{kind: lost_link, at_s: 10, for_s: 5}, {kind: slow_download, at_s: 12, for_s: 1, "
      "download_s: 8}, {kind: wrong_gain, at_s: 0, for_s: 1, gain_e_per_dn: 2.5}]");
  ASSERT_EQ(malfunctions.size(), 3u);
  EXPECT_EQ(malfunctions[1].download_s, 8.0);
  EXPECT_EQ(malfunctions[2].gain_e_per_dn, 2.5);
  const auto lost = [&](double t_s) {
    return acting(malfunctions, MalfunctionKind::lost_link, t_s);
  };
  EXPECT_EQ(lost(9.9), nullptr);
  EXPECT_EQ(lost(10.0), &malfunctions[0]);
  EXPECT_EQ(lost(15.0), nullptr);
  EXPECT_EQ(acting(malfunctions, MalfunctionKind::stuck_shutter, 12.0), nullptr);
}

TEST(MalfunctionConfig, RefusesBadValuesInOneLine) {
  EXPECT_EQ(refusal("[{kind: slow_download, at_s: 0, for_s: 1}]").find("s.yaml:1:5: "), 0u);
  EXPECT_NE(refusal("[{kind: slow_download, at_s: 0, for_s: 1}]").find("download_s"),
            std::string::npos);
  EXPECT_NE(refusal("[{kind: lost_link, at_s: 0, for_s: 1, download_s: 2}]")
                .find("download_s: is of another kind of malfunction"),
            std::string::npos);
  EXPECT_NE(refusal("[{kind: lost_link, at_s: -1, for_s: 1}]").find("at_s: must be >= 0"),
            std::string::npos);
  EXPECT_NE(refusal("[{kind: lost_link, at_s: 1, for_s: 0}]").find("for_s: must be > 0"),
            std::string::npos);
  EXPECT_NE(refusal("[{kind: lost_lnk, at_s: 1, for_s: 1}]").find("lost_link"), std::string::npos);
}

}  // namespace
}  // namespace dmise
