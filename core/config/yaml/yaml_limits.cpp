#include "core/config/yaml/yaml_limits.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <vector>

#include "core/base/error.h"
#include "core/base/printable.h"
#include "core/config/yaml/yaml_syntax.h"

namespace dmise {
namespace {

[[noreturn]] void refuse(const std::string& file, const YAML::Mark& mark, const std::string& why) {
  throw ConfigError(place_of(file, mark) + ": " + why);
}

/// Counts the size of a document with expanded aliases.
class Counter : public YAML::EventHandler {
 public:
  Counter(const std::string& file, const YamlLimits& limits) : file_(file), limits_(limits) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) refuse(file_, mark, "must be one YAML document, this begins another");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { leaf(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                const std::string&) override {
    leaf(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    for (const Open& open : open_)
      if (open.anchor == anchor) refuse(file_, mark, "an alias within its own anchor");
    const Size size = anchored_[anchor];
    if (open_.size() + size.depth > limits_.depth) refuse_depth(mark);
    add(mark, size.values);
    for (std::size_t k = 0; k < open_.size(); ++k)
      open_[k].deepest = std::max(open_[k].deepest, open_.size() - k + size.depth);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    begin(mark, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    begin(mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapEnd() override { end(); }

 private:
  struct Size {
    std::size_t values = 0, depth = 0;
  };
  struct Open {
    YAML::anchor_t anchor;
    std::size_t values_before;
    std::size_t deepest = 1;  // levels within it, itself included
  };

  [[noreturn]] void refuse_depth(const YAML::Mark& mark) const {
    refuse(file_, mark, "lists and mappings nested deeper than " + std::to_string(limits_.depth));
  }

  void add(const YAML::Mark& mark, std::size_t values) {
    values_ += values;
    if (values_ > limits_.values)
      refuse(file_, mark,
             "more than " + std::to_string(limits_.values) + " values, aliases expanded");
  }
  void leaf(const YAML::Mark& mark, YAML::anchor_t anchor) {
    add(mark, 1);
    if (anchor != YAML::NullAnchor) anchored_[anchor] = {1, 0};
  }
  void begin(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (open_.size() >= limits_.depth) refuse_depth(mark);
    open_.push_back({anchor, values_});
    add(mark, 1);
    for (std::size_t k = 0; k < open_.size(); ++k)
      open_[k].deepest = std::max(open_[k].deepest, open_.size() - k);
  }
  void end() {
    const Open& last = open_.back();
    if (last.anchor != YAML::NullAnchor)
      anchored_[last.anchor] = {values_ - last.values_before, last.deepest};
    open_.pop_back();
  }

  const std::string& file_;
  const YamlLimits& limits_;
  std::size_t documents_ = 0, values_ = 0;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Size> anchored_;  // size of each closed anchor
};

}  // namespace

std::string place_of(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return printable(file);
  return printable(file) + ":" + std::to_string(mark.line + 1) + ":" +
         std::to_string(mark.column + 1);
}

void check_yaml_limits(const std::string& text, const std::string& file, const YamlLimits& limits) {
  if (text.size() > limits.bytes)
    throw ConfigError(printable(file) + ": larger than " + std::to_string(limits.bytes) + " bytes");
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Counter counter(file, limits);
    while (parser.HandleNextDocument(counter)) {
    }
  } catch (const YAML::Exception& e) {
    throw ConfigError(syntax_complaint(text, file, e));
  }
}

}  // namespace dmise
