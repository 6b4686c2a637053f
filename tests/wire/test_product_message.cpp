#include "nodes/wire/product_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "dmise/v1/detection.pb.h"
#include "dmise/v1/frame.pb.h"
#include "dmise/v1/track.pb.h"

namespace dmise {
namespace {

using testing::ThrowsMessage;

TEST(ProductMessage, AFieldHasTheNameOfItsMember) {
  const Detection d{.id = "eye/7/0",
                    .frame = 7,
                    .kind = DetectionKind::streak,
                    .time = {-5},
                    .sensor_position_m = {1, 2, 3},
                    .range_m = 4e5,
                    .range_sigma_m = 2.0,
                    .end1_x_px = 1.5,
                    .end1_y_px = 2.5,
                    .saturated = true};
  v1::Detection message;
  put_product(message, d);
  EXPECT_EQ(message.id(), "eye/7/0");
  EXPECT_EQ(message.frame(), 7u);
  EXPECT_EQ(message.kind(), v1::DETECTION_KIND_STREAK);
  EXPECT_EQ(message.time_ns(), -5);
  EXPECT_EQ(message.sensor_position_m(2), 3.0);
  EXPECT_EQ(message.range_m(), 4e5);
  EXPECT_FALSE(message.has_range_rate_m_per_s());
  EXPECT_EQ(message.end1_y_px(), 2.5);
  EXPECT_TRUE(message.saturated());
  EXPECT_EQ(take_product<Detection>(message), d);
}

// Fields are remembered by type and name: messages of several types share names.
TEST(ProductMessage, EqualNamesOfTwoMessagesAreTwoFields) {
  for (int k = 0; k < 3; ++k) {
    v1::Detection detection;
    v1::Track track;
    put_product(detection, Detection{.magnitude = 4.0 + k});
    put_product(track, Track{.magnitude = 8.0 + k});
    EXPECT_EQ(detection.magnitude(), 4.0 + k);
    EXPECT_EQ(track.magnitude(), 8.0 + k);
  }
}

TEST(ProductMessage, ANameThatTheMessageLacksIsAFaultOfTheProgram) {
  v1::Detection message;
  EXPECT_THROW(field_of(message, "colour"), std::logic_error);
  EXPECT_THROW(field_of(message, "time"), std::logic_error);
  EXPECT_EQ(field_of(message, "time", "_ns").name(), "time_ns");
  EXPECT_THROW(set_whole(message, field_of(message, "snr"), 1), std::logic_error);
}

TEST(ProductMessage, RefusesWhatAProductCannotHave) {
  v1::Detection message;
  put_product(message, Detection{});
  message.set_kind(static_cast<v1::DetectionKind>(7));
  EXPECT_THAT([&] { take_product<Detection>(message); }, ThrowsMessage<Refused>("kind: unknown"));
  v1::FrameReport report;
  put_product(report, FrameReport{});
  report.mutable_wcs()->add_cd_deg(1.0);
  EXPECT_THAT([&] { take_product<FrameReport>(report); },
              ThrowsMessage<Refused>("wcs.cd_deg: must have 4 values, got 5"));
}

}  // namespace
}  // namespace dmise
