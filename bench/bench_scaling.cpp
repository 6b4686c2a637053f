#include "bench/bench_scaling.h"

#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "bench/children.h"
#include "bench/cost_clock.h"
#include "bench/figure.h"
#include "core/base/error.h"
#include "nodes/runtime/broker/broker.h"
#include "nodes/runtime/node/node.h"
#include "time-master/master.h"

namespace dmise {
namespace {

constexpr int sizes[] = {2, 4, 8, 16, 32, 64, 128, 200};
constexpr int window_ticks = 4;
constexpr std::size_t catalogue_objects = 18470;
constexpr double paced_ticks_per_s = 4.0;  // mostly the cost of heartbeats
constexpr Tick warm_up = 8;                // ticks before the first reading

/// Two readings of the costs of all processes, in shared memory.
struct Readings {
  static constexpr std::size_t most = 256;
  pid_t pids[most]{};
  std::size_t count = 0;
  double wall_s[2]{}, cpu_s[2][most]{};
  std::int64_t bytes[2]{};
  Tick ticks[2]{};

  void take(int which, Tick tick) {
    const CostReading now = read_costs({pids, pids + count});
    wall_s[which] = now.wall_s;
    bytes[which] = now.loopback_bytes;
    ticks[which] = tick;
    std::copy(now.cpu_s.begin(), now.cpu_s.end(), cpu_s[which]);
  }
  double ticks_between() const { return double(ticks[1] - ticks[0]); }
  double cpu_s_a_tick(std::size_t process) const {
    return (cpu_s[1][process] - cpu_s[0][process]) / ticks_between();
  }
};

/// Memory shared with forked processes.
class SharedReadings {
 public:
  SharedReadings()
      : at_(mmap(nullptr, sizeof(Readings), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1,
                 0)) {
    if (at_ == MAP_FAILED) throw Error("scaling: no memory to share");
    new (at_) Readings;
  }
  ~SharedReadings() { munmap(at_, sizeof(Readings)); }
  Readings& get() { return *static_cast<Readings*>(at_); }

 private:
  void* at_;
};

/// Publishes the states of `objects` objects every tick, and reads the costs of all processes.
class Source : public Participant {
 public:
  Source(std::size_t objects, Tick last_tick, Readings& readings)
      : objects_(objects), last_tick_(last_tick), readings_(readings) {}
  std::string name() const override { return "orbit-node"; }
  std::vector<std::string> produces() const override { return {objects_topic}; }
  std::vector<std::string> consumes() const override { return {}; }
  std::vector<Message> step(Tick tick, std::span<const Message>) override {
    if (tick == warm_up) readings_.take(0, tick);
    if (tick == last_tick_) readings_.take(1, tick);
    ObjectStates states;
    states.tick = tick;
    states.time = {tick * 1'000'000'000};
    states.count = objects_;
    for (auto* array : {&states.position_m, &states.slope_m_per_s, &states.velocity_m_per_s})
      array->assign(3 * objects_, double(tick));
    states.code.assign(objects_, 0);
    return {{objects_topic, tick, std::make_shared<const State>(std::move(states))}};
  }

 private:
  std::size_t objects_;
  Tick last_tick_;
  Readings& readings_;
};

/// Receives the states and produces nothing.
class Listener : public Participant {
 public:
  explicit Listener(int index) : name_("sensor-" + std::to_string(index)) {}
  std::string name() const override { return name_; }
  std::vector<std::string> produces() const override { return {detection_prefix + name_}; }
  std::vector<std::string> consumes() const override { return {objects_topic}; }
  std::vector<Message> step(Tick, std::span<const Message>) override { return {}; }

 private:
  std::string name_;
};

// Processes in the order of the readings.
enum : std::size_t { master, broker, orbit, first_sensor };

/// `real_time`: simulated seconds (ticks) per second; 0: as fast as possible.
void measure(int sensors, std::size_t objects, Tick ticks, double real_time, Readings& readings) {
  const int others = 2;
  Children children(others + sensors, [&](int index, const std::string& address) {
    if (index == 0) return run_broker({.master = address}).exit_code;
    if (index == 1) {
      Source source(objects, ticks - 1, readings);
      return run_node(source, {.master = address, .join_within_s = 120}).exit_code;
    }
    Listener listener(index - others);
    return run_node(listener, {.master = address, .join_within_s = 120}).exit_code;
  });
  MasterOptions options;
  options.run.window_ticks = window_ticks;
  options.run.pace.factor = real_time;
  options.run.last_tick = ticks - 1;
  options.run.silent_after = std::chrono::seconds(120);
  options.run.start_within = std::chrono::seconds(300);
  options.run.expected.push_back("orbit-node");
  for (int i = 0; i < sensors; ++i) options.run.expected.push_back(Listener(i).name());
  readings.count = 0;
  readings.pids[readings.count++] = getpid();
  for (const pid_t pid : children.pids()) readings.pids[readings.count++] = pid;
  options.on_bound = [&](const std::string& address) { children.send(address); };
  const MasterResult result = run_master(options);
  if (result.exit_code != 0) throw Error(result.reason);
}

void print(const std::string& what, int sensors, const Readings& readings, bool own_network,
           bool json) {
  const auto figure = [&](const std::string& name, double value, const char* unit) {
    print_figure({"scaling_" + what + "_" + name + "_" + std::to_string(sensors), value, unit},
                 json);
  };
  const double wall_s = readings.wall_s[1] - readings.wall_s[0];
  double sensors_s = 0.0;
  for (std::size_t i = first_sensor; i < readings.count; ++i)
    sensors_s += readings.cpu_s_a_tick(i) / sensors;
  figure("ticks_per_s", readings.ticks_between() / wall_s, "1/s");
  figure("master_us", 1e6 * readings.cpu_s_a_tick(master), "us/tick");
  figure("broker_us", 1e6 * readings.cpu_s_a_tick(broker), "us/tick");
  figure("orbit_us", 1e6 * readings.cpu_s_a_tick(orbit), "us/tick");
  figure("sensor_us", 1e6 * sensors_s, "us/tick");
  if (own_network)
    figure("bytes", double(readings.bytes[1] - readings.bytes[0]) / readings.ticks_between(),
           "B/tick");
}

}  // namespace

int bench_scaling(bool json) {
  spdlog::set_level(spdlog::level::err);
  const bool own_network = enter_own_network();
  for (const int sensors : sizes) {
    std::fprintf(stderr, "scaling: %d sensor nodes\n", sensors);
    SharedReadings barrier, states, pace;
    measure(sensors, 0, warm_up + std::max(200, 20000 / sensors), 0.0, barrier.get());
    print("barrier", sensors, barrier.get(), own_network, json);
    measure(sensors, catalogue_objects, warm_up + std::max(24, 1600 / sensors), 0.0, states.get());
    print("states", sensors, states.get(), own_network, json);
    measure(sensors, 0, warm_up + 20, paced_ticks_per_s, pace.get());
    print("paced", sensors, pace.get(), own_network, json);
  }
  return 0;
}

}  // namespace dmise
