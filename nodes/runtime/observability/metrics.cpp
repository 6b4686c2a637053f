#include "nodes/runtime/observability/metrics.h"

#include <prometheus/text_serializer.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <map>
#include <mutex>

#include "core/base/error.h"
#include "nodes/runtime/observability/metric_families.h"
#include "nodes/runtime/observability/metrics_server.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/process/seconds.h"

namespace dmise {
namespace {

std::atomic<Metrics*> metrics_of_process{nullptr};

void append(MetricFamilies* all, MetricFamilies more) {
  std::move(more.begin(), more.end(), std::back_inserter(*all));
}

}  // namespace

MetricsAddress metrics_address(const std::string& text) {
  MetricsAddress address;
  if (text == "auto") return address;
  const auto colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (error != std::errc() || end != port.data() + port.size() || address.port < 1 ||
      address.port > 65535 || colon == 0)
    throw ConfigError("metrics: must be auto, PORT or HOST:PORT with a port of 1 to 65535, got " +
                      text);
  if (colon != std::string::npos) address.host = text.substr(0, colon);
  return address;
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
  const double started_s = to_seconds(std::chrono::system_clock::now().time_since_epoch());
  mutable std::mutex mutex;               // guards what follows
  std::map<std::size_t, Figures> latest;  // by kind
};

Metrics::Metrics(const std::string& where, const std::string& program, const std::string& node)
    : board_(std::make_shared<Board>(program, node)) {
  const MetricsAddress address = metrics_address(where);
  try {
    server_ = std::make_unique<MetricsServer>(address.host, address.port,
                                              [board = board_] { return board->page(); });
  } catch (const Error& error) {
    throw Error("metrics: can't listen at " + address.host + ":" + std::to_string(address.port) +
                ": " + error.what());
  }
  url_ = "http://" + address.host + ":" + std::to_string(server_->port()) + "/metrics";
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
