#include "core/config/objects/flight_config.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/config/objects/object_config.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

const std::string low = "numerical: {semi_major_axis_m: 7e6, eccentricity: 0, inclination_deg: 98}";
const std::string conic =
    "two_body: {semi_major_axis_m: 7e6, eccentricity: 0, inclination_deg: 98}";

ObjectsConfig read_flying(const std::string& motion) {
  const std::string text = "objects:\n- {name: x, motion: {" + motion + "}}";
  return read_objects(YamlMap(YamlValue::parse(text, "s.yaml")).require("objects"),
                      {2458139.5, 0.0});
}

FlightConfig flight_of(const std::string& motion) {
  return *read_flying(motion).own.at(0).motion.flight;
}

/// What is wrong, without its place.
std::string fault(const std::string& motion) {
  try {
    read_flying(motion);
  } catch (const ConfigError& e) {
    const std::string text = e.what();
    return text.substr(text.find("motion"));
  }
  return "";
}

TEST(FlightConfig, ForcesHaveDefaults) {
  const FlightConfig plain = flight_of(low);
  EXPECT_TRUE(plain.numerical);
  EXPECT_EQ(plain.forces, FlightForceSettings{});
  const FlightConfig felt = flight_of(low + ", forces: {area_to_mass_m2_per_kg: 0.02}");
  EXPECT_DOUBLE_EQ(felt.forces.drag_m2_per_kg, 0.044);
  EXPECT_DOUBLE_EQ(felt.forces.radiation_m2_per_kg, 0.026);
}

TEST(FlightConfig, ForcesAreAsStated) {
  const FlightForceSettings forces =
      flight_of(low +
                ", forces: {gravity_degree: 36, sun_moon: off, area_to_mass_m2_per_kg: 0.1, "
                "drag: off, radiation_coefficient: 1.8}")
          .forces;
  EXPECT_EQ(forces.gravity_degree, 36);
  EXPECT_FALSE(forces.sun_moon);
  EXPECT_EQ(forces.drag_m2_per_kg, 0);
  EXPECT_DOUBLE_EQ(forces.radiation_m2_per_kg, 0.18);
}

TEST(FlightConfig, ManoeuvresCountFromTheStartOfTheRun) {
  const auto manoeuvres =
      flight_of(conic +
                ", manoeuvres: [{at: 2018-01-21T00:01:40Z, delta_v_rtn_m_per_s: [1, 2, 3]}, "
                "{at_s: 200, thrust_n: 10, mass_kg: 50, duration_s: 20, direction_rtn: [0, 3, 4], "
                "specific_impulse_s: 300}]")
          .manoeuvres;
  ASSERT_EQ(manoeuvres.size(), 2u);
  EXPECT_DOUBLE_EQ(manoeuvres[0].at_s, 100);
  EXPECT_EQ(manoeuvres[0].delta_v_m_per_s, (Vec<Rtn>{1, 2, 3}));
  EXPECT_EQ(manoeuvres[0].duration_s, 0);
  EXPECT_DOUBLE_EQ(manoeuvres[1].end_s(), 220);
  EXPECT_DOUBLE_EQ(manoeuvres[1].direction.z, 0.8);
}

TEST(FlightConfig, SaysWhatIsWrong) {
  const std::string burn = "thrust_n: 10, mass_kg: 1, duration_s: 60, direction_rtn: [1, 0, 0]";
  const auto with = [](const std::string& manoeuvres) {
    return low + ", manoeuvres: [" + manoeuvres + "]";
  };
  EXPECT_EQ(
      fault(low + ", " + conic),
      "motion: give one of two_body, numerical, oem, sp3, fixed, track, enu, sgp4, proximity, "
      "node");
  EXPECT_EQ(fault(conic + ", forces: {}"), "motion.forces: goes with numerical or manoeuvres");
  EXPECT_EQ(
      fault(
          "fixed: {gcrs_m: [8e6, 0, 0]}, manoeuvres: [{at_s: 1, delta_v_rtn_m_per_s: [1, 0, 0]}]"),
      "motion.manoeuvres: go with numerical, two_body, sgp4, oem or sp3");
  EXPECT_EQ(fault(low + ", forces: {gravity_degree: 71}"),
            "motion.forces.gravity_degree: must be <= 70, got 71");
  EXPECT_EQ(fault(low + ", forces: {gravity_degree: 1}"),
            "motion.forces.gravity_degree: must be 0 or 2 to 70, got 1");
  EXPECT_EQ(fault(low + ", forces: {drag: on}"),
            "motion.forces.drag: goes with area_to_mass_m2_per_kg");
  EXPECT_EQ(fault(with("")), "motion.manoeuvres: must name a manoeuvre");
  EXPECT_EQ(fault(with("{delta_v_rtn_m_per_s: [1, 0, 0]}")),
            "motion.manoeuvres[0]: give either at or at_s");
  EXPECT_EQ(fault(with("{at_s: 5}")),
            "motion.manoeuvres[0]: give either delta_v_rtn_m_per_s or thrust_n");
  EXPECT_EQ(fault(with("{at_s: 5, delta_v_rtn_m_per_s: [1, 0, 0], mass_kg: 3}")),
            "motion.manoeuvres[0].mass_kg: goes with thrust_n");
  EXPECT_EQ(fault(with("{at_s: 5, thrust_n: 3, mass_kg: 3, duration_s: 1}")),
            "motion.manoeuvres[0].direction_rtn: is missing");
  EXPECT_EQ(
      fault(with("{at_s: 5, thrust_n: 3, mass_kg: 3, duration_s: 1, direction_rtn: [0, 0, 0]}")),
      "motion.manoeuvres[0].direction_rtn: must not be zero");
  EXPECT_EQ(fault(with("{at_s: 5, " + burn + ", specific_impulse_s: 60}")),
            "motion.manoeuvres[0].duration_s: the burn takes more mass than there is, got 60");
  EXPECT_EQ(fault(with("{at_s: 5, " + burn + "}, {at_s: 60, delta_v_rtn_m_per_s: [1, 0, 0]}")),
            "motion.manoeuvres[1]: begins before the end of the one before it");
  EXPECT_EQ(
      fault(with("{at: 2017-01-21T00:00:00Z, delta_v_rtn_m_per_s: [1, 0, 0]}")),
      "motion.manoeuvres[0].at: is more than 100 days before the run, got 2017-01-21T00:00:00Z");
}

}  // namespace
}  // namespace dmise
