#include "core/config/fusion_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

FusionConfig read(const std::string& text) {
  YamlMap map(YamlValue::parse("fusion: " + text, "scenario.yaml"));
  return read_fusion(map.require("fusion"));
}

std::string complaint(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(FusionConfig, ReadsItsKeys) {
  const FusionConfig c = read(
      "{catalogue_sigma_m: [1, 2, 3], gate_d2: 25, detection_probability: 0.5, tentative_s: 30,\n"
      " not_in_catalogue: [MYSTERY, 12345]}");
  EXPECT_EQ(c.settings.catalogue_sigma_m, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(c.settings.gate_d2, 25);
  EXPECT_EQ(c.settings.detection_probability, 0.5);
  EXPECT_EQ(c.settings.tentative_s, 30);
  EXPECT_EQ(c.settings.lost_after_s, FusionSettings().lost_after_s);
  EXPECT_EQ(c.not_in_catalogue, (std::vector<std::string>{"MYSTERY", "12345"}));
  EXPECT_EQ(read("on").settings.gate_d2, FusionSettings().gate_d2);
}

TEST(FusionConfig, NamesTheKeyOfWhatIsWrong) {
  EXPECT_NE(complaint("{gate_d2: 0}").find("scenario.yaml:1:19: fusion.gate_d2: "),
            std::string::npos)
      << complaint("{gate_d2: 0}");
  EXPECT_NE(complaint("{catalogue_sigma_m: [1, 2]}").find("catalogue_sigma_m"), std::string::npos);
  EXPECT_NE(complaint("{catalogue_sigma_m: [0, 2, 3]}").find("catalogue_sigma_m"),
            std::string::npos);
  EXPECT_NE(complaint("{detection_probability: 1}").find("detection_probability"),
            std::string::npos);
  EXPECT_NE(complaint("{gate_d: 20}").find("did you mean gate_d2"), std::string::npos)
      << complaint("{gate_d: 20}");
}

}  // namespace
}  // namespace dmise
