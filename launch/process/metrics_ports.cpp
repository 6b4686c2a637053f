#include "launch/process/metrics_ports.h"

#include <array>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/whole_file.h"

namespace dmise {

MetricsPorts::MetricsPorts(const std::string& where) : on_(!where.empty()) {
  if (on_) address_ = metrics_address(where);
}

std::string MetricsPorts::next(const std::string& name) {
  if (!on_) return "";
  if (address_.port == 0) return "auto";
  if (address_.port > 65535) throw ConfigError("metrics: no port left for " + name);
  const std::string target = text_of(address_);
  ++address_.port;
  targets_.emplace_back(name, target);
  return target;
}

void MetricsPorts::write_targets(const std::string& path) const {
  if (targets_.empty()) return;
  JsonWriter json;
  json.begin_array();
  for (const auto& [name, target] : targets_) {
    json.begin_object().list("targets", std::array{target});
    json.key("labels").begin_object().field("process", name).end_object().end_object();
  }
  json.end_array();
  write_file_whole(path, json.take() + "\n");
}

}  // namespace dmise
