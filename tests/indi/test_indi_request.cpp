// Requests of the INDI protocol, version 1.7, and its numbers.
#include "sensors/indi/indi_request.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

std::optional<IndiRequest> request_of(const std::string& text) {
  IndiStream stream;
  stream.add(text);
  return parse_indi(stream.next().value());
}

// The forms of the protocol's numbers: decimal, and sexagesimal with blanks, colons or semicolons.
TEST(IndiRequest, ReadsNumbers) {
  EXPECT_EQ(indi_number("-10.25"), -10.25);
  EXPECT_EQ(indi_number("+1e3"), 1000.0);
  EXPECT_EQ(indi_number("-0:30"), -0.5);
  EXPECT_EQ(indi_number("12:30:36"), 12.51);
  EXPECT_EQ(indi_number(" 12 30 36 "), 12.51);
  EXPECT_EQ(indi_number("12;30.6"), 12.51);
  for (const char* text : {"", "-", "1:2:3:4", "1:-2", "::", "nan", "inf", "1e999", "5x", "1::2"})
    EXPECT_FALSE(indi_number(text)) << text;
}

TEST(IndiRequest, ReadsRequests) {
  const auto all = request_of("<getProperties version='1.7'/>");
  EXPECT_EQ(std::get<GetIndiProperties>(*all).device, "");
  const auto blob = request_of("<enableBLOB device='d' name='CCD1'> Only\n</enableBLOB>");
  EXPECT_EQ(std::get<EnableIndiBlob>(*blob).use, BlobUse::only);
  const auto set = request_of(
      "<newSwitchVector device='d' name='CONNECTION'><oneSwitch name='CONNECT'>On</oneSwitch>"
      "</newSwitchVector>");
  const auto& vector = std::get<NewIndiVector>(*set);
  EXPECT_EQ(vector.kind, IndiKind::toggle);
  EXPECT_EQ(vector.values.at("CONNECT"), "On");
}

TEST(IndiRequest, IgnoresWhatItDoesNotKnowAndRefusesWhatIsIncomplete) {
  EXPECT_FALSE(request_of("<setNumberVector device='d' name='n'/>"));
  EXPECT_FALSE(request_of("<pingReply uid='1'/>"));
  for (const char* text :
       {"<newNumberVector device='d'/>", "<newTextVector name='n'/>",
        "<enableBLOB device='d'>Sometimes</enableBLOB>", "<enableBLOB/>",
        "<newTextVector device='d' name='n'><oneText>a</oneText></newTextVector>",
        "<newTextVector device='d' name='n'><oneSwitch name='a'/></newTextVector>"})
    EXPECT_THROW(request_of(text), BadIndi) << text;
}

}  // namespace
}  // namespace dmise
