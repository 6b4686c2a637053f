#include "bench/bench_tick.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <vector>

#include "bench/bench_tick_hosts.h"
#include "bench/idle_nodes.h"
#include "core/base/error.h"
#include "core/base/files/json.h"
#include "nodes/runtime/node/node.h"
#include "nodes/runtime/process/log.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/security/security.h"
#include "nodes/runtime/transport/socket.h"
#include "time-master/master.h"

namespace dmise {
namespace {

constexpr int repeats = 5;
constexpr double target_ratio = 0.70;
constexpr double curve_target_ratio = 0.65;

struct Tock {
  std::int64_t tick;
  std::int64_t node;
};

/// Minimal CURVE: one key for the publisher, one for all subscribers, no allow-list.
struct BareKeys {
  char server_public[41] = "", server_secret[41] = "", client_public[41] = "",
       client_secret[41] = "";
  bool on = false;

  static BareKeys make() {
    BareKeys keys{.on = true};
    if (zmq_curve_keypair(keys.server_public, keys.server_secret) != 0 ||
        zmq_curve_keypair(keys.client_public, keys.client_secret) != 0)
      throw Error("this build of ZeroMQ has no CURVE");
    return keys;
  }
  void serve(zmq::socket_t& socket) const {
    if (!on) return;
    socket.set(zmq::sockopt::curve_server, 1);
    socket.set(zmq::sockopt::curve_secretkey, std::string(server_secret));
  }
  void call(zmq::socket_t& socket) const {
    if (!on) return;
    socket.set(zmq::sockopt::curve_serverkey, std::string(server_public));
    socket.set(zmq::sockopt::curve_publickey, std::string(client_public));
    socket.set(zmq::sockopt::curve_secretkey, std::string(client_secret));
  }
};

int bare_worker(int index, const std::string& line, const BareKeys& keys) {
  const auto blank = line.find(' ');
  zmq::context_t context(1);
  zmq::socket_t ticks(context, zmq::socket_type::sub), acks(context, zmq::socket_type::push);
  keys.call(ticks);
  keys.call(acks);
  ticks.set(zmq::sockopt::subscribe, "");
  ticks.connect(line.substr(0, blank));
  acks.connect(line.substr(blank + 1));
  for (std::int64_t last = -1;;) {
    Tock tock;
    (void)ticks.recv(zmq::buffer(&tock, sizeof tock));
    if (tock.tick < 0) return 0;
    if (tock.tick == last) continue;
    last = tock.tick;
    tock.node = index;
    acks.send(zmq::buffer(&tock, sizeof tock));
  }
}

/// Ticks per second of a bare publisher that waits for all answers before the next tick.
double floor_per_s(int nodes, int ticks, const BareKeys& keys = {}) {
  Children children(
      nodes, [&](int index, const std::string& line) { return bare_worker(index, line, keys); });
  zmq::context_t context(1);
  zmq::socket_t publisher(context, zmq::socket_type::pub), acks(context, zmq::socket_type::pull);
  keys.serve(publisher);
  keys.serve(acks);
  publisher.bind("tcp://127.0.0.1:*");
  acks.bind("tcp://127.0.0.1:*");
  children.send(publisher.get(zmq::sockopt::last_endpoint) + " " +
                acks.get(zmq::sockopt::last_endpoint));
  Tock tock{0, 0}, ack{};
  for (int ready = 0; ready < nodes;) {  // repeat tick 0 until all have connected
    publisher.send(zmq::buffer(&tock, sizeof tock));
    std::vector<zmq::pollitem_t> items{{acks.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, std::chrono::milliseconds(1));
    while (acks.recv(zmq::buffer(&ack, sizeof ack), zmq::recv_flags::dontwait)) ++ready;
  }
  const auto start = now();
  for (tock.tick = 1; tock.tick <= ticks; ++tock.tick) {
    publisher.send(zmq::buffer(&tock, sizeof tock));
    for (int i = 0; i < nodes; ++i) (void)acks.recv(zmq::buffer(&ack, sizeof ack));
  }
  const double elapsed_s = std::chrono::duration<double>(now() - start).count();
  tock.tick = -1;
  publisher.send(zmq::buffer(&tock, sizeof tock));
  return ticks / elapsed_s;
}

/// Ticks per second of the time-master with idle nodes.
double ours_per_s(int nodes, int ticks, const std::string& keys = "") {
  Children children(nodes, [&](int index, const std::string& line) {
    Idle idle(index);
    return run_node(idle, {.master = line, .keys = keys}).exit_code;
  });
  MasterOptions options;
  options.keys = keys;
  options.with_broker = false;
  for (int i = 0; i < nodes; ++i) options.run.expected.push_back(Idle(i).name());
  options.run.last_tick = ticks - 1;
  options.on_bound = [&](const std::string& address) { children.send(address); };
  const MasterResult result = run_master(options);
  if (result.exit_code != 0) throw Error(result.reason);
  return ticks / result.wall_s;
}

/// A temporary directory of keys for the time-master and its nodes.
class KeyDirectory {
 public:
  explicit KeyDirectory(int nodes) {
    std::string path = std::filesystem::temp_directory_path() / "dmise-bench-XXXXXX";
    if (!mkdtemp(path.data())) throw Error(path + ": can't be created");
    path_ = path;
    make_key(path_, master_name, false);
    for (int i = 0; i < nodes; ++i) make_key(path_, Idle(i).name(), false);
  }
  ~KeyDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct TickFigure {
  std::string name;
  double value = 0.0;
  std::string unit;
  std::string anchor;
  double anchor_value = 0.0;
  double target = 0.0;  // for value / anchor_value; 0: none
};

void print(const TickFigure& figure, bool json) {
  const double ratio = figure.anchor_value > 0 ? figure.value / figure.anchor_value : 0.0;
  const bool met = ratio >= figure.target;
  if (!json) {
    std::printf("%-18s %10.2f %-8s", figure.name.c_str(), figure.value, figure.unit.c_str());
    if (figure.target > 0) std::printf("  %s %.2f", met ? "reaches" : "misses", figure.target);
    std::printf("\n");
    return;
  }
  JsonWriter writer;
  writer.begin_object().field("name", figure.name).field("value", figure.value);
  writer.field("unit", figure.unit);
  writer.key("anchor");
  figure.anchor.empty() ? writer.null() : writer.value(figure.anchor);
  for (const auto& [key, value] : {std::pair("anchor_value", figure.anchor_value),
                                   std::pair("ratio", ratio), std::pair("target", figure.target)}) {
    writer.key(key);
    value > 0 ? writer.value(value) : writer.null();
  }
  writer.key("met");
  figure.target > 0 ? writer.value(met) : writer.null();
  writer.end_object();
  std::printf("%s\n", writer.text().c_str());
}

}  // namespace

int bench_tick(bool json) {
  spdlog::set_level(spdlog::level::err);
  for (const int nodes : {2, 4, 8, 16}) {
    const int ticks = 24000 / nodes;
    std::vector<double> floors, ours, ratios;
    for (int i = 0; i < repeats; ++i) {  // interleaved, for equal conditions
      floors.push_back(floor_per_s(nodes, ticks));
      ours.push_back(ours_per_s(nodes, ticks));
      ratios.push_back(ours.back() / floors.back());
    }
    const std::string count = std::to_string(nodes);
    const std::string anchor = "bare ZeroMQ PUB + PUSH, tcp";
    print({"floor_" + count + "_per_s", median(floors), "ticks/s", "", 0, 0}, json);
    print({"ticks_" + count + "_per_s", median(ours), "ticks/s", anchor, median(floors), 0}, json);
    print({"ratio_" + count, median(ratios), "1", anchor, 1.0, nodes == 16 ? target_ratio : 0},
          json);
    std::fflush(stdout);
  }
  constexpr int nodes = 16;
  const BareKeys bare_keys = BareKeys::make();
  const KeyDirectory keys(nodes);
  std::vector<double> ours, floors, ratios;
  for (int i = 0; i < repeats; ++i) {
    floors.push_back(floor_per_s(nodes, 24000 / nodes, bare_keys));
    ours.push_back(ours_per_s(nodes, 24000 / nodes, keys.path()));
    ratios.push_back(ours.back() / floors.back());
  }
  const std::string anchor = "bare ZeroMQ PUB + PUSH, tcp, CURVE";
  print({"curve_ticks_16_per_s", median(ours), "ticks/s", anchor, median(floors), 0}, json);
  print({"curve_ratio_16", median(ratios), "1", anchor, 1.0, curve_target_ratio}, json);
  bench_tick_hosts(json);
  return 0;
}

}  // namespace dmise
