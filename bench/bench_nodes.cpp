#include "bench/bench_nodes.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bench/children.h"
#include "bench/figure.h"
#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/instant.h"
#include "core/base/numeric/quantile.h"
#include "core/base/sim_time.h"
#include "core/sim/message.h"
#include "core/sim/participant.h"
#include "core/sim/state.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/process/last_line.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/process/spawn.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr int repeats = 3;
constexpr auto look_every = std::chrono::milliseconds(20);

/// Objects on circles. It notes when it was asked for a tenth of the ticks, and for the last one.
constexpr const char* program = R"(import math, time
import dmise, numpy as np

RADIUS_M, RATE = 7.0e6, 1.078e-3


@dmise.actor()
class Circles:
    def __call__(self, t_s, world, options):
        if world.tick == options["ticks"] // 10:
            self.begun_s = time.monotonic()
        if world.tick == options["ticks"]:
            with open(options["seconds"], "w") as file:
                file.write(f"{time.monotonic() - self.begun_s}\n")
        return one(RATE * t_s) if len(world.objects) == 1 else many(RATE * t_s + np.arange(len(world.objects)))


def one(u):
    return dmise.State(position_m=[RADIUS_M * math.cos(u), 0, RADIUS_M * math.sin(u)],
                       velocity_m_per_s=[-RADIUS_M * RATE * math.sin(u), 0, RADIUS_M * RATE * math.cos(u)])


def many(u):
    x, z, zero = RADIUS_M * np.cos(u), RADIUS_M * np.sin(u), np.zeros(len(u))
    return dmise.State(position_m=np.array([x, zero, z]), velocity_m_per_s=RATE * np.array([-z, zero, x]))


dmise.serve(Circles)
)";

struct NodesCase {
  int nodes = 1;
  int objects = 1;  // for each node
  Tick ticks = 0;
  bool python = true;  // else nodes that do nothing join
};

std::string node_name(int index) { return "node-" + std::to_string(index); }

/// What an actor in Python costs without Python: a state that is there, published.
class Still : public Actor {
 public:
  Still(int index, Tick ticks, std::string seconds)
      : name_(node_name(index)), ticks_(ticks), seconds_(std::move(seconds)) {}
  std::string name() const override { return name_; }
  std::vector<std::string> produces() const override { return {actor_prefix + name_}; }
  std::vector<Message> step(Tick tick, std::span<const Message>) override {
    if (tick == ticks_ / 10) begun_ = now();
    if (tick == ticks_) std::ofstream(seconds_) << to_seconds(now() - begun_) << "\n";
    ObjectStates state{.tick = tick, .time = sim_seconds(double(tick)), .count = 1};
    state.position_m = {7.0e6, 0, 0};
    state.slope_m_per_s = state.velocity_m_per_s = {0, 0, 0};
    state.code = {0};
    return {{actor_prefix + name_, tick, std::make_shared<State>(std::move(state))}};
  }

 private:
  std::string name_;
  Tick ticks_;
  std::string seconds_;
  Instant begun_{};
};

/// Environment of a Python that finds the package of this build, where there is one.
std::vector<std::string> python_environment() {
  const fs::path package =
      fs::read_symlink("/proc/self/exe").parent_path().parent_path().parent_path() / "python";
  const char* before = std::getenv("PYTHONPATH");
  if (!fs::is_directory(package / "dmise")) return {};
  return {"PYTHONPATH=" + package.string() + (before ? std::string(":") + before : "")};
}

/// The first python3 of the PATH that has the package.
std::string python_with_dmise(const fs::path& directory) {
  std::istringstream places(std::getenv("PATH") ? std::getenv("PATH") : "");
  for (std::string place; std::getline(places, place, ':');) {
    const std::string python = place + "/python3";
    if (access(python.c_str(), X_OK) != 0) continue;
    const pid_t pid = spawn({.name = "python3",
                             .arguments = {python, "-c", "from dmise import serve"},
                             .log_path = directory / "python.log",
                             .environment = python_environment()});
    int status = 0;
    if (waitpid(pid, &status, 0) == pid && status == 0) return python;
  }
  throw Error("nodes: no python3 of the PATH can import dmise");
}

fs::path seconds_file(const fs::path& directory, int node) {
  return directory / (node_name(node) + ".seconds");
}

void write_scenario(const NodesCase& nodes, const std::string& python, const fs::path& directory) {
  std::ofstream(directory / "circles.py") << program;
  std::ofstream text(directory / "nodes.yaml");
  text << "simulation: {start: 2018-01-21T00:15:00Z, duration_s: " << nodes.ticks
       << ", tick_s: 1}\nnodes:\n";
  for (int i = 0; i < nodes.nodes; ++i) {
    text << "  - {name: " << node_name(i) << ", ";
    if (nodes.python)
      text << "run: [" << python << ", circles.py], options: {ticks: " << nodes.ticks
           << ", seconds: " << seconds_file(directory, i) << "}}\n";
    else
      text << "elsewhere: on}\n";
  }
  text << "objects:\n";
  for (int i = 0; i < nodes.nodes; ++i)
    for (int k = 0; k < nodes.objects; ++k)
      text << "  - {name: object-" << i << "-" << k << ", motion: {node: " << node_name(i)
           << "}, radius_m: 0.3}\n";
  text << "sensors: [{name: eye, site: {latitude_deg: 0, longitude_deg: 0, height_m: 0}, camera: "
          "star-tracker, pointing: zenith, exposure_s: 0.1, cadence_s: "
       << nodes.ticks << ", sky: dark}]\ndetection: off\nnetwork: {join_within_s: 120, "
       << "silent_after_s: 60}\noutput: {fits: false, png: false, truth: false}\n";
}

pid_t start(const std::string& command, const fs::path& directory) {
  const std::string dmise = fs::read_symlink("/proc/self/exe").parent_path() / "dmise";
  return spawn({.name = "dmise " + command,
                .arguments = {dmise, command, directory / "nodes.yaml", "--allow-programs", "--out",
                              directory / "run", "--force"},
                .log_path = directory / "dmise.log",
                .environment = python_environment()});
}

bool is_over(pid_t pid, const fs::path& directory) {
  int status = 0;
  if (waitpid(pid, &status, WNOHANG) == 0) return false;
  if (status != 0) throw Error("nodes: " + last_line(directory / "dmise.log"));
  return true;
}

/// Address of the time-master of a launched run, as soon as it is there.
std::string master_address(pid_t launcher, const fs::path& directory) {
  const fs::path file = directory / "run/logs/master.address";
  while (!fs::exists(file)) {
    if (is_over(launcher, directory)) throw Error("nodes: the run has no time-master");
    std::this_thread::sleep_for(look_every);
  }
  std::string address = read_text_file(file);
  return address.substr(0, address.find('\n'));
}

double ticks_per_s(const NodesCase& nodes, const fs::path& directory) {
  double sum_s = 0.0;
  for (int i = 0; i < nodes.nodes; ++i)
    sum_s += std::strtod(read_text_file(seconds_file(directory, i)).c_str(), nullptr);
  return double(nodes.ticks - nodes.ticks / 10) * nodes.nodes / sum_s;
}

void run_to_end(const NodesCase& nodes, const std::string& command, const fs::path& directory) {
  Children still(nodes.python ? 0 : nodes.nodes, [&](int index, const std::string& master) {
    Still node(index, nodes.ticks, seconds_file(directory, index));
    return run_node(node, {.master = master}).exit_code;
  });
  const pid_t pid = start(command, directory);
  if (!nodes.python) still.send(master_address(pid, directory));
  while (!is_over(pid, directory)) std::this_thread::sleep_for(look_every);
}

/// Ticks per second of a run, between a tenth of it and its end.
double measure(const NodesCase& nodes, const std::string& command, const std::string& python,
               const fs::path& directory) {
  fs::remove_all(directory / "run");
  write_scenario(nodes, python, directory);
  run_to_end(nodes, command, directory);
  return ticks_per_s(nodes, directory);
}

}  // namespace

int bench_nodes(bool json) {
  const fs::path directory =
      fs::temp_directory_path() / ("dmise-bench-nodes-" + std::to_string(getpid()));
  fs::create_directories(directory);
  const std::string python = python_with_dmise(directory);
  const auto rate = [&](const NodesCase& nodes, const std::string& command) {
    return measure(nodes, command, python, directory);
  };
  std::vector<double> one, many;
  for (int i = 0; i < repeats; ++i) {
    one.push_back(rate({.ticks = 3000}, "run"));
    many.push_back(rate({.objects = 20'000, .ticks = 100}, "run"));
  }
  print_figure({"python_actor_ticks_per_s", median_of(one), "ticks/s", "", 0, 300}, json);
  print_figure({"python_actor_20000_ticks_per_s", median_of(many), "ticks/s", "", 0, 15}, json);
  const NodesCase sixteen{.nodes = 16, .ticks = 2000},
      still{.nodes = 16, .ticks = 2000, .python = false};
  std::vector<double> pythons, stills, ratios;
  for (int i = 0; i < repeats; ++i) {  // interleaved, for equal conditions
    pythons.push_back(rate(sixteen, "launch"));
    stills.push_back(rate(still, "launch"));
    ratios.push_back(pythons.back() / stills.back());
  }
  const std::string anchor = "16 nodes that do nothing";
  print_figure({"nodes_16_ticks_per_s", median_of(pythons), "ticks/s", anchor, median_of(stills)},
               json);
  print_figure({"nodes_16_ratio", median_of(ratios), "1", anchor, 1.0, 0.5}, json);
  fs::remove_all(directory);
  return 0;
}

}  // namespace dmise
