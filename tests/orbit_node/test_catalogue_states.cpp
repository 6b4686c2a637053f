#include <algorithm>
#include <cmath>

#include "core/propagation/object_states.h"
#include "sensors/objects/objects_in_field.h"
#include "sensors/scene/view.h"
#include "tests/orbit_node/scenario_directory.h"
#include "tests/pipeline/harness.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

class CatalogueStates : public test::ScenarioDirectory {};

// SGP4's velocity is not the derivative of its position: median 2.6 cm/s over a catalogue, metres a
// second for a few. What is published as slope must be the derivative.
TEST_F(CatalogueStates, PublishedSlopesOfRealObjectsAreDerivativesAndNotTheModelsVelocity) {
  const Scenario scenario = load("  - {catalogue: demo}\n");
  const Clock clock = make_clock(scenario);
  Threads threads(1);
  const auto population = load_objects(scenario, clock);
  const StateSource source(population, clock, threads);
  const ObjectStates at = source.at(0, {30'000'000'000}), before = source.at(0, {29'500'000'000}),
                     after = source.at(0, {30'500'000'000});
  std::vector<double> slope_error, velocity_error;
  for (std::size_t i = 0; i < at.count; ++i) {
    if (at.code[i] || before.code[i] || after.code[i]) continue;
    const Vec<Gcrs> derivative = after.position(i) - before.position(i);  // over one second
    const Vec<Gcrs> velocity{at.velocity_m_per_s[i], at.velocity_m_per_s[at.count + i],
                             at.velocity_m_per_s[2 * at.count + i]};
    slope_error.push_back(norm(at.slope(i) - derivative));
    velocity_error.push_back(norm(velocity - derivative));
  }
  ASSERT_GT(slope_error.size(), 900u);
  std::sort(slope_error.begin(), slope_error.end());
  std::sort(velocity_error.begin(), velocity_error.end());
  // (h^2 / 6) r n^3 = 0.3 mm/s of the one-second difference itself at 7000 km.
  EXPECT_LT(slope_error.back(), 1e-3);
  EXPECT_GT(velocity_error[velocity_error.size() / 2], 5e-3);
  EXPECT_GT(velocity_error.back(), 0.1);
}

const std::string host_and_neighbour =
    "HOST\n"
    "1 29155U 06018A   18020.76993589 -.00000277  00000-0  00000+0 0  9990\n"
    "2 29155   0.3033 103.4554 0011344  94.0749 132.0880  1.00469224 42737\n"
    "NEIGHBOUR\n"
    "1 29156U 06018B   18020.76993589 -.00000277  00000-0  00000+0 0  9991\n"
    "2 29156   0.3033 103.4554 0011344  94.0749 132.1880  1.00469224 42739\n";

TEST(Host, OfASensorIsLeftOutOfWhatItSees) {
  test::Stage stage(
      "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5}\n"
      "objects: [{catalogue: objects.tle}]\n"
      "sensors: [{name: a, platform: HOST, camera: wide-field-cmos, pointing: {target: "
      "NEIGHBOUR},\n"
      "  exposure_s: 1, cadence_s: 5}]\n",
      "", host_and_neighbour);
  const View view(stage.scenario.sensors[0], frame_times(stage.scenario.sensors[0], 2),
                  stage.states);
  EXPECT_EQ(objects_in_field(view), (std::vector<std::size_t>{1}));
  const auto truths = stage.frame(2).truths;
  ASSERT_EQ(truths.size(), 1u);
  EXPECT_EQ(truths[0].catalogue_number, 29156u);
  EXPECT_TRUE(std::isfinite(truths[0].true_magnitude));
}

}  // namespace
}  // namespace dmise
