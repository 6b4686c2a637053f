#include "nodes/runtime/observability/metrics.h"

#include <prometheus/text_serializer.h>

#include <atomic>
#include <chrono>
#include <map>
#include <mutex>

#include "core/base/error.h"
#include "nodes/runtime/observability/metric_families.h"
#include "nodes/runtime/observability/metrics_server.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/process/process_memory.h"
#include "nodes/runtime/process/seconds.h"

namespace dmise {
namespace {

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
