// What an operator sees of a network of processes: metrics and logs in JSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/files/whole_file.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/observability/status.h"
#include "tests/runtime/http.h"
#include "tests/runtime/metrics_page.h"
#include "tests/support/command.h"
#include "tests/support/process.h"

namespace dmise {
namespace {

using test::Child;
using test::http_get;
using test::MetricsPage;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::string bin = DMISE_BINARY_DIR "/bin/";
constexpr double patience_s = 20.0;

/// Master, broker, orbit and a camera that hangs in tick 7: the clock stands there.
struct HeldRun {
  explicit HeldRun(const std::vector<std::string>& flags = {"--metrics", "auto"}) {
    master = start(
        {bin + "dmise-time-master", "--expect", "orbit,a", "--announce-fd", "1", "--ticks", "50"},
        flags);
    if (!master->says("tcp://")) return;
    const auto at = master->output().find("tcp://");
    address = master->output().substr(at, master->output().find('\n', at) - at);
    broker = start({bin + "dmise-broker", "--master", address}, flags);
    orbit =
        start({bin + "toy-node", "--role", "orbit", "--name", "orbit", "--master", address}, flags);
    camera = start({bin + "toy-node", "--role", "camera", "--name", "a", "--master", address,
                    "--hang-at", "7"},
                   flags);
  }
  static std::unique_ptr<Child> start(std::vector<std::string> command,
                                      const std::vector<std::string>& flags) {
    command.insert(command.end(), flags.begin(), flags.end());
    return std::make_unique<Child>(command);
  }
  bool held() const {
    const auto deadline =
        std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
    while (std::chrono::steady_clock::now() < deadline) {
      const RunStatus status = ask_master(address, patience_s);
      if (status.settled == 6 && status.holding == std::vector<std::string>{"a"}) return true;
    }
    return false;
  }
  std::unique_ptr<Child> master, broker, orbit, camera;
  std::string address;
};

/// Port of the metrics that a process has said; 0 when it does not.
int metrics_port(Child& process) {
  const std::string before = "metrics at http://127.0.0.1:";
  if (!process.says(before) || !process.says("/metrics")) return 0;
  return std::atoi(process.output().c_str() + process.output().find(before) + before.size());
}

std::string body_of(const std::string& answer) {
  const auto at = answer.find("\r\n\r\n");
  return at == std::string::npos ? "" : answer.substr(at + 4);
}

/// The page of a process once `sample` is `value`, or as it is when the time is over.
MetricsPage page_with(Child& process, const std::string& sample, double value) {
  const int port = metrics_port(process);
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  while (true) {
    MetricsPage page(body_of(http_get(port, "/metrics")));
    if (page.value(sample) == value || std::chrono::steady_clock::now() > deadline) return page;
  }
}

TEST(Metrics, OfTheTimeMasterSayWhoHoldsTheClock) {
  HeldRun run;
  ASSERT_TRUE(run.held());
  const MetricsPage page = page_with(*run.master, "dmise_clock_settled_tick", 6);
  EXPECT_EQ(page.value(R"(dmise_clock_held{node="a"})"), 1);
  EXPECT_EQ(page.value(R"(dmise_clock_held{node="orbit"})"), 0);
  EXPECT_EQ(page.value("dmise_clock_settled_tick"), 6);
  EXPECT_EQ(page.value("dmise_clock_granted_tick"), 7);
  EXPECT_EQ(page.value("dmise_clock_last_tick"), 49);
  EXPECT_EQ(page.value("dmise_clock_tick_seconds"), 1);
  EXPECT_EQ(page.value(R"(dmise_clock_phase{phase="running"})"), 1);
  EXPECT_EQ(page.value(R"(dmise_clock_phase{phase="failed"})"), 0);
  EXPECT_EQ(page.value(R"(dmise_clock_node_up{node="orbit"})"), 1);
  EXPECT_EQ(page.value(R"(dmise_clock_node_restarts_total{node="a"})"), 0);
}

TEST(Metrics, OfANodeCountItsTicksAndMessages) {
  HeldRun run;
  page_with(*run.camera, R"(dmise_node_ticks_total{node="a"})", 7);
  // All that it does from now on is tick 7.
  const MetricsPage camera = page_with(*run.camera, R"(dmise_node_computing{node="a"})", 1);
  EXPECT_EQ(camera.value(R"(dmise_node_granted_tick{node="a"})"), 7);
  EXPECT_EQ(camera.value(R"(dmise_node_ticks_total{node="a"})"), 7);  // 0 to 6
  EXPECT_EQ(camera.value(R"(dmise_node_done_tick{node="a"})"), 6);
  EXPECT_EQ(camera.value(R"(dmise_node_computing{node="a"})"), 1);
  EXPECT_GT(camera.value(R"(dmise_node_received_messages_total{node="a"})"), 7);
  EXPECT_EQ(camera.value(R"(dmise_node_refused_messages_total{node="a",reason="seal"})"), 0);
  EXPECT_GT(camera.value(R"(dmise_node_detections_total{node="a"})"), 0);
  EXPECT_GT(camera.value("process_resident_memory_bytes"), 1e6);
  EXPECT_GT(camera.value("process_cpu_seconds_total"), 0);

  const MetricsPage orbit = page_with(*run.orbit, R"(dmise_node_ticks_total{node="orbit"})", 8);
  EXPECT_EQ(orbit.value(R"(dmise_node_ticks_total{node="orbit"})"), 8);
  EXPECT_GT(orbit.value(R"(dmise_node_sent_bytes_total{node="orbit"})"), 8 * 20 * 9 * 8);
  EXPECT_GT(orbit.value(R"(dmise_node_seconds_total{node="orbit",part="waiting"})"), 0);

  const MetricsPage broker = page_with(*run.broker, "dmise_broker_refused_messages_total", 0);
  EXPECT_GT(broker.value("dmise_broker_messages_total"), 8);
}

/// Debian's promtool, where the set-up of tests has put it; "" if nowhere.
std::string promtool() {
  const std::string own = DMISE_SOURCE_DIR "/build/tools/promtool";
  return std::filesystem::exists(own) ? own : "";
}

TEST(Metrics, FollowTheConventionsOfPrometheus) {
  if (promtool().empty() && std::getenv("DMISE_DATA")) FAIL() << "no promtool in build/tools";
  HeldRun run;
  ASSERT_TRUE(run.held());
  for (Child* process : {run.master.get(), run.broker.get(), run.orbit.get(), run.camera.get()}) {
    const std::string answer = http_get(metrics_port(*process), "/metrics");
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr("Content-Type: text/plain"));
    const MetricsPage page(body_of(answer));
    EXPECT_THAT(lint(page), IsEmpty());
    EXPECT_EQ(page.families.at("dmise_build_info").samples.size(), 1u);
    if (promtool().empty()) continue;
    const std::string file = testing::TempDir() + "dmise-metrics-page.txt";
    write_file_whole(file, body_of(answer));
    const auto [code, complaints] = test::command_output(promtool() + " check metrics < " + file);
    EXPECT_EQ(code, 0) << complaints;
    EXPECT_EQ(complaints, "");
  }
}

TEST(Metrics, AreServedOnLoopbackAndNowhereUnlessAskedFor) {
  HeldRun run(std::vector<std::string>{});
  ASSERT_TRUE(run.held());
  EXPECT_EQ(run.master->output().find("metrics"), std::string::npos);
  EXPECT_EQ(metrics_address("auto").host, "127.0.0.1");
  EXPECT_EQ(metrics_address("9100").host, "127.0.0.1");
  EXPECT_EQ(metrics_address("9100").port, 9100);
  EXPECT_EQ(metrics_address("0.0.0.0:9100").host, "0.0.0.0");
  EXPECT_EQ(metrics_address("[::1]:9100").host, "::1");
}

TEST(Metrics, OfNoUsableAddressAreOneLine) {
  for (const std::string wrong : {"0", "65536", "port", ":80", "9100x", "::1:80"}) {
    Child master({bin + "dmise-time-master", "--expect", "a", "--metrics", wrong});
    EXPECT_EQ(master.exit_code(), 2) << wrong;
    EXPECT_THAT(
        master.output(),
        HasSubstr("metrics: must be auto, PORT or HOST:PORT with a port of 1 to 65535, got " +
                  wrong));
  }
  Child first({bin + "dmise-time-master", "--expect", "a", "--metrics", "auto"});
  const std::string port = std::to_string(metrics_port(first));
  Child second({bin + "dmise-time-master", "--expect", "a", "--metrics", port});
  EXPECT_EQ(second.exit_code(), 1);
  EXPECT_THAT(second.output(), HasSubstr("metrics: can't listen at 127.0.0.1:" + port));
}

TEST(JsonLog, IsAnObjectALineInEveryProcess) {
  HeldRun run({"--log-format", "json"});
  ASSERT_TRUE(run.held());
  run.camera->kill(SIGKILL);
  EXPECT_EQ(run.master->exit_code(), 1);
  bool joined = false, failed = false;
  for (Child* process : {run.master.get(), run.broker.get(), run.orbit.get()}) {
    EXPECT_EQ(process->exit_code(), 1);
    std::istringstream lines(process->output());
    int count = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("tcp://") || line.starts_with("step ")) continue;  // stdout
      const auto json = nlohmann::ordered_json::parse(line, nullptr, false);
      ASSERT_TRUE(json.is_object()) << line;
      std::vector<std::string> keys;
      for (const auto& [key, value] : json.items()) keys.push_back(key);
      EXPECT_THAT(keys, ElementsAre("time", "level", "node", "event", "text", "fields"));
      EXPECT_THAT(json["time"].get<std::string>(),
                  testing::MatchesRegex("20..-..-..T..:..:..\\.......Z"));
      joined = joined || (json["event"] == "node_joined" && json["fields"]["name"] == "a" &&
                          json["fields"]["incarnation"] == 1);
      failed = failed || (json["event"] == "run_failed" && json["level"] == "error" &&
                          json["node"] == "time-master");
      ++count;
    }
    EXPECT_GT(count, 0);
  }
  EXPECT_TRUE(joined);
  EXPECT_TRUE(failed);
}

TEST(JsonLog, KeepsALineWhateverTheText) {
  const std::string name = "a\"b\n\x01\xff";
  Child master(
      {bin + "dmise-time-master", "--expect", "a", "--log-format", "json", "--log-level", name});
  EXPECT_EQ(master.exit_code(), 2);
  const auto json = nlohmann::json::parse(master.output());
  EXPECT_EQ(json["level"], "error");
  EXPECT_THAT(json["text"].get<std::string>(), HasSubstr("got a\"b\n\x01\xEF\xBF\xBD"));
  Child wrong({bin + "dmise-time-master", "--expect", "a", "--log-format", "xml"});
  EXPECT_EQ(wrong.exit_code(), 2);
  EXPECT_THAT(wrong.output(), HasSubstr("log-format: must be text or json, got xml"));
}

}  // namespace
}  // namespace dmise
