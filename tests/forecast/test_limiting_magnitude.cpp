#include "sensors/forecast/forecast_text.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

// Reference: what the detector measures in rendered frames of the same sensors, with the median
// noise of the frame. In a field of 90 deg that is vignetted, that is less than at its centre.
TEST(Forecast, ItsLimitingMagnitudeIsThatOfTheFrame) {
  for (const auto& [camera, within_mag] :
       {std::pair("omnissa", 0.2), std::pair("raven", 0.1), std::pair("geo-watch", 0.1)}) {
    test::Stage stage(
        "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 5, tick_s: 1, seed: 1}\n"
        "sensors: [{name: eye, site: savannah, pointing: zenith, exposure_s: 1, cadence_s: 5, "
        "camera: " +
        std::string(camera) + "}]\n");
    const Clock clock = make_clock(stage.scenario);
    const SensorForecast forecast =
        sensor_forecast(stage.scenario, stage.scenario.sensors[0], {}, clock, nullptr,
                        stage.threads, {.max_frames = 0});
    ASSERT_TRUE(forecast.mid_run && forecast.mid_run->point_limit_v_mag) << camera;
    EXPECT_TRUE(forecast.frames.empty());
    const FrameReport report = stage.frame().report;
    EXPECT_NEAR(*forecast.mid_run->point_limit_v_mag,
                report.limiting_magnitude - report.magnitudes.solar_colour_mag, within_mag)
        << camera;
    EXPECT_TRUE(limiting_magnitude_text(forecast).starts_with("limiting magnitude V = ")) << camera;
  }
}

}  // namespace
}  // namespace dmise
