// Requests of the Alpaca API, version 1: https://ascom-standards.org/api
#include "sensors/alpaca/alpaca_request.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

int status_of(bool put, const std::string& target, const std::string& body = "") {
  try {
    parse_alpaca(put, target, body);
  } catch (const BadRequest& error) {
    return error.status();
  }
  return 200;
}

TEST(AlpacaRequest, NamesDeviceAndMember) {
  const AlpacaCall call = parse_alpaca(
      false, "/api/v1/telescope/1/canmoveaxis?axis=0&ClientID=5&clienttransactionid=77", "");
  const auto& device = std::get<DeviceCall>(call.what);
  EXPECT_EQ(device.type, "telescope");
  EXPECT_EQ(device.number, 1u);
  EXPECT_EQ(device.member, "canmoveaxis");
  EXPECT_FALSE(device.put);
  EXPECT_EQ(call.client_transaction, 77u);
  EXPECT_EQ(call.parameters.integer("Axis"), 0);
}

TEST(AlpacaRequest, OfAPutTheFormCounts) {
  const AlpacaCall call =
      parse_alpaca(true, "/api/v1/camera/0/startexposure?Duration=9",
                   "DURATION=1.5e0&Light=True&Name=a+b%20c%2B&ClientTransactionID=4294967295");
  EXPECT_EQ(call.parameters.number("Duration"), 1.5);
  EXPECT_TRUE(call.parameters.flag("Light"));
  EXPECT_EQ(call.parameters.text("Name"), "a b c+");
  EXPECT_EQ(call.client_transaction, 4294967295u);
}

TEST(AlpacaRequest, ManagementAndSetupHaveTheirAddresses) {
  const auto what = [](const char* target) { return parse_alpaca(false, target, "").what; };
  EXPECT_TRUE(std::holds_alternative<ApiVersionsCall>(what("/management/apiversions")));
  EXPECT_TRUE(std::holds_alternative<DescriptionCall>(what("/management/v1/description")));
  EXPECT_TRUE(
      std::holds_alternative<ConfiguredDevicesCall>(what("/management/v1/configureddevices")));
  for (const char* page : {"/", "/setup", "/setup/", "/setup/v1/camera/0/setup"})
    EXPECT_TRUE(std::holds_alternative<SetupCall>(what(page))) << page;
}

TEST(AlpacaRequest, RefusesWhatIsNone) {
  for (const char* target :
       {"", "api/v1/camera/0/gain", "/api/v2/camera/0/gain", "/api/v1/camera/0", "/api/v1/camera",
        "/api/v1/camera/-1/gain", "/api/v1/camera/0x1/gain", "/api/v1/camera/4294967296/gain",
        "/api/v1/camera//gain", "/api/v1/camera/0/gain/more", "/api/v1/camera/0/gain?ClientID=-1",
        "/api/v1/camera/0/gain?ClientTransactionID=1.5", "/api/v1/camera/0/gain?a=%4",
        "/api/v1/camera/0/gain?a=%00"})
    EXPECT_EQ(status_of(false, target), 400) << target;
  EXPECT_EQ(status_of(false, "/index.html"), 404);
  EXPECT_EQ(status_of(true, "/setup"), 404);
  EXPECT_EQ(status_of(true, "/api/v1/camera/0/binx", "BinX=1&ClientID=hello"), 400);
  EXPECT_EQ(status_of(true, "/api/v1/camera/0/binx", std::string(9000, 'a')), 400);
  EXPECT_EQ(status_of(false, "/api/v1/camera/0/gain?ClientID=&ClientTransactionID="), 200);
}

TEST(AlpacaRequest, ParametersAreOfTheirKind) {
  const auto p = AlpacaParameters::parse("x=1e400&n=nan&i=1.0&j=99999999999&f=yes&e=&m=-3&d=+2.5");
  for (const char* name : {"x", "n", "f", "e", "missing"})
    EXPECT_THROW(p.number(name), BadRequest) << name;
  for (const char* name : {"i", "j", "e"}) EXPECT_THROW(p.integer(name), BadRequest) << name;
  EXPECT_THROW(p.flag("f"), BadRequest);
  EXPECT_EQ(p.integer("m"), -3);
  EXPECT_EQ(AlpacaParameters::parse("b=FALSE").flag("B"), false);
}

}  // namespace
}  // namespace dmise
