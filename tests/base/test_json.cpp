#include "core/base/files/json.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace dmise {
namespace {

TEST(JsonWriter, WritesNestedValuesInTheOrderGiven) {
  JsonWriter json;
  json.begin_object().field("b", 1).key("a").begin_array().value(true).null().value("x");
  json.end_array().key("c").begin_object().end_object().end_object();
  EXPECT_EQ(json.text(), R"({"b":1,"a":[true,null,"x"],"c":{}})");
}

TEST(JsonWriter, WritesLists) {
  JsonWriter json;
  json.begin_object().list("a", {1.5, 2}).list("b", std::vector<std::string>{"x"}).end_object();
  EXPECT_EQ(json.text(), R"({"a":[1.5,2],"b":["x"]})");
}

TEST(JsonWriter, WritesNullForNoNumber) {
  JsonWriter json;
  json.begin_object().field("a", std::optional(1.5)).field("b", std::optional<double>());
  EXPECT_EQ(json.end_object().text(), R"({"a":1.5,"b":null})");
}

TEST(JsonWriter, EscapesWhatJsonCannotHold) {
  JsonWriter json;
  json.value("say \"a\\b\"\n\x01");
  EXPECT_EQ(json.text(), "\"say \\\"a\\\\b\\\"\\n\\u0001\"");
}

TEST(JsonWriter, NumbersReadBackToTheSameBits) {
  for (const double x :
       {0.1, 1e-300, 6378137.0, -2.5e22, std::numeric_limits<double>::denorm_min()}) {
    JsonWriter json;
    json.value(x);
    EXPECT_EQ(std::strtod(json.text().c_str(), nullptr), x);
  }
}

TEST(JsonWriter, LetsNoNanOut) {
  for (const double x :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    JsonWriter json;
    json.begin_object();
    try {
      json.field("range_m", x);
      FAIL();
    } catch (const Error& e) {
      EXPECT_STREQ(e.what(), "not a finite number: range_m");
    }
  }
}

}  // namespace
}  // namespace dmise
