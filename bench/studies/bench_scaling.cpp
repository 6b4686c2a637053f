#include "bench/studies/bench_scaling.h"

#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <vector>

#include "bench/children.h"
#include "bench/figure.h"
#include "bench/studies/cost_clock.h"
#include "bench/studies/field_watcher.h"
#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "nodes/environment/environment_actor.h"
#include "nodes/runtime/broker/broker.h"
#include "nodes/runtime/node/node.h"
#include "orbit-node/orbit_actor.h"
#include "time-master/master.h"

namespace dmise {
namespace {

constexpr int window_ticks = 4;
constexpr int max_sensors = 200;
constexpr std::size_t catalogue_objects = 18470;
constexpr double paced_ticks_per_s = 4.0;    // mostly the cost of heartbeats
constexpr double target_ticks_per_s = 25.0;  // wanted for the most sensors, with 18,470 objects
constexpr Tick warm_up = 8;                  // ticks before the first reading

struct {
  std::vector<int> sizes{2, 4, 8, 16, 32, 64, 128, 200};
  std::set<std::string> kinds{"barrier", "states", "fields", "paced"};
} scaling_options;

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

/// Takes readings before the steps of another participant.
class Read : public Participant {
 public:
  Read(std::unique_ptr<Participant> inner, Tick last_tick, Readings& readings)
      : inner_(std::move(inner)), last_tick_(last_tick), readings_(readings) {}
  std::string name() const override { return inner_->name(); }
  std::vector<std::string> produces() const override { return inner_->produces(); }
  std::vector<std::string> consumes() const override { return inner_->consumes(); }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override {
    if (tick == warm_up) readings_.take(0, tick);
    if (tick == last_tick_) readings_.take(1, tick);
    return inner_->step(tick, inputs);
  }

 private:
  std::unique_ptr<Participant> inner_;
  Tick last_tick_;
  Readings& readings_;
};

/// Publishes the states of `objects` objects every tick.
class Source : public Actor {
 public:
  explicit Source(std::size_t objects) : objects_(objects) {}
  std::string name() const override { return orbit_node; }
  std::vector<std::string> produces() const override { return {objects_topic}; }
  std::vector<Message> step(Tick tick, std::span<const Message>) override {
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
};

/// Receives the states and produces nothing.
class Listener : public Evaluator {
 public:
  explicit Listener(int index) : name_("sensor-" + std::to_string(index)) {}
  std::string name() const override { return name_; }
  std::vector<std::string> produces() const override { return {detection_prefix + name_}; }
  std::vector<std::string> consumes() const override { return {objects_topic}; }
  std::vector<Message> step(Tick, std::span<const Message>) override { return {}; }

 private:
  std::string name_;
};

/// The nodes of a run beside time-master and broker: the orbit node, perhaps the environment node,
/// then the sensors. `make` is called in the process of the node.
struct Cast {
  std::vector<std::string> names;
  std::function<std::unique_ptr<Participant>(std::size_t index)> make;
  Tick ticks = 0;
  SimTime tick_length = sim_seconds(1.0);
  double real_time = 0.0;  // simulated ticks per second; 0: as fast as possible
};

/// Sensors that do nothing but take part, in a run of `objects` published states.
Cast listeners(int sensors, std::size_t objects, Tick ticks, double real_time = 0.0) {
  Cast cast{.names = {orbit_node}, .ticks = ticks, .real_time = real_time};
  for (int i = 0; i < sensors; ++i) cast.names.push_back(Listener(i).name());
  cast.make = [objects](std::size_t index) -> std::unique_ptr<Participant> {
    if (index == 0) return std::make_unique<Source>(objects);
    return std::make_unique<Listener>(int(index) - 1);
  };
  return cast;
}

/// Telescopes that find what is in their field, with the actors of a run.
Cast telescopes(const Scenario& scenario, Tick ticks) {
  Cast cast{.names = {orbit_node, environment_node}, .ticks = ticks, .tick_length = scenario.tick};
  for (const auto& sensor : scenario.sensors) cast.names.push_back(sensor.name);
  cast.make = [&scenario, names = cast.names](std::size_t index) -> std::unique_ptr<Participant> {
    static Threads one(1);
    const Clock clock = make_clock(scenario);
    if (index == 0) return std::make_unique<OrbitActor>(scenario, clock, one);
    if (index == 1) return std::make_unique<EnvironmentActor>(scenario, clock);
    return make_field_watcher(scenario, names[index]);
  };
  return cast;
}

// Processes in the order of the readings.
enum : std::size_t { master, broker, orbit, after_orbit };

void measure(const Cast& cast, Readings& readings) {
  Children children(1 + int(cast.names.size()), [&](int index, const std::string& address) {
    if (index == 0) return run_broker({.master = address}).exit_code;
    std::unique_ptr<Participant> participant = cast.make(std::size_t(index) - 1);
    if (index == 1)
      participant = std::make_unique<Read>(std::move(participant), cast.ticks - 1, readings);
    return run_node(*participant, {.master = address, .join_within_s = 300}).exit_code;
  });
  MasterOptions options;
  options.run.window_ticks = window_ticks;
  options.run.pace.factor = cast.real_time;
  options.run.last_tick = cast.ticks - 1;
  options.tick_length = cast.tick_length;
  options.run.silent_after = std::chrono::seconds(120);
  options.run.start_within = std::chrono::seconds(300);
  options.run.expected = cast.names;
  readings.count = 0;
  readings.pids[readings.count++] = getpid();
  for (const pid_t pid : children.pids()) readings.pids[readings.count++] = pid;
  options.on_bound = [&](const std::string& address) { children.send(address); };
  const MasterResult result = run_master(options);
  if (result.exit_code != 0) throw Error(result.reason);
}

double ticks_per_s(const Readings& readings) {
  return readings.ticks_between() / (readings.wall_s[1] - readings.wall_s[0]);
}

void print(const std::string& what, int sensors, const Readings& readings, bool own_network,
           bool json) {
  const auto figure = [&](const std::string& name, double value, const char* unit) {
    print_figure({"scaling_" + what + "_" + name + "_" + std::to_string(sensors), value, unit},
                 json);
  };
  const std::size_t first_sensor = readings.count - std::size_t(sensors);
  double sensors_s = 0.0;
  for (std::size_t i = first_sensor; i < readings.count; ++i)
    sensors_s += readings.cpu_s_a_tick(i) / sensors;
  figure("ticks_per_s", ticks_per_s(readings), "1/s");
  figure("master_us", 1e6 * readings.cpu_s_a_tick(master), "us/tick");
  figure("broker_us", 1e6 * readings.cpu_s_a_tick(broker), "us/tick");
  figure("orbit_us", 1e6 * readings.cpu_s_a_tick(orbit), "us/tick");
  if (first_sensor > after_orbit)
    figure("environment_us", 1e6 * readings.cpu_s_a_tick(after_orbit), "us/tick");
  figure("sensor_us", 1e6 * sensors_s, "us/tick");
  if (own_network)
    figure("bytes", double(readings.bytes[1] - readings.bytes[0]) / readings.ticks_between(),
           "B/tick");
}

}  // namespace

void add_scaling_options(CLI::App& command) {
  command.add_option("--sensors", scaling_options.sizes, "numbers of sensors")
      ->check(CLI::Range(1, 240))
      ->delimiter(',');
  command
      .add_option("--kinds", scaling_options.kinds,
                  "barrier: empty states; states: 18,470 objects; "
                  "fields: telescopes that find objects themselves; paced: barrier at 4 ticks/s")
      ->check(CLI::IsMember(scaling_options.kinds))
      ->delimiter(',');
}

int bench_scaling(bool json) {
  spdlog::set_level(spdlog::level::err);
  const bool own_network = enter_own_network();
  const auto directory =
      std::filesystem::temp_directory_path() / ("dmise-scaling-" + std::to_string(getpid()));
  const auto run = [&](const std::string& kind, int sensors, const Cast& cast) {
    SharedReadings readings;
    measure(cast, readings.get());
    print(kind, sensors, readings.get(), own_network, json);
    return ticks_per_s(readings.get());
  };
  for (const int sensors : scaling_options.sizes) {
    std::fprintf(stderr, "scaling: %d sensor nodes\n", sensors);
    double empty_ticks_per_s = 0.0;
    if (scaling_options.kinds.contains("barrier"))
      empty_ticks_per_s =
          run("barrier", sensors, listeners(sensors, 0, warm_up + std::max(200, 20000 / sensors)));
    if (scaling_options.kinds.contains("states"))
      run("states", sensors,
          listeners(sensors, catalogue_objects, warm_up + std::max(24, 1600 / sensors)));
    if (scaling_options.kinds.contains("fields")) {
      const Tick ticks = warm_up + std::max(200, 2000 / sensors);
      const Scenario scenario = telescope_network(sensors, ticks - 1, directory);
      const double found = run("fields", sensors, telescopes(scenario, ticks));
      if (sensors == max_sensors)
        print_figure({"states_" + std::to_string(sensors) + "_ticks_per_s", found, "1/s",
                      "empty states [1/s]", empty_ticks_per_s, target_ticks_per_s},
                     json);
    }
    if (scaling_options.kinds.contains("paced"))
      run("paced", sensors, listeners(sensors, 0, warm_up + 20, paced_ticks_per_s));
  }
  std::filesystem::remove_all(directory);
  return 0;
}

}  // namespace dmise
