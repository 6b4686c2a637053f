// Properties of the devices: what they tell, how states change, what they refuse.
#include "sensors/indi/indi_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/observatory/manual_clock.h"
#include "tests/observatory/served_observatory.h"

namespace dmise {
namespace {

using testing::HasSubstr;

const std::string telescope = "eye telescope", camera = "eye camera";

struct Bench : ServedObservatory {
  explicit Bench(const std::string& name)
      : ServedObservatory(testing::TempDir() + "/" + name, std::make_shared<ManualClock>()),
        devices(observatory) {
    set(telescope, IndiKind::toggle, "CONNECTION", {{"CONNECT", "On"}});
    set(camera, IndiKind::toggle, "CONNECTION", {{"CONNECT", "On"}});
  }

  /// The answer to a new vector.
  std::string set(const std::string& device, IndiKind kind, const std::string& property,
                  const std::map<std::string, std::string>& values) {
    return devices.set({kind, device, property, values}).front().xml;
  }
  std::string defined(const std::string& device, const std::string& property) {
    const auto news = devices.defined({device, property});
    return news.empty() ? "" : news.front().xml;
  }
  std::vector<IndiNews> changes() {
    return devices.changes([](const std::string&, const std::string&) { return true; });
  }
  void pass(double t_s) { std::const_pointer_cast<ManualClock>(manual())->set(t_s); }
  std::shared_ptr<const ManualClock> manual() const {
    return std::dynamic_pointer_cast<const ManualClock>(clock);
  }

  IndiDevices devices;
};

TEST(IndiDevices, AreDefinedWhenTheyAreConnected) {
  Bench bench("indi-connect");
  EXPECT_THAT(bench.defined(telescope, "DRIVER_INFO"),
              HasSubstr("<defText name=\"DRIVER_INTERFACE\" label=\"Interface\">5<"));
  EXPECT_THAT(bench.defined(camera, "CCD_INFO"), HasSubstr("label=\"Max. Width\""));
  EXPECT_THAT(bench.set(camera, IndiKind::toggle, "CONNECTION", {{"DISCONNECT", "On"}}),
              HasSubstr("state=\"Idle\""));
  EXPECT_EQ(bench.defined(camera, "CCD_INFO"), "");
  EXPECT_THROW(bench.set(camera, IndiKind::number, "CCD_EXPOSURE", {}), DeviceError);
  EXPECT_THROW(bench.set("nose", IndiKind::number, "CCD_EXPOSURE", {}), DeviceError);
  const auto news =
      bench.devices.set({IndiKind::toggle, camera, "CONNECTION", {{"CONNECT", "On"}}});
  EXPECT_GT(news.size(), 10u);  // the definitions follow
}

TEST(IndiDevices, StatesFollowASlew) {
  Bench bench("indi-slew");
  EXPECT_THAT(bench.defined(telescope, "EQUATORIAL_EOD_COORD"), HasSubstr("state=\"Idle\""));
  const double sidereal_h = bench.observatory.sidereal_time_rad(0) / deg / 15.0;
  EXPECT_THAT(bench.set(telescope, IndiKind::number, "EQUATORIAL_EOD_COORD",
                        {{"RA", std::to_string(sidereal_h)}, {"DEC", "30"}}),
              HasSubstr("state=\"Busy\""));
  bench.changes();
  bench.pass(200.0);
  std::string told;
  for (const IndiNews& news : bench.changes()) told += news.xml;
  EXPECT_THAT(told, HasSubstr("name=\"EQUATORIAL_EOD_COORD\" state=\"Ok\""));
  EXPECT_TRUE(bench.changes().empty());
}

TEST(IndiDevices, AnswersWrongValuesByAlertAndAMessage) {
  Bench bench("indi-wrong");
  const auto refused = [&](const std::string& device, IndiKind kind, const char* property,
                           const std::map<std::string, std::string>& values, const char* reason) {
    const std::string xml = bench.set(device, kind, property, values);
    EXPECT_THAT(xml, HasSubstr("state=\"Alert\""));
    EXPECT_THAT(xml, HasSubstr(reason));
  };
  refused(camera, IndiKind::number, "CCD_BINNING", {{"HOR_BIN", "9"}},
          "HOR_BIN must be 1 to 8, got 9");
  refused(camera, IndiKind::number, "CCD_BINNING", {{"HOR_BIN", "x"}}, "must be a number, got x");
  refused(camera, IndiKind::number, "CCD_BINNING", {{"BIN", "1"}}, "it has no item BIN");
  refused(camera, IndiKind::number, "CCD_BINNING", {}, "no values are given");
  refused(camera, IndiKind::text, "CCD_BINNING", {{"HOR_BIN", "1"}}, "set by newNumberVector");
  refused(camera, IndiKind::number, "CCD_INFO", {{"CCD_MAX_X", "5"}}, "it can't be set");
  refused(camera, IndiKind::toggle, "CCD_FRAME_TYPE", {{"FRAME_X", "On"}}, "no item FRAME_X");
  refused(telescope, IndiKind::text, "SAT_TLE_TEXT", {{"TLE", "1 2"}}, "the element set");
  refused(telescope, IndiKind::toggle, "SAT_TRACKING_STAT", {{"SAT_TRACK", "On"}},
          "SAT_TLE_TEXT was not set");
  refused(camera, IndiKind::toggle, "UPLOAD_MODE", {{"UPLOAD_BOTH", "Off"}}, "one must be On");
  refused(camera, IndiKind::toggle, "UPLOAD_MODE", {{"UPLOAD_BOTH", "1"}},
          "must be On or Off, got 1");
  refused(camera, IndiKind::toggle, "UPLOAD_MODE", {{"UPLOAD_BOTH", "On"}, {"UPLOAD_LOCAL", "On"}},
          "only one may be On");
  refused(telescope, IndiKind::toggle, "TELESCOPE_PARK", {{"PARK", "maybe"}}, "On or Off");
  EXPECT_THAT(
      bench.set(camera, IndiKind::number, "CCD_BINNING", {{"HOR_BIN", "2"}, {"VER_BIN", "2"}}),
      HasSubstr("state=\"Ok\""));
}

TEST(IndiDevices, FramesAreInPixelsOfTheDetector) {
  Bench bench("indi-frame");
  const auto number = [&](const char* name, int value) {
    return HasSubstr("<oneNumber name=\"" + std::string(name) + "\">" + std::to_string(value) +
                     "<");
  };
  const auto frame = [&](const char* x, const char* width) {
    return bench.set(camera, IndiKind::number, "CCD_FRAME", {{"X", x}, {"WIDTH", width}});
  };
  EXPECT_THAT(frame("8", "16"), number("WIDTH", 16));
  bench.set(camera, IndiKind::number, "CCD_BINNING", {{"HOR_BIN", "4"}, {"VER_BIN", "4"}});
  EXPECT_THAT(bench.defined(camera, "CCD_FRAME"), HasSubstr("step=\"1\">16</defNumber>"));
  bench.observatory.use(0, [](const Observatory::Devices& d) {
    EXPECT_EQ(d.camera.window(), (Window{4, 4, 2, 0, 4, 6}));
  });
  EXPECT_THAT(frame("30", "3"), HasSubstr("reaches beyond 32 x 24"));
  EXPECT_THAT(frame("0", "2"), HasSubstr("smaller than a binned pixel"));
  EXPECT_THAT(bench.set(camera, IndiKind::toggle, "CCD_FRAME_RESET", {{"RESET", "On"}}),
              HasSubstr("state=\"Ok\""));
  bench.observatory.use(0, [](const Observatory::Devices& d) {
    EXPECT_EQ(d.camera.window(), (Window{1, 1, 0, 0, 32, 24}));
  });
}

TEST(IndiDevices, AnExposureIsBusyThenItsImageThenOk) {
  Bench bench("indi-expose");
  const std::map<std::string, std::string> one_s{{"CCD_EXPOSURE_VALUE", "1"}};
  EXPECT_THAT(bench.set(camera, IndiKind::number, "CCD_EXPOSURE", one_s),
              HasSubstr("state=\"Busy\""));
  const std::string again = bench.set(camera, IndiKind::number, "CCD_EXPOSURE", one_s);
  EXPECT_THAT(again, HasSubstr("state=\"Alert\""));
  EXPECT_THAT(again, HasSubstr("an exposure is under way"));
  bench.pass(5.0);
  std::vector<IndiNews> news;
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::ranges::none_of(news, &IndiNews::blob)) {
    ASSERT_LT(std::chrono::steady_clock::now(), patience);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    for (IndiNews& item : bench.changes()) news.push_back(std::move(item));
  }
  const auto blob = std::ranges::find(news, true, &IndiNews::blob);
  EXPECT_THAT(blob->xml, HasSubstr("format=\".fits\">" + base64("SIMPLE  =").substr(0, 12)));
  const auto done = std::ranges::find_if(news, [](const IndiNews& item) {
    return item.property == "CCD_EXPOSURE" && item.xml.find("state=\"Ok\"") != std::string::npos;
  });
  EXPECT_TRUE(done != news.end() && blob < done);
  EXPECT_EQ(bench.defined(camera, "CCD_FILE_PATH"), "");
  bench.set(camera, IndiKind::toggle, "UPLOAD_MODE", {{"UPLOAD_BOTH", "On"}});
  EXPECT_THAT(bench.defined(camera, "CCD_FILE_PATH"), HasSubstr("/eye/frame-000001.fits"));
}

std::string told(const std::vector<IndiNews>& news) {
  std::string all;
  for (const IndiNews& one : news) all += one.xml;
  return all;
}

TEST(IndiDevices, FocuserWheelAndCoverAreBusyWhileTheyMove) {
  Bench bench("indi-moves");
  const std::string focuser = "eye focuser", wheel = "eye filter wheel", cover = "eye cover";
  for (const std::string& device : {focuser, wheel, cover})
    bench.set(device, IndiKind::toggle, "CONNECTION", {{"CONNECT", "On"}});
  EXPECT_THAT(bench.set(focuser, IndiKind::number, "REL_FOCUS_POSITION",
                        {{"FOCUS_RELATIVE_POSITION", "100"}}),
              HasSubstr("state=\"Busy\""));
  EXPECT_THAT(bench.set(wheel, IndiKind::number, "FILTER_SLOT", {{"FILTER_SLOT_VALUE", "2"}}),
              HasSubstr("state=\"Busy\""));
  EXPECT_THAT(bench.set(cover, IndiKind::toggle, "CAP_PARK", {{"PARK", "On"}}),
              HasSubstr("state=\"Busy\""));
  EXPECT_THAT(bench.set(camera, IndiKind::number, "CCD_EXPOSURE", {{"CCD_EXPOSURE_VALUE", "1"}}),
              HasSubstr("moves, which no frame shows"));
  bench.changes();
  bench.pass(10.0);
  const std::string after = told(bench.changes());
  for (const char* property : {"ABS_FOCUS_POSITION", "FILTER_SLOT", "CAP_PARK"})
    EXPECT_THAT(after, HasSubstr("name=\"" + std::string(property) + "\" state=\"Ok\""));
  EXPECT_THAT(bench.defined(wheel, "FILTER_NAME"),
              HasSubstr("name=\"FILTER_SLOT_NAME_2\" label=\"FILTER_SLOT_NAME_2\">bessell-B<"));
  EXPECT_THAT(bench.set(wheel, IndiKind::number, "FILTER_SLOT", {{"FILTER_SLOT_VALUE", "4"}}),
              HasSubstr("must be 1 to 3"));
  EXPECT_TRUE(bench.observatory.of(0, [](const auto& d) { return d.wheel.goal() == 1; }));
}

// KStars 3.6.2 with *Mount* as the source of time and place (ISD::GenericDevice::processText).
TEST(IndiDevices, PlaceAndTimeAreUpdatedWhenTheyAreDefined) {
  Bench bench("indi-place");
  bench.set(telescope, IndiKind::toggle, "CONNECTION", {{"DISCONNECT", "On"}});
  const auto connected =
      bench.devices.set({IndiKind::toggle, telescope, "CONNECTION", {{"CONNECT", "On"}}});
  for (const auto& news : {connected, bench.devices.defined({telescope, ""})}) {
    for (const char* update : {"<setNumberVector device=\"eye telescope\" "
                               "name=\"GEOGRAPHIC_COORD\" state=\"Ok\"",
                               "<setTextVector device=\"eye telescope\" "
                               "name=\"TIME_UTC\" state=\"Ok\""})
      EXPECT_THAT(told(news), HasSubstr(update));
  }
}

TEST(IndiDevices, WeatherIsTheScenarios) {
  Bench bench("indi-weather");
  bench.set("eye weather", IndiKind::toggle, "CONNECTION", {{"CONNECT", "On"}});
  const std::string parameters = bench.defined("eye weather", "WEATHER_PARAMETERS");
  EXPECT_THAT(parameters, HasSubstr("name=\"WEATHER_PRESSURE\""));
  EXPECT_THAT(parameters, HasSubstr(">13.7<"));
  EXPECT_THAT(bench.set("eye weather", IndiKind::toggle, "WEATHER_REFRESH", {{"REFRESH", "On"}}),
              HasSubstr("state=\"Ok\""));
}

}  // namespace
}  // namespace dmise
