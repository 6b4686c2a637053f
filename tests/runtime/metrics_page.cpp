#include "tests/runtime/metrics_page.h"

#include <regex>
#include <set>
#include <sstream>

namespace dmise::test {
namespace {

const std::regex help_line(R"(# HELP ([a-z_][a-z0-9_]*) (.+))");
const std::regex type_line(
    R"(# TYPE ([a-z_][a-z0-9_]*) (counter|gauge|histogram|summary|untyped))");
const std::regex sample_line(
    R"(([a-zA-Z_][a-zA-Z0-9_]*)(\{[a-z_]+="[^"\n]*"(,[a-z_]+="[^"\n]*")*\})? (\S+))");

std::string family_of(const std::string& name,
                      const std::map<std::string, MetricsPage::Family>& f) {
  for (const std::string suffix : {"_count", "_sum", "_bucket"})
    if (name.ends_with(suffix) && f.contains(name.substr(0, name.size() - suffix.size())))
      return name.substr(0, name.size() - suffix.size());
  return name;
}

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  std::istringstream stream(name);
  for (std::string word; std::getline(stream, word, '_');) words.push_back(word);
  return words;
}

}  // namespace

MetricsPage::MetricsPage(const std::string& text) {
  std::istringstream lines(text);
  std::smatch m;
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_match(line, m, help_line))
      families[m[1]].help = m[2];
    else if (std::regex_match(line, m, type_line))
      families[m[1]].type = m[2];
    else if (std::regex_match(line, m, sample_line))
      families[family_of(m[1], families)].samples[m[1].str() + m[2].str()] =
          std::strtod(m[4].str().c_str(), nullptr);
    else if (!line.empty())
      errors.push_back(line);
  }
}

std::optional<double> MetricsPage::value(const std::string& sample) const {
  for (const auto& [name, family] : families)
    if (const auto found = family.samples.find(sample); found != family.samples.end())
      return found->second;
  return std::nullopt;
}

std::vector<std::string> lint(const MetricsPage& page) {
  static const std::set<std::string> not_base{
      "ms",        "us",           "ns",           "s",           "sec",
      "secs",      "min",          "mins",         "minutes",     "hours",
      "days",      "kb",           "mb",           "gb",          "kilobytes",
      "megabytes", "milliseconds", "microseconds", "nanoseconds", "percent"};
  static const std::set<std::string> types{"counter", "gauge", "histogram", "summary", "untyped"};
  std::vector<std::string> complaints = page.errors;
  for (const auto& [name, family] : page.families) {
    if (family.help.empty()) complaints.push_back(name + ": no help");
    if (family.type.empty()) complaints.push_back(name + ": no type");
    if (family.samples.empty()) complaints.push_back(name + ": no sample");
    if (name.ends_with("_total") != (family.type == "counter"))
      complaints.push_back(name + ": _total is for counters, and for each of them");
    for (const std::string& word : words_of(name)) {
      if (not_base.contains(word)) complaints.push_back(name + ": " + word + " is no base unit");
      if (types.contains(word)) complaints.push_back(name + ": says its type");
    }
  }
  return complaints;
}

}  // namespace dmise::test
