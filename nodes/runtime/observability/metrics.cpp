#include "nodes/runtime/observability/metrics.h"

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/sim/run_phase.h"
#include "nodes/runtime/observability/figures.h"
#include "nodes/runtime/observability/metrics_server.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/process/process_memory.h"
#include "nodes/runtime/process/seconds.h"

namespace dmise {
namespace {

// Values as families of metrics. Names follow Prometheus's conventions: base units at the end of
// the name, and _total for counters. docs/operations.md lists them.
using MetricFamilies = std::vector<prometheus::MetricFamily>;

using prometheus::MetricType;
using Labels = std::vector<prometheus::ClientMetric::Label>;

/// Collects samples; samples of one name must be consecutive.
class Builder {
 public:
  void gauge(const char* name, const char* help, auto value, Labels labels = {}) {
    sample(MetricType::Gauge, name, help, std::move(labels)).gauge.value = double(value);
  }
  void counter(const char* name, const char* help, auto value, Labels labels = {}) {
    sample(MetricType::Counter, name, help, std::move(labels)).counter.value = double(value);
  }
  MetricFamilies take() { return std::move(families_); }

 private:
  prometheus::ClientMetric& sample(MetricType type, const char* name, const char* help,
                                   Labels labels) {
    auto family = std::ranges::find(families_, name, &prometheus::MetricFamily::name);
    if (family == families_.end())
      family = families_.insert(families_.end(), {name, help, type, {}});
    family->metric.emplace_back().label = std::move(labels);
    return family->metric.back();
  }
  MetricFamilies families_;
};

void add_times(Builder& b, const char* name, const char* help, const TimeSplit& times,
               const std::string& node) {
  b.counter(name, help, times.compute_s, {{"node", node}, {"part", "compute"}});
  b.counter(name, help, times.messaging_s, {{"node", node}, {"part", "messaging"}});
  b.counter(name, help, times.waiting_s, {{"node", node}, {"part", "waiting"}});
}

void add_node(Builder& b, const NodeStatus& node, const RunStatus& status) {
  const Labels of{{"node", node.name}};
  const bool holds = std::ranges::find(status.holding, node.name) != status.holding.end();
  b.gauge("dmise_clock_node_up", "1 while the time-master receives the node's heartbeats.",
          node.alive, of);
  b.gauge("dmise_clock_held", "1 while the clock waits for the node.", holds, of);
  b.gauge("dmise_clock_node_done_tick", "Last tick that the node has done; -1 before the first.",
          node.done, of);
  b.counter("dmise_clock_node_restarts_total", "Processes of the node after its first.",
            node.incarnation - 1, of);
  b.counter("dmise_clock_node_frames_total", "Frames published, as last reported by the node.",
            node.times.frames, of);
  b.counter("dmise_clock_node_detections_total",
            "Detections published, as last reported by the node.", node.times.detections, of);
  add_times(b, "dmise_clock_node_seconds_total",
            "Time of the node by activity, as last reported by it.", node.times, node.name);
}

MetricFamilies families_of_build(const std::string& program, const std::string& node) {
  Builder b;
  b.gauge("dmise_build_info", "Always 1; labels identify the program.", 1,
          {{"version", DMISE_VERSION}, {"program", program}, {"node", node}});
  return b.take();
}

/// Resource usage of this process. `started_s`: when it started, seconds since 1970.
MetricFamilies families_of_process(double started_s) {
  std::error_code ignored;
  int open_files = 0;
  for (std::filesystem::directory_iterator file("/proc/self/fd", ignored), end; file != end;
       file.increment(ignored))
    ++open_files;
  Builder b;
  b.counter("process_cpu_seconds_total", "User and system time spent.", process_cpu_s());
  b.gauge("process_resident_memory_bytes", "Memory in use.", process_memory().resident_bytes);
  b.gauge("process_open_fds", "Open file descriptors.", open_files);
  b.gauge("process_start_time_seconds", "Start time of the process since 1970.", started_s);
  return b.take();
}

/// `node`: name of the process in the run, a label where there may be several of its kind.
MetricFamilies families_of(const NodeFigures& f, const std::string& node) {
  Builder b;
  const Labels of{{"node", node}};
  b.counter("dmise_node_ticks_total", "Ticks that this process has worked on.", f.ticks, of);
  b.gauge("dmise_node_done_tick", "Last tick done; -1 before the first.", f.done, of);
  b.gauge("dmise_node_granted_tick", "Last tick that the clock allows; -1 before the start.",
          f.granted, of);
  b.gauge("dmise_node_computing", "1 inside a step.", f.computing, of);
  b.gauge("dmise_node_incarnation", "Processes of this name so far, this one included.",
          f.incarnation, of);
  add_times(b, "dmise_node_seconds_total", "Time of this process by activity.", f.times, node);
  b.counter("dmise_node_frames_total", "Frames published.", f.times.frames, of);
  b.counter("dmise_node_detections_total", "Detections published.", f.times.detections, of);
  b.counter("dmise_node_sent_messages_total", "Messages published.", f.sent, of);
  b.counter("dmise_node_sent_bytes_total", "Bytes of all messages published.", f.sent_bytes, of);
  b.counter("dmise_node_received_messages_total", "Messages received that passed every check.",
            f.received, of);
  for (std::size_t i = 0; i < f.refused.size(); ++i)
    b.counter("dmise_node_refused_messages_total", "Messages received that failed a check.",
              f.refused[i], {{"node", node}, {"reason", std::string(name(Refusal(i)))}});
  b.counter("dmise_node_resend_requests_total", "Requests for missing messages.", f.resend_requests,
            of);
  b.counter("dmise_node_missed_messages_total", "Messages no longer available; of an observer.",
            f.missed, of);
  b.gauge("dmise_node_queued_messages", "Messages received but not yet used.", f.queued, of);
  return b.take();
}

MetricFamilies families_of(const FrameFigures& f, const std::string& node) {
  Builder b;
  for (const auto& [stage, time] : f.stages) {
    const Labels of{{"node", node}, {"stage", stage}};
    b.counter("dmise_sensor_stage_seconds_total", "Time of a stage of all frames.", time.measured_s,
              of);
    b.counter("dmise_sensor_stage_predicted_seconds_total",
              "What the plans of the same frames have predicted for this machine.",
              time.predicted_s, of);
  }
  return b.take();
}

MetricFamilies families_of(const BrokerFigures& f, const std::string&) {
  Builder b;
  b.counter("dmise_broker_messages_total", "Messages forwarded.", f.messages);
  b.counter("dmise_broker_refused_messages_total",
            "Messages under another name than their sender's.", f.refused);
  return b.take();
}

MetricFamilies families_of(const RunStatus& s, const std::string&) {
  Builder b;
  for (const Phase phase :
       {Phase::gathering, Phase::connecting, Phase::running, Phase::ended, Phase::failed})
    b.gauge("dmise_clock_phase", "1 for the phase of the run.", phase == s.phase,
            {{"phase", phase_name(phase)}});
  b.gauge("dmise_clock_granted_tick", "Last tick that nodes may work on; -1 before the start.",
          s.granted);
  b.gauge("dmise_clock_settled_tick", "Last tick that all have done; -1 before the first.",
          s.settled);
  b.gauge("dmise_clock_last_tick", "Last tick of the run.", s.last_tick);
  b.gauge("dmise_clock_tick_seconds", "Simulated length of a tick.", s.tick_length.seconds());
  b.gauge("dmise_clock_paused", "1 while the clock is paused on request.", s.paused);
  b.gauge("dmise_clock_missing_nodes", "Expected nodes that have not joined.", s.missing.size());
  b.counter("dmise_clock_overruns_total", "Ticks not done when real time reached the next.",
            s.overruns);
  b.gauge("dmise_clock_worst_lag_seconds", "Largest delay behind real time.", s.worst_lag_s);
  for (const NodeStatus& node : s.nodes) add_node(b, node, s);
  return b.take();
}

std::atomic<Metrics*> metrics_of_process{nullptr};

void append(MetricFamilies* all, MetricFamilies more) {
  std::move(more.begin(), more.end(), std::back_inserter(*all));
}

}  // namespace

HostPort metrics_address(const std::string& text) {
  if (text == "auto") return {};
  const bool alone = text.find(':') == std::string::npos;
  const auto address = host_and_port(alone ? HostPort{}.host + ":" + text : text);
  if (!address || address->port == 0)
    throw ConfigError("metrics: must be auto, PORT or HOST:PORT with a port of 1 to 65535, got " +
                      text);
  return *address;
}

/// The latest values.
struct Metrics::Board {
  Board(std::string program_name, std::string node_name)
      : program(std::move(program_name)), node(std::move(node_name)) {}

  /// In Prometheus's text format.
  std::string page() const {
    MetricFamilies all = families_of_build(program, node);
    append(&all, families_of_process(started_s));
    {
      const std::lock_guard lock(mutex);
      for (const auto& [kind, figures] : latest)
        append(&all, std::visit([&](const auto& f) { return families_of(f, node); }, figures));
    }
    return prometheus::TextSerializer().Serialize(all);
  }

  const std::string program, node;
  const double started_s =
      to_seconds(std::chrono::system_clock::now().time_since_epoch()) - process_age_s();
  mutable std::mutex mutex;               // guards what follows
  std::map<std::size_t, Figures> latest;  // by kind
};

Metrics::Metrics(const std::string& where, const std::string& program, const std::string& node)
    : board_(std::make_shared<Board>(program, node)) {
  HostPort address = metrics_address(where);
  try {
    server_ = std::make_unique<MetricsServer>(address.host, address.port,
                                              [board = board_] { return board->page(); });
  } catch (const Error& error) {
    throw Error("metrics: can't listen at " + text_of(address) + ": " + error.what());
  }
  address.port = server_->port();
  url_ = "http://" + text_of(address) + "/metrics";
  metrics_of_process = this;
  log_event(spdlog::level::info, "metrics_served", {{"url", url_}}, "metrics at " + url_);
}

Metrics::~Metrics() { metrics_of_process = nullptr; }

Metrics* Metrics::of_process() { return metrics_of_process.load(std::memory_order_relaxed); }

void Metrics::set(Figures figures) {
  const std::lock_guard lock(board_->mutex);
  const std::size_t kind = figures.index();
  board_->latest.insert_or_assign(kind, std::move(figures));
}

}  // namespace dmise
