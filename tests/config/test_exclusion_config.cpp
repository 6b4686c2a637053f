#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/config/scenario.h"
#include "core/config/sensors/exclusion_config.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

Exclusion read(const std::string& text) {
  return read_exclusion(YamlValue::parse(text, "camera.yaml"));
}
std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(ExclusionConfig, ReadsAnglesAndAction) {
  const Exclusion one = read("{moon_deg: 10}");
  EXPECT_EQ(one, (Exclusion{.sun_deg = {}, .moon_deg = 10.0, .earth_limb_deg = {}}));
  EXPECT_EQ(one.action, ExclusionAction::flag);
  const Exclusion all =
      read("{sun_deg: 180, moon_deg: 0, earth_limb_deg: 20.5, action: close_shutter}");
  EXPECT_EQ(all, (Exclusion{180.0, 0.0, 20.5, ExclusionAction::close_shutter}));
  EXPECT_FALSE(Exclusion().any());
}

TEST(ExclusionConfig, RefusesBadValuesInOneLine) {
  EXPECT_EQ(refusal("{action: flag}"),
            "camera.yaml:1:1: needs one of sun_deg, moon_deg or earth_limb_deg");
  EXPECT_EQ(refusal("{sun_deg: 181}"), "camera.yaml:1:11: sun_deg: must be <= 180, got 181");
  EXPECT_EQ(refusal("{sun_deg: -1}"), "camera.yaml:1:11: sun_deg: must be >= 0, got -1");
  EXPECT_NE(refusal("{sun_deg: .nan}").find("camera.yaml:1:11: sun_deg"), std::string::npos);
  EXPECT_NE(refusal("{sun_deg: near}").find("camera.yaml:1:11: sun_deg"), std::string::npos);
  EXPECT_NE(refusal("{sun_deg: 40, action: close}").find("close_shutter"), std::string::npos);
  EXPECT_NE(refusal("{sun_dec: 40}").find("unknown key, did you mean sun_deg?"), std::string::npos);
}

class WithExclusion : public testing::Test {
 protected:
  std::filesystem::path directory = std::filesystem::path(testing::TempDir()) / "exclusion";
  void SetUp() override {
    setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
    std::filesystem::create_directories(directory);
  }
  void TearDown() override { std::filesystem::remove_all(directory); }

  static std::string camera(const std::string& more) {
    return "{optics: {columns: 8, rows: 8, pixel_pitch_m: 1.0e-5, focal_length_m: 0.1, "
           "aperture_m: 0.02}, detector: {full_well_e: 1.0e+5, gain_e_per_dn: 1}, band: bessell-V" +
           more + "}";
  }
  Scenario load(const std::string& place, const std::string& camera) {
    const std::string path = (directory / "s.yaml").string();
    std::ofstream(path)
        << "simulation: {start: 2018-01-21T00:30:00Z, duration_s: 60, tick_s: 5}\nsensors:\n  - "
           "{name: a, exposure_s: 1, cadence_s: 5, " +
               place + ", pointing: {ra_deg: 10, dec_deg: 20}, camera: " + camera + "}\n";
    return load_scenario(path);
  }
  std::string complaint(const std::string& place, const std::string& camera) {
    try {
      load(place, camera);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(WithExclusion, IsInTheDigestAndWithoutItNothingChanges) {
  const std::string site = "site: atlanta";
  const std::string plain = physics_json(load(site, camera("")));
  EXPECT_EQ(plain.find("exclusion"), std::string::npos);
  const std::string with = physics_json(load(site, camera(", exclusion: {sun_deg: 40}")));
  const std::string section = "\"exclusion\":{\"sun_deg\":40,\"action\":\"flag\"}";
  const auto at = with.find("," + section);
  ASSERT_NE(at, std::string::npos) << with;
  EXPECT_EQ(std::string(with).erase(at, section.size() + 1), plain);
}

// A camera of its own file is complained of where the sensor names it.
TEST_F(WithExclusion, OfALimbIsRefusedOnTheGround) {
  const std::string limb = ", exclusion: {sun_deg: 40, earth_limb_deg: 20}";
  const std::string of_site = complaint("site: atlanta", camera(limb));
  EXPECT_NE(of_site.find("sensors[0].camera.exclusion.earth_limb_deg: is for a sensor in orbit"),
            std::string::npos)
      << of_site;
  std::ofstream(directory / "orbital.yaml") << camera(limb) << "\n";
  const std::string of_file = complaint("site: atlanta", "orbital.yaml");
  EXPECT_NE(
      of_file.find("sensors[0].camera: its exclusion.earth_limb_deg is for a sensor in orbit"),
      std::string::npos)
      << of_file;
  EXPECT_EQ(complaint("platform: '44720'", "orbital.yaml"), "");
}

}  // namespace
}  // namespace dmise
