#include "launch/dataset/dataset_growth.h"

#include <array>
#include <cstdlib>
#include <fstream>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/version.h"

namespace dmise {
namespace {

std::string text_of_seeds(const DatasetPlan& plan) {
  return std::to_string(plan.first_seed) + ".." + std::to_string(plan.last_seed);
}

[[noreturn]] void fail_altered(const std::string& file) {
  throw Error(file + ": is not as it was written; --force makes all anew");
}

/// Lines of one list of coco.json, each an object.
class CocoLines {
 public:
  /// `begin`: how the line ends that the list begins with.
  CocoLines(std::string file, std::string_view begin) : file_(std::move(file)), lines_(file_) {
    for (std::string line; std::getline(lines_, line);)
      if (line.ends_with(begin)) break;
    next();
  }
  /// The line; empty after the last.
  const std::string& line() const { return line_; }
  void next() {
    if (!std::getline(lines_, line_) || !line_.starts_with('{')) line_.clear();
    if (line_.ends_with(',')) line_.pop_back();
  }
  std::uint64_t number(std::string_view field) const {
    const std::size_t at = line_.find(field);
    if (at == std::string::npos) fail_altered(file_);
    return std::strtoull(line_.c_str() + at + field.size(), nullptr, 10);
  }
  /// What follows the fields that numbers and shards are in, of which `last` is the last.
  std::string rest(std::string_view last) const {
    const std::size_t at = line_.find(last), end = line_.find(',', at);
    if (at == std::string::npos || end == std::string::npos) fail_altered(file_);
    return line_.substr(end + 1);
  }

 private:
  std::string file_;
  std::ifstream lines_;
  std::string line_;
};

/// The line of an archive in dataset.json.
std::string entry_of(const std::string& manifest, const std::string& file, std::size_t shard) {
  const std::size_t begin = manifest.find("{\"name\":\"" + shard_name(shard) + "\"");
  const std::size_t end = manifest.find_first_of(",\n", manifest.find('}', begin));
  if (begin == std::string::npos || end == std::string::npos) fail_altered(file);
  return manifest.substr(begin, end - begin);
}

/// Lines of the images of an archive, each before its annotations, as they were before coco.json
/// numbered them.
std::string lines_of(std::size_t shard, CocoLines& images, CocoLines& annotations) {
  const std::string of_shard = "\"shard\":\"" + shard_name(shard) + "\"";
  std::string lines;
  for (; images.line().find(of_shard) != std::string::npos; images.next()) {
    lines += std::string(image_mark) + "{" + images.rest("\"shard\":") + "\n";
    const std::uint64_t image = images.number("{\"id\":");
    for (; !annotations.line().empty() && annotations.number("\"image_id\":") == image;
         annotations.next())
      lines += std::string(annotation_mark) + "{" + annotations.rest("\"image_id\":") + "\n";
  }
  return lines;
}

}  // namespace

std::string dataset_head(const DatasetPlan& plan) {
  JsonWriter json;
  json.begin_object().field("software", software_name()).field("digest", plan.digest);
  json.field("scenario", "scenario.yaml")
      .list("seeds", std::array{plan.first_seed, plan.last_seed});
  return json.field("seeds_per_shard", plan.seeds_per_shard).take();
}

std::string digest_line(const DatasetPlan& plan) { return "dataset " + plan.digest + "\n"; }

std::optional<DatasetPlan> recorded_plan(const std::string& text, const DatasetPlan& plan) {
  DatasetPlan found = plan;
  const auto number = [&text](std::string_view field) {
    const std::size_t at = text.find(field);
    return at == std::string::npos ? 0
                                   : std::strtoull(text.c_str() + at + field.size(), nullptr, 10);
  };
  found.first_seed = number("\"seeds\":[");
  found.last_seed = number("\"seeds\":[" + std::to_string(found.first_seed) + ",");
  found.seeds_per_shard = number("\"seeds_per_shard\":");
  if (!text.starts_with(dataset_head(found))) return std::nullopt;
  return found;
}

DatasetPlan grown_plan(const std::string& path, DatasetPlan plan) {
  const std::string manifest = path + "/dataset.json", begun = path + "/parts/plan.json";
  const bool complete = path_exists(manifest);
  if (!complete && !path_exists(begun)) return plan;
  const auto there = recorded_plan(read_text_file(complete ? manifest : begun, any_size), plan);
  if (!there) return plan;
  if (there->seeds_per_shard != plan.seeds_per_shard)
    throw ConfigError("--per-shard: " + path + " has " + std::to_string(there->seeds_per_shard) +
                      " seeds in an archive, got " + std::to_string(plan.seeds_per_shard));
  const bool joins =
      plan.first_seed >= there->first_seed && plan.first_seed <= there->last_seed + 1;
  if (!complete && (!joins || plan.last_seed != there->last_seed))
    throw ConfigError("--seeds: " + path + " has seeds " + text_of_seeds(*there) +
                      ", unfinished; the command that began them continues");
  if (!joins)
    throw ConfigError("--seeds: " + path + " has seeds " + text_of_seeds(*there) +
                      "; more must begin with one of these or the next, got " +
                      text_of_seeds(plan));
  plan.first_seed = there->first_seed;
  plan.last_seed = std::max(plan.last_seed, there->last_seed);
  return plan;
}

void restore_parts(const std::string& path, const DatasetPlan& old) {
  const std::string file = path + "/dataset.json", manifest = read_text_file(file, any_size);
  CocoLines images(path + "/coco.json", "\"images\":["),
      annotations(path + "/coco.json", "\"annotations\":[");
  const std::size_t full = (old.last_seed - old.first_seed + 1) / old.seeds_per_shard;
  for (std::size_t shard = 0; shard < full; ++shard) {
    const std::string part = path + "/parts/";
    write_file_whole(part + shard_name(shard, ".coco"),
                     digest_line(old) + lines_of(shard, images, annotations));
    write_file_whole(part + shard_name(shard, ".json"), entry_of(manifest, file, shard));
  }
}

}  // namespace dmise
