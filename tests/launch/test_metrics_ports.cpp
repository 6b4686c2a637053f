// Where the processes of a launched run serve their figures.
#include "launch/process/metrics_ports.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/files/text_file.h"

namespace dmise {
namespace {

TEST(MetricsPorts, FollowEachOther) {
  MetricsPorts ports("10.0.0.1:9100");
  EXPECT_EQ(ports.next("time-master"), "10.0.0.1:9100");
  EXPECT_EQ(ports.next("broker"), "10.0.0.1:9101");
  const std::string path = testing::TempDir() + "dmise-targets.json";
  ports.write_targets(path);
  // As Prometheus's file_sd_configs reads it.
  EXPECT_EQ(nlohmann::json::parse(read_text_file(path)),
            nlohmann::json::parse(
                R"([{"targets": ["10.0.0.1:9100"], "labels": {"process": "time-master"}},
                    {"targets": ["10.0.0.1:9101"], "labels": {"process": "broker"}}])"));
}

TEST(MetricsPorts, AreChosenByTheProcessesThemselvesWithAuto) {
  MetricsPorts ports("auto");
  EXPECT_EQ(ports.next("a"), "auto");
  const std::string path = testing::TempDir() + "dmise-no-targets.json";
  ports.write_targets(path);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(MetricsPorts("").next("a"), "");
}

TEST(MetricsPorts, EndWhereNoneIsLeft) {
  MetricsPorts ports("65535");
  EXPECT_EQ(ports.next("a"), "127.0.0.1:65535");
  EXPECT_THROW(ports.next("b"), ConfigError);
  EXPECT_THROW(MetricsPorts("port"), ConfigError);
}

}  // namespace
}  // namespace dmise
