#include "core/orbit/elements/omm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/orbit/elements/tle.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

using testing::HasSubstr;

// One element set (the ISS on 2008-09-20) in all notations; epoch 264.51782528 = 12:25:40.104192.
const std::string iss1 = "1 25544U 98067A   08264.51782528 -.00002182  00000-0 -11606-4 0  2927";
const std::string iss2 = "2 25544  51.6416 247.4627 0006703 130.5360 325.0288 15.72125391563537";
const std::vector<std::pair<std::string, std::string>> iss = {
    {"OBJECT_NAME", "ISS (ZARYA)"},
    {"OBJECT_ID", "1998-067A"},
    {"EPOCH", "2008-09-20T12:25:40.104192"},
    {"MEAN_MOTION", "15.72125391"},
    {"ECCENTRICITY", ".0006703"},
    {"INCLINATION", "51.6416"},
    {"RA_OF_ASC_NODE", "247.4627"},
    {"ARG_OF_PERICENTER", "130.536"},
    {"MEAN_ANOMALY", "325.0288"},
    {"EPHEMERIS_TYPE", "0"},
    {"CLASSIFICATION_TYPE", "U"},
    {"NORAD_CAT_ID", "25544"},
    {"ELEMENT_SET_NO", "292"},
    {"REV_AT_EPOCH", "56353"},
    {"BSTAR", "-.11606E-4"},
    {"MEAN_MOTION_DOT", "-.00002182"},
    {"MEAN_MOTION_DDOT", "0"}};

using Fields = std::vector<std::pair<std::string, std::string>>;

Fields changed(const std::string& key, const std::string& value) {
  Fields fields = iss;
  for (auto& field : fields)
    if (field.first == key) field.second = value;
  return fields;
}

std::string json(const Fields& fields) {
  std::string text;
  for (const auto& [key, value] : fields)
    text += (text.empty() ? "{\"" : ",\n\"") + key + "\": \"" + value + "\"";
  return text + "}";
}
std::string csv(const Fields& fields) {
  std::string keys, values;
  for (const auto& [key, value] : fields) {
    keys += (keys.empty() ? "" : ",") + key;
    values += (values.empty() ? "\"" : ",\"") + value + "\"";
  }
  return keys + "\r\n" + values + "\r\n";
}
std::string xml(const Fields& fields) {
  std::string text = "<omm id=\"CCSDS_OMM_VERS\" version=\"2.0\"><header/><body><segment><data><x>";
  for (const auto& [key, value] : fields) text += "\n  <" + key + ">" + value + "</" + key + ">";
  return text + "</x></data></segment></body></omm>";
}
std::string kvn(const Fields& fields) {
  std::string text =
      "CCSDS_OMM_VERS = 2.0\nCOMMENT none\nCENTER_NAME = EARTH\nREF_FRAME = TEME\n"
      "TIME_SYSTEM = UTC\nMEAN_ELEMENT_THEORY = SGP/SGP4\n";
  for (const auto& [key, value] : fields)
    text += key + " = " + value + (key == "MEAN_MOTION" ? " [rev/day]\n" : "\n");
  return text;
}

TEST(Omm, AllNotationsGiveTheElementsOfTheTle) {
  MeanElements expected = parse_tle(iss1, iss2);
  expected.name = "ISS (ZARYA)";
  const struct {
    std::string text;
    CatalogueFormat format;
  } cases[] = {{"[" + json(iss) + "]", CatalogueFormat::omm_json},
               {json(iss), CatalogueFormat::omm_json},
               {csv(iss), CatalogueFormat::omm_csv},
               {"<?xml version=\"1.0\"?>\n<ndm>" + xml(iss) + "</ndm>", CatalogueFormat::omm_xml},
               {kvn(iss), CatalogueFormat::omm_kvn}};
  for (const auto& c : cases) {
    const CatalogueFile file = parse_catalogue(c.text, "t");
    EXPECT_EQ(file.format, c.format);
    ASSERT_EQ(file.elements.size(), 1u) << c.text;
    MeanElements e = file.elements[0];
    EXPECT_NEAR(e.epoch_jd2, expected.epoch_jd2, 2e-16);
    EXPECT_NEAR(e.bstar_per_earth_radius, expected.bstar_per_earth_radius, 1e-20);
    e.epoch_jd2 = expected.epoch_jd2;
    e.bstar_per_earth_radius = expected.bstar_per_earth_radius;
    EXPECT_TRUE(e == expected) << name_of(c.format);
  }
}

TEST(Omm, NumbersMayBeNumbersInJson) {
  const std::string text = R"([{"NORAD_CAT_ID": 100831, "EPOCH": "2026-09-30T22:59:27.056256Z",
    "MEAN_MOTION": 15.04386585, "ECCENTRICITY": 0.00182254, "INCLINATION": 37, "RA_OF_ASC_NODE": 254.7608,
    "ARG_OF_PERICENTER": 3.221735e2, "MEAN_ANOMALY": 37.7742, "BSTAR": 1.8750396e-4, "DECAY_DATE": null,
    "EXTRA": {"NORAD_CAT_ID": 5, "LIST": [1, {"A": 2}]}}])";
  const CatalogueFile file = parse_catalogue(text, "t");
  ASSERT_EQ(file.elements.size(), 1u);
  EXPECT_EQ(file.elements[0].catalogue_number, 100831u);
  EXPECT_EQ(file.elements[0].bstar_per_earth_radius, 1.8750396e-4);
}

TEST(Omm, NumbersOf6To9DigitsAreRead) {
  for (const char* number : {"100000", "1000001", "80012345", "799999999"}) {
    const CatalogueFile file = parse_catalogue(csv(changed("NORAD_CAT_ID", number)), "t");
    ASSERT_EQ(file.elements.size(), 1u);
    EXPECT_EQ(std::to_string(file.elements[0].catalogue_number), number);
  }
  EXPECT_EQ(parse_catalogue(csv(changed("NORAD_CAT_ID", "1000000000")), "t").refused.size(), 1u);
}

TEST(Omm, RefusedMessageIsNamedWithItsLineAndTakesNoOtherWithIt) {
  const Fields bad = changed("MEAN_MOTION", "fast");
  std::string two_rows = csv(iss);
  two_rows += csv(bad).substr(csv(bad).find('\n') + 1) + "1,2\n";
  const struct {
    std::string text;
    int line;
  } cases[] = {{"[\n" + json(bad) + ",\n" + json(iss) + "\n]", 2},
               {two_rows, 3},
               {"<ndm>\n" + xml(bad) + "\n" + xml(iss) + "</ndm>", 2},
               {kvn(iss) + kvn(bad), 24}};
  for (const auto& c : cases) {
    const CatalogueFile file = parse_catalogue(c.text, "t");
    EXPECT_EQ(file.elements.size(), 1u) << c.text;
    ASSERT_FALSE(file.refused.empty());
    EXPECT_EQ(file.describe(file.refused[0]),
              "t:" + std::to_string(c.line) + ": MEAN_MOTION is not a number, got \"fast\"");
  }
  EXPECT_EQ(parse_catalogue(two_rows, "t").refused[1].reason,
            "2 fields, but the header has 17, got \"1,2\"");
}

TEST(Omm, WhatIsNotSgp4IsRefused) {
  const struct {
    const char *key, *value, *reason;
  } cases[] = {{"EPHEMERIS_TYPE", "4", "ephemeris type is not SGP4's"},
               {"EPOCH", "2008-09-31T00:00:00", "EPOCH is not a UTC time"},
               {"ECCENTRICITY", "1", "ECCENTRICITY out of range"},
               {"BSTAR", "", "no BSTAR"},
               {"NORAD_CAT_ID", "-5", "NORAD_CAT_ID is not a number"},
               {"MEAN_ANOMALY", "nan", "MEAN_ANOMALY is not a number"}};
  for (const auto& c : cases) {
    const CatalogueFile file = parse_catalogue(json(changed(c.key, c.value)), "t");
    ASSERT_EQ(file.refused.size(), 1u) << c.reason;
    EXPECT_THAT(file.refused[0].reason, HasSubstr(c.reason));
  }
  std::string xp = kvn(iss);
  xp.replace(xp.find("SGP/SGP4"), 8, "SGP4-XP");
  EXPECT_THAT(parse_catalogue(xp, "t").refused[0].reason, HasSubstr("MEAN_ELEMENT_THEORY"));
}

/// The reason for which a text of one message is refused; empty if it is read.
std::string refusal(const std::string& text) {
  const CatalogueFile file = parse_catalogue(text, "t");
  EXPECT_EQ(file.elements.size() + file.refused.size(), 1u) << text;
  return file.refused.empty() ? "" : file.refused[0].reason;
}

// Reference: CCSDS 502.0-B-2, table 4-3; capitals and powers as real files write them.
TEST(Omm, UnitsAreTheStandardsOrTheMessageIsRefused) {
  const struct {
    const char *key, *unit, *refused;
  } cases[] = {{"INCLINATION", "deg", ""},
               {"INCLINATION", "DEG", ""},
               {"INCLINATION", "rad", "the unit of INCLINATION is not DEG, got \"rad\""},
               {"MEAN_MOTION", "rev/day", ""},
               {"MEAN_MOTION", "deg/s", "the unit of MEAN_MOTION is not REV/DAY, got \"deg/s\""},
               {"ECCENTRICITY", "n/a", ""},
               {"ECCENTRICITY", "%", "the unit of ECCENTRICITY is not N/A, got \"%\""},
               {"BSTAR", "1/ER", ""},
               {"BSTAR", "1/[Earth radii]", ""},
               {"BSTAR", "1/m", "the unit of BSTAR is not 1/ER, got \"1/m\""},
               {"MEAN_MOTION_DOT", "rev/day**2", ""},
               {"MEAN_MOTION_DOT", "rev/day^2", ""},
               {"MEAN_MOTION_DOT", "rev/day",
                "the unit of MEAN_MOTION_DOT is not REV/DAY**2, got \"rev/day\""},
               {"MEAN_MOTION_DDOT", "REV/DAY ** 3", ""},
               {"ELEMENT_SET_NO", "odd", ""}};
  for (const auto& c : cases) {
    const std::string key = c.key, unit = c.unit;
    std::string in_kvn = kvn(iss), in_xml = xml(iss);
    const std::size_t at = in_kvn.find("\n" + key + " = ") + 1;
    const std::string line = in_kvn.substr(at, in_kvn.find('\n', at) - at);
    in_kvn.replace(at, line.size(), line.substr(0, line.find(" [")) + " [" + unit + "]");
    in_xml.insert(in_xml.find("<" + key + ">") + key.size() + 1, " units=\"" + unit + "\"");
    EXPECT_EQ(refusal(in_kvn), c.refused) << unit;
    EXPECT_EQ(refusal(in_xml), c.refused) << unit;
  }
}

TEST(Omm, WhatIsNoValueOrIsThereTwiceIsNamed) {
  const auto with = [](const char* key, const std::string& value) {
    std::string text = json(iss);
    const std::string name = std::string("\"") + key + "\": ";
    const std::size_t at = text.find(name) + name.size();
    return text.replace(at, text.find_first_of(",}", at) - at, value);
  };
  EXPECT_EQ(refusal(with("MEAN_MOTION", "[15.5]")), "MEAN_MOTION is an array, not a value");
  EXPECT_EQ(refusal(with("MEAN_MOTION", "{\"A\": 1}")), "MEAN_MOTION is an object, not a value");
  EXPECT_EQ(refusal(with("MEAN_MOTION", "null")), "MEAN_MOTION is null");
  EXPECT_EQ(refusal(with("MEAN_MOTION_DOT", "[1]")), "MEAN_MOTION_DOT is an array, not a value");
  EXPECT_EQ(refusal(with("ELEMENT_SET_NO", "null")), "");
  EXPECT_EQ(refusal(with("MEAN_MOTION", "\"15.7\",\n\"MEAN_MOTION\": \"15.8\"")),
            "MEAN_MOTION is there twice, got \"15.8\"");
  EXPECT_EQ(refusal(kvn(iss) + "INCLINATION = 52\n"), "INCLINATION is there twice, got \"52\"");
}

TEST(Omm, BrokenFileIsAnErrorWithItsLine) {
  for (const std::string& text :
       {"[\n" + json(iss) + ",\n{\"EPOCH\":", "<ndm>\n" + xml(iss).substr(0, 200)}) {
    try {
      parse_catalogue(text, "t");
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), testing::ContainsRegex("^t:[0-9]+: invalid (JSON|XML)"));
    }
  }
  EXPECT_THROW(parse_catalogue("CCSDS_OEM_VERS = 2.0\n", "t"), ConfigError);
  EXPECT_EQ(parse_catalogue("[1, \"a\", [2]]", "t").format, CatalogueFormat::gpredict);
  EXPECT_EQ(parse_catalogue("[\n1, \"a\", [{}], {}]", "t").refused.size(), 4u);
}

TEST(Omm, NullInAListIsRefusedByItsLine) {
  const CatalogueFile file = parse_catalogue("[\n" + json(iss) + ",\nnull\n]", "t");
  EXPECT_EQ(file.elements.size(), 1u);
  ASSERT_EQ(file.refused.size(), 1u);
  EXPECT_THAT(file.describe(file.refused[0]),
              testing::ContainsRegex("^t:[0-9]+: not a message, got \"null\""));
}

TEST(Omm, PublishedSamplesAreRead) {
  const std::string six_digits = test::data_path("tle/omm_celestrak_6digit_samples.json");
  DMISE_NEEDS_FILE(six_digits);
  const CatalogueFile file = read_catalogue(six_digits);
  ASSERT_EQ(file.elements.size(), 4u);
  EXPECT_EQ(file.elements[2].catalogue_number, 100831u);
  EXPECT_EQ(file.elements[2].designator, "26223C");
  for (const char* name : {"sgp4/sample_omm.json", "sgp4/sample_omm.csv", "sgp4/sample_omm.xml"}) {
    const CatalogueFile sample = read_catalogue(test::data_path(name));
    ASSERT_EQ(sample.elements.size(), 1u) << name;
    EXPECT_EQ(sample.elements[0].name, "VANGUARD 1");
    EXPECT_EQ(sample.elements[0].designator, "58002B");
  }
}

}  // namespace
}  // namespace dmise
