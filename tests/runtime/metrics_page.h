#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace dmise::test {

/// A page in Prometheus's text format (version 0.0.4), read line by line.
struct MetricsPage {
  struct Family {
    std::string help, type;
    std::map<std::string, double> samples;  // by "name{labels}"
  };
  std::map<std::string, Family> families;
  std::vector<std::string> errors;  // lines that are none

  explicit MetricsPage(const std::string& text);
  std::optional<double> value(const std::string& sample) const;
};

/// What is against the conventions of prometheus.io/docs/practices/naming: help and type on each,
/// snake_case, _total on counters and on nothing else, base units in full, no type in the name.
std::vector<std::string> lint(const MetricsPage& page);

}  // namespace dmise::test
