// Members of the devices answer with the values and the error numbers of ASCOM's interfaces.
#include "sensors/alpaca/alpaca_devices.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/observatory/manual_clock.h"
#include "tests/observatory/served_observatory.h"

namespace dmise {
namespace {

constexpr int bad_request = 400, not_implemented = 0x400, invalid_value = 0x401,
              value_not_set = 0x402, not_connected = 0x407, while_parked = 0x408,
              invalid_operation = 0x40B, action_not_implemented = 0x40C;

struct Bench : ServedObservatory {
  explicit Bench(const std::string& name,
                 std::shared_ptr<const ObservatoryClock> time = std::make_shared<WallClock>(100.0),
                 const std::string& keys = {})
      : ServedObservatory(testing::TempDir() + "/" + name, std::move(time), keys),
        devices(observatory) {
    put("camera", "connected", "Connected=true");
    put("telescope", "connected", "Connected=true");
  }

  MemberAnswer call(const std::string& type, const std::string& member, bool put,
                    const std::string& parameters) {
    return devices.call({.type = type, .member = member, .put = put},
                        AlpacaParameters::parse(parameters));
  }
  std::string get(const std::string& type, const std::string& member,
                  const std::string& parameters = "") {
    return call(type, member, false, parameters).value;
  }
  /// The error number of a call, the status of a malformed one, or 0.
  int fault(const std::string& type, const std::string& member, bool put,
            const std::string& parameters = "") {
    try {
      call(type, member, put, parameters);
    } catch (const DeviceError& error) {
      return int(error.fault());
    } catch (const BadRequest& error) {
      return error.status();
    }
    return 0;
  }
  int put(const std::string& type, const std::string& member, const std::string& parameters = "") {
    return fault(type, member, true, parameters);
  }
  int get_fault(const std::string& type, const std::string& member,
                const std::string& parameters = "") {
    return fault(type, member, false, parameters);
  }
  void wait_until(const std::string& type, const std::string& member, const std::string& value) {
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (get(type, member) != value) {
      ASSERT_LT(std::chrono::steady_clock::now(), patience) << member;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  AlpacaDevices devices;
};

TEST(AlpacaDevices, DoNotAnswerWhileTheirLinkIsLostAndTellAWrongGain) {
  const auto clock = std::make_shared<ManualClock>();
  Bench bench("alpaca-malfunctions", clock,
              "    malfunctions:\n"
              "      - {kind: lost_link, at_s: 100, for_s: 50}\n"
              "      - {kind: wrong_gain, at_s: 200, for_s: 50, gain_e_per_dn: 3.5}\n");
  constexpr int driver = 0x500;
  EXPECT_EQ(bench.get("camera", "electronsperadu"), "2");
  clock->set(120.0);
  EXPECT_EQ(bench.get("camera", "connected"), "false");
  EXPECT_EQ(bench.get_fault("camera", "electronsperadu"), driver);
  EXPECT_EQ(bench.put("telescope", "tracking", "Tracking=true"), driver);
  clock->set(150.0);
  EXPECT_EQ(bench.get("camera", "connected"), "true");
  EXPECT_EQ(bench.put("telescope", "tracking", "Tracking=true"), 0);
  clock->set(200.0);
  EXPECT_EQ(bench.get("camera", "electronsperadu"), "3.5");
  EXPECT_EQ(bench.get("camera", "gains"), "[\"3.5 e-/DN\"]");
}

TEST(AlpacaDevices, MayBeConnectedFromTheBeginning) {
  Bench bench("alpaca-connected-at-once");
  AlpacaDevices devices(bench.observatory, true);
  EXPECT_EQ(devices.call({.type = "focuser", .member = "ismoving"}, {}).value, "false");
}

TEST(AlpacaDevices, AnswerOnlyWhenConnected) {
  Bench bench("alpaca-connected");
  EXPECT_EQ(bench.get("camera", "connected"), "true");
  EXPECT_EQ(bench.put("camera", "disconnect"), 0);
  EXPECT_EQ(bench.get("camera", "connected"), "false");
  EXPECT_EQ(bench.get_fault("camera", "cameraxsize"), not_connected);
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=1&Light=true"), not_connected);
  EXPECT_EQ(bench.get("camera", "interfaceversion"), "4");
  EXPECT_EQ(bench.get("telescope", "interfaceversion"), "4");
  EXPECT_EQ(bench.put("camera", "connect"), 0);
  EXPECT_EQ(bench.get("camera", "cameraxsize"), "32");
}

TEST(AlpacaDevices, CallsThatAreNoneAreMalformed) {
  Bench bench("alpaca-malformed");
  EXPECT_EQ(bench.get_fault("camera", "nosuchmember"), bad_request);
  EXPECT_EQ(bench.get_fault("dome", "azimuth"), bad_request);
  EXPECT_EQ(bench.put("camera", "cameraxsize", "CameraXSize=4"), bad_request);
  EXPECT_EQ(bench.get_fault("camera", "startexposure"), bad_request);
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=1"), bad_request);
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=one&Light=true"), bad_request);
  EXPECT_EQ(bench.put("telescope", "tracking", "Tracking=maybe"), bad_request);
  EXPECT_EQ(bench.get_fault("telescope", "axisrates"), bad_request);
  EXPECT_THROW(bench.devices.call({.type = "camera", .number = 1, .member = "gain"}, {}),
               BadRequest);
}

TEST(AlpacaDevices, ACameraRefusesWithTheNumbersOfTheStandard) {
  Bench bench("alpaca-camera");
  for (const char* member : {"bayeroffsetx", "bayeroffsety", "gainmin", "gainmax", "offsetmin",
                             "offsetmax", "fastreadout", "subexposureduration", "ispulseguiding"})
    EXPECT_EQ(bench.get_fault("camera", member), not_implemented) << member;
  EXPECT_EQ(bench.put("camera", "pulseguide", "Direction=0&Duration=10"), not_implemented);
  for (const char* member :
       {"imagearray", "imagearrayvariant", "lastexposureduration", "lastexposurestarttime"})
    EXPECT_EQ(bench.get_fault("camera", member), invalid_operation) << member;
  EXPECT_EQ(bench.put("camera", "binx", "BinX=0"), invalid_value);
  EXPECT_EQ(bench.put("camera", "gain", "Gain=1"), invalid_value);
  EXPECT_EQ(bench.put("camera", "readoutmode", "ReadoutMode=-1"), invalid_value);
  EXPECT_EQ(bench.put("camera", "setccdtemperature", "SetCCDTemperature=-300"), invalid_value);
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=-1&Light=true"), invalid_value);
  EXPECT_EQ(bench.put("camera", "numx", "NumX=33"), 0);
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=1&Light=true"), invalid_value);
  EXPECT_EQ(bench.put("camera", "action", "Action=x&Parameters="), action_not_implemented);
  EXPECT_EQ(bench.put("camera", "commandblind", "Command=x&Raw=true"), not_implemented);
}

// 16-bit counts of 2 e-, a window of 2 x 2 bins.
TEST(AlpacaDevices, ACameraExposes) {
  Bench bench("alpaca-exposes");
  EXPECT_EQ(bench.get("camera", "maxadu"), "65535");
  EXPECT_EQ(bench.get("camera", "electronsperadu"), "2");
  EXPECT_EQ(bench.put("camera", "binx", "BinX=2"), 0);
  EXPECT_EQ(bench.get("camera", "biny"), "2");
  EXPECT_EQ(bench.get("camera", "numx"), "16");
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=50&Light=true"), 0);
  EXPECT_EQ(bench.get("camera", "camerastate"), "2");
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=50&Light=true"), invalid_operation);
  EXPECT_EQ(bench.put("telescope", "tracking", "Tracking=true"), invalid_operation);
  bench.wait_until("camera", "imageready", "true");
  const auto image = bench.call("camera", "imagearray", false, "").image;
  ASSERT_TRUE(image);
  EXPECT_EQ(image->columns, 16);
  EXPECT_EQ(image->rows, 12);
  EXPECT_GE(image->at(0, 0), 4 * 100 - 50);  // the bias of four pixels
  EXPECT_EQ(bench.get("camera", "lastexposureduration"), "50");
  EXPECT_TRUE(bench.get("camera", "lastexposurestarttime").starts_with("\"2018-01-21T00:"));
}

TEST(AlpacaDevices, ATelescopeRefusesWithTheNumbersOfTheStandard) {
  Bench bench("alpaca-telescope");
  const char* const t = "telescope";
  EXPECT_EQ(bench.get_fault(t, "targetrightascension"), value_not_set);
  EXPECT_EQ(bench.put(t, "slewtotargetasync"), value_not_set);
  for (const char* given : {"RightAscension=-1&Declination=0", "RightAscension=24&Declination=0",
                            "RightAscension=1&Declination=91"})
    EXPECT_EQ(bench.put(t, "slewtocoordinatesasync", given), invalid_value) << given;
  EXPECT_EQ(bench.put(t, "slewtocoordinatesasync", "RightAscension=3&Declination=40"),
            invalid_operation);  // it does not track
  EXPECT_EQ(bench.put(t, "slewtoaltazasync", "Azimuth=361&Altitude=40"), invalid_value);
  EXPECT_EQ(bench.put(t, "slewtoaltazasync", "Azimuth=180&Altitude=5"), invalid_value);
  EXPECT_EQ(bench.put(t, "trackingrate", "TrackingRate=1"), invalid_value);
  EXPECT_EQ(bench.put(t, "moveaxis", "Axis=3&Rate=0"), invalid_value);
  EXPECT_EQ(bench.put(t, "moveaxis", "Axis=0&Rate=50"), invalid_value);
  EXPECT_EQ(bench.get_fault(t, "canmoveaxis", "Axis=-1"), invalid_value);
  for (const auto& [member, given] :
       std::vector<std::pair<const char*, const char*>>{{"sideofpier", "SideOfPier=0"},
                                                        {"sitelatitude", "SiteLatitude=1"},
                                                        {"sitelongitude", "SiteLongitude=1"},
                                                        {"siteelevation", "SiteElevation=1"},
                                                        {"doesrefraction", "DoesRefraction=true"},
                                                        {"utcdate", "UTCDate=2020-01-01T00:00:00Z"},
                                                        {"synctoaltaz", "Azimuth=1&Altitude=50"}})
    EXPECT_EQ(bench.put(t, member, given), not_implemented) << member;
  EXPECT_EQ(bench.put(t, "park"), 0);
  bench.wait_until(t, "atpark", "true");
  EXPECT_EQ(bench.put(t, "tracking", "Tracking=true"), while_parked);
  EXPECT_EQ(bench.put(t, "abortslew"), while_parked);
  EXPECT_EQ(bench.put(t, "unpark"), 0);
}

TEST(AlpacaDevices, ATelescopeSlewsAndTracks) {
  const auto time = std::make_shared<ManualClock>();
  Bench bench("alpaca-slews", time);
  const char* const t = "telescope";
  EXPECT_EQ(bench.put(t, "tracking", "Tracking=true"), 0);
  EXPECT_EQ(bench.put(t, "targetrightascension", "TargetRightAscension=4.5"), 0);
  EXPECT_EQ(bench.put(t, "targetdeclination", "TargetDeclination=40.25"), 0);
  EXPECT_EQ(bench.put(t, "slewtotargetasync"), 0);
  EXPECT_EQ(bench.get(t, "slewing"), "true");
  time->set(100.0);
  EXPECT_EQ(bench.get(t, "slewing"), "false");
  EXPECT_NEAR(std::stod(bench.get(t, "rightascension")), 4.5, 1e-9);
  EXPECT_NEAR(std::stod(bench.get(t, "declination")), 40.25, 1e-9);
  EXPECT_EQ(bench.put(t, "rightascensionrate", "RightAscensionRate=0.5"), 0);
  EXPECT_NEAR(std::stod(bench.get(t, "rightascensionrate")), 0.5, 1e-12);
  EXPECT_EQ(bench.put(t, "declinationrate", "DeclinationRate=-3"), 0);
  EXPECT_NEAR(std::stod(bench.get(t, "declinationrate")), -3.0, 1e-12);
  // A slew that its answer waits for.
  const auto answer = bench.call(t, "slewtocoordinates", true, "RightAscension=4.6&Declination=41");
  ASSERT_TRUE(answer.done);
  EXPECT_FALSE(answer.done());
  time->set(200.0);
  EXPECT_TRUE(answer.done());
}

TEST(AlpacaDevices, AFocuserMovesBySteps) {
  const auto time = std::make_shared<ManualClock>();
  Bench bench("alpaca-focuser", time);
  const char* const f = "focuser";
  EXPECT_EQ(bench.get_fault(f, "position"), not_connected);
  EXPECT_EQ(bench.put(f, "connected", "Connected=true"), 0);
  EXPECT_EQ(bench.get(f, "interfaceversion"), "4");
  EXPECT_EQ(bench.get(f, "absolute"), "true");
  EXPECT_EQ(bench.get(f, "stepsize"), "1");
  const int middle = std::stoi(bench.get(f, "maxstep")) / 2;
  EXPECT_EQ(bench.get(f, "position"), std::to_string(middle));
  EXPECT_EQ(bench.put(f, "move", "Position=" + std::to_string(middle + 200)), 0);
  EXPECT_EQ(bench.get(f, "ismoving"), "true");
  time->set(1.0);
  EXPECT_EQ(bench.get(f, "ismoving"), "false");
  EXPECT_EQ(bench.get(f, "position"), std::to_string(middle + 200));
  EXPECT_EQ(bench.put(f, "move", "Position=-1"), invalid_value);
  EXPECT_EQ(bench.put(f, "move", "Position=" + std::to_string(2 * middle + 1)), invalid_value);
  EXPECT_EQ(bench.put(f, "tempcomp", "TempComp=true"), not_implemented);
  EXPECT_EQ(bench.put(f, "halt"), 0);
}

TEST(AlpacaDevices, AFilterWheelTurns) {
  const auto time = std::make_shared<ManualClock>();
  Bench bench("alpaca-wheel", time);
  const char* const w = "filterwheel";
  bench.put(w, "connected", "Connected=true");
  EXPECT_EQ(bench.get(w, "names"), "[\"V\",\"bessell-B\",\"wide\"]");
  EXPECT_EQ(bench.get(w, "focusoffsets"), "[0,0,0]");
  EXPECT_EQ(bench.put(w, "position", "Position=1"), 0);
  EXPECT_EQ(bench.get(w, "position"), "-1");
  time->set(5.0);
  EXPECT_EQ(bench.get(w, "position"), "1");
  for (const char* place : {"Position=3", "Position=-1"})
    EXPECT_EQ(bench.put(w, "position", place), invalid_value);
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=50&Light=true"), 0);
  EXPECT_EQ(bench.put(w, "position", "Position=0"), invalid_operation);
}

// ASCOM's numbers: no calibrator is 0; closed, moving, open are 1, 2, 3.
TEST(AlpacaDevices, ACoverOpensAndCloses) {
  const auto time = std::make_shared<ManualClock>();
  Bench bench("alpaca-cover", time);
  const char* const c = "covercalibrator";
  bench.put(c, "connected", "Connected=true");
  EXPECT_EQ(bench.get(c, "coverstate"), "3");
  EXPECT_EQ(bench.get(c, "calibratorstate"), "0");
  EXPECT_EQ(bench.put(c, "closecover"), 0);
  EXPECT_EQ(bench.get(c, "coverstate"), "2");
  EXPECT_EQ(bench.get(c, "covermoving"), "true");
  EXPECT_EQ(bench.put("camera", "startexposure", "Duration=1&Light=true"), invalid_operation);
  time->set(5.0);
  EXPECT_EQ(bench.get(c, "coverstate"), "1");
  for (const char* member : {"brightness", "maxbrightness"})
    EXPECT_EQ(bench.get_fault(c, member), not_implemented) << member;
  EXPECT_EQ(bench.put(c, "calibratoron", "Brightness=1"), not_implemented);
  EXPECT_EQ(bench.put(c, "calibratoroff"), not_implemented);
}

TEST(AlpacaDevices, ConditionsAreTheScenariosAir) {
  Bench bench("alpaca-conditions", std::make_shared<ManualClock>());
  const char* const o = "observingconditions";
  bench.put(o, "connected", "Connected=true");
  EXPECT_EQ(bench.get(o, "temperature"), "13.7");
  EXPECT_EQ(bench.get(o, "pressure"), "989");
  EXPECT_EQ(bench.get(o, "humidity"), "50");
  EXPECT_EQ(bench.get(o, "cloudcover"), "0");
  EXPECT_NEAR(std::stod(bench.get(o, "dewpoint")), 3.5, 0.1);
  EXPECT_NEAR(std::stod(bench.get(o, "skyquality")), 21.5, 1.0);  // a dark sky
  for (const char* member :
       {"rainrate", "skytemperature", "starfwhm", "winddirection", "windgust", "windspeed"})
    EXPECT_EQ(bench.get_fault(o, member), not_implemented) << member;
  EXPECT_EQ(bench.put(o, "averageperiod", "AveragePeriod=1"), invalid_value);
  EXPECT_EQ(bench.put(o, "averageperiod", "AveragePeriod=0"), 0);
  EXPECT_EQ(bench.put(o, "refresh"), 0);
  EXPECT_EQ(bench.get(o, "timesincelastupdate", "SensorName="), "0");
  EXPECT_EQ(bench.get_fault(o, "timesincelastupdate", "SensorName=WindGust"), not_implemented);
  EXPECT_EQ(bench.get_fault(o, "sensordescription", "SensorName=Nose"), invalid_value);
  EXPECT_NE(bench.get(o, "sensordescription", "SensorName=Humidity"), "");
}

}  // namespace
}  // namespace dmise
