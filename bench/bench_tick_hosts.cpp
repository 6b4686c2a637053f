#include "bench/bench_tick_hosts.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>

#include "bench/figure.h"
#include "bench/idle_nodes.h"
#include "nodes/agent/host_agent.h"
#include "nodes/runtime/node/node.h"
#include "time-master/master.h"

namespace dmise {
namespace {

constexpr int host_repeats = 3;

struct Cost {
  double messages = 0.0;   // received by the master per tick
  double master_us = 0.0;  // processor time per tick
  double agent_us = 0.0;   // one agent's, per node and tick
  double ticks_per_s = 0.0;
};

/// Results of child processes, in shared memory.
class Shared {
 public:
  explicit Shared(std::size_t count)
      : bytes_(std::max<std::size_t>(count, 1) * sizeof(double)),
        values_(static_cast<double*>(
            mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))) {
    if (values_ == MAP_FAILED) throw std::bad_alloc();
  }
  ~Shared() { munmap(values_, bytes_); }
  double& operator[](std::size_t i) { return values_[i]; }

 private:
  std::size_t bytes_;
  double* values_;
};

std::string address_of(int host) {
  return "ipc://@dmise-bench-" + std::to_string(getpid()) + "-" + std::to_string(host);
}

/// `hosts` 0: nodes connect to the time-master directly.
Cost cost_of_tick(int nodes, int hosts, int ticks) {
  std::vector<std::string> addresses;
  for (int host = 0; host < hosts; ++host) addresses.push_back(address_of(host));
  Shared agent_s{std::size_t(hosts)};
  MasterResult result;
  {
    Children children(hosts + nodes, [&](int index, const std::string& master) {
      if (index < hosts) {
        const HostAgentResult agent = run_host_agent({.name = "host-" + std::to_string(index + 1),
                                                      .master = master,
                                                      .bind = addresses[std::size_t(index)]});
        agent_s[std::size_t(index)] = agent.cpu_s;
        return agent.exit_code;
      }
      Idle idle(index - hosts);
      const std::string& own = hosts > 0 ? addresses[std::size_t((index - hosts) % hosts)] : master;
      return run_node(idle, {.master = own}).exit_code;
    });
    MasterOptions options;
    options.with_broker = false;
    for (int i = 0; i < nodes; ++i) options.run.expected.push_back(Idle(i).name());
    options.run.last_tick = ticks - 1;
    options.run.silent_after = std::chrono::seconds(60);  // on a loaded machine
    options.on_bound = [&](const std::string& address) { children.send(address); };
    result = run_master(options);
  }
  if (result.exit_code != 0) throw Error(result.reason);
  Cost cost{.messages = double(result.messages) / ticks,
            .master_us = 1e6 * result.cpu_s / ticks,
            .ticks_per_s = ticks / result.wall_s};
  for (int host = 0; host < hosts; ++host)
    cost.agent_us += 1e6 * agent_s[std::size_t(host)] / ticks / nodes;
  return cost;
}

/// Medians of several runs.
Cost median_cost(int nodes, int hosts, int ticks) {
  std::vector<Cost> costs;
  for (int i = 0; i < host_repeats; ++i) costs.push_back(cost_of_tick(nodes, hosts, ticks));
  Cost median;
  for (double Cost::*figure :
       {&Cost::messages, &Cost::master_us, &Cost::agent_us, &Cost::ticks_per_s}) {
    std::sort(costs.begin(), costs.end(),
              [&](const Cost& a, const Cost& b) { return a.*figure < b.*figure; });
    median.*figure = costs[host_repeats / 2].*figure;
  }
  return median;
}

}  // namespace

void bench_tick_hosts(bool json) {
  for (const auto& [nodes, hosts] : {std::pair(16, 4), std::pair(64, 4), std::pair(200, 8)}) {
    const int ticks = std::max(200, 16000 / nodes);
    const Cost flat = median_cost(nodes, 0, ticks), agents = median_cost(nodes, hosts, ticks);
    const std::string count = "_" + std::to_string(nodes);
    const std::string anchor = "without agents; here " + std::to_string(hosts) + " of them";
    print_figure({.name = "master_messages_per_tick" + count,
                  .value = agents.messages,
                  .unit = "1",
                  .anchor = anchor,
                  .anchor_value = flat.messages,
                  .less_is_better = true},
                 json);
    print_figure({.name = "master_cpu_us_per_tick" + count,
                  .value = agents.master_us,
                  .unit = "us",
                  .anchor = anchor,
                  .anchor_value = flat.master_us,
                  .less_is_better = true},
                 json);
    print_figure({.name = "agents_ticks" + count + "_per_s",
                  .value = agents.ticks_per_s,
                  .unit = "ticks/s",
                  .anchor = anchor,
                  .anchor_value = flat.ticks_per_s},
                 json);
    print_figure(
        {.name = "agent_cpu_us_per_node_tick" + count, .value = agents.agent_us, .unit = "us"},
        json);
  }
}

}  // namespace dmise
