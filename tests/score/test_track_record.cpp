#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/products/track_json.h"
#include "core/score/json_record.h"

namespace dmise {
namespace {

Track some_track() {
  Track t{.id = 7, .status = TrackStatus::lost, .time = {-5}};
  t.position_m = {1.5, -2e7, 3};
  t.velocity_m_per_s = {-7e3, 0, 1e-3};
  for (std::size_t k = 0; k < t.covariance.size(); ++k) t.covariance[k] = 0.1 * double(k);
  t.drag_m2_per_kg = 0.02, t.drag_sigma_m2_per_kg = 0.01;
  t.srp_m2_per_kg = 0.03, t.srp_sigma_m2_per_kg = 0.04;
  t.catalogue_number = 25544, t.name = "ISS \"Zarya\"";
  t.existence = 0.875, t.detections = 12;
  t.associated = {"eye/1/2", "ear/3/4"};
  t.innovation_d2 = 2.25, t.last_seen = {1'000'000'007}, t.magnitude = -1.5;
  return t;
}

std::string line_of(const Track& track) {
  return to_json(track, [](SimTime) { return std::string("2018-01-21T00:15:00Z"); });
}

TEST(TrackRecord, ReadsEveryFieldThatALineHas) {
  EXPECT_EQ(track_of(JsonRecord(line_of(some_track()), "tracks.jsonl:1")), some_track());
  EXPECT_EQ(track_of(JsonRecord(line_of(Track{}), "tracks.jsonl:1")), Track{});
}

TEST(TrackRecord, RefusesAStatusThatThereIsNot) {
  std::string line = line_of(some_track());
  line.replace(line.find("lost"), 4, "tost");
  try {
    track_of(JsonRecord(line, "tracks.jsonl:3"));
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "tracks.jsonl:3: status: must be one of tentative, confirmed, lost, did you mean "
                 "lost?, got tost");
  }
}

}  // namespace
}  // namespace dmise
