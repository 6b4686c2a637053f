#include "launch/dataset_directory.h"

#include <array>
#include <filesystem>
#include <sstream>

#include "core/base/digest.h"
#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/json.h"
#include "core/base/paths.h"
#include "core/base/text_file.h"
#include "core/base/version.h"
#include "core/base/whole_file.h"
#include "core/dataset/tar.h"
#include "sensors/dataset/frame_labels.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

void remove(const std::string& path) {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

std::string head(const DatasetPlan& plan) {
  JsonWriter json;
  json.begin_object().field("software", software_name()).field("digest", plan.digest);
  json.field("scenario", "scenario.yaml")
      .list("seeds", std::array{plan.first_seed, plan.last_seed});
  return json.field("seeds_per_shard", plan.seeds_per_shard).take();
}

constexpr std::size_t any_size = std::size_t(1) << 40;  // of a file
constexpr std::string_view image_mark = "image ", annotation_mark = "annotation ";

/// A file that is written atomically, with its digest and size.
class DigestedFile {
 public:
  explicit DigestedFile(const std::string& path) : file_(path) {}
  void append(std::string_view piece) {
    file_.append(piece);
    sha_.update(piece);
    bytes_ += piece.size();
  }
  /// Its JSON fields "bytes" and "sha256".
  void finish(JsonWriter& json) {
    file_.finish();
    json.field("bytes", bytes_).field("sha256", sha_.hex());
  }

 private:
  WholeFile file_;
  Sha256 sha_;
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::string shard_name(std::size_t shard, const char* ending) {
  return formatted("dataset-%06zu%s", shard, ending);
}

DatasetDirectory::DatasetDirectory(std::string path, DatasetPlan plan)
    : path_(std::move(path)), plan_(std::move(plan)) {
  make_directories(path_);
}

DatasetDirectory::Content DatasetDirectory::content() const {
  const std::string mark = "\"digest\":\"" + plan_.digest + "\"";
  for (const auto& [path, same] : {std::pair{path_ + "/dataset.json", Content::same_complete},
                                   std::pair{part("plan.json"), Content::same_unfinished}})
    if (path_exists(path))
      return read_text_file(path).find(mark) != std::string::npos ? same : Content::another;
  return Content::nothing;
}

void DatasetDirectory::clear() const {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(path_, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("dataset-") && name.ends_with(".tar")) remove(entry.path().string());
  }
  for (const char* name : {"/dataset.json", "/coco.json", "/scenario.yaml", "/parts"})
    remove(path_ + name);
}

void DatasetDirectory::begin() const {
  make_directories(path_ + "/parts");
  const auto starting = lock("start");  // tasks of a job array begin together
  if (!starting || path_exists(part("plan.json"))) return;
  write_file_whole(path_ + "/scenario.yaml", plan_.scenario_text);
  write_file_whole(part("plan.json"), head(plan_) + "}\n");
}

std::optional<FileLock> DatasetDirectory::lock(const std::string& name) const {
  FileLock lock(part(name + ".lock"));
  if (!lock.take()) return std::nullopt;
  return lock;
}

std::string DatasetDirectory::sample_part(std::uint64_t seed, const char* ending) const {
  return part("sample-" + std::to_string(seed) + ending);
}

bool DatasetDirectory::has_shard(std::size_t shard) const {
  return path_exists(part(shard_name(shard, ".json")));
}

bool DatasetDirectory::has_sample(std::uint64_t seed) const {
  return path_exists(sample_part(seed, ".tar"));
}

void DatasetDirectory::write_sample(std::uint64_t seed,
                                    const std::vector<SampleFrame>& frames) const {
  std::string members, lines;
  for (const SampleFrame& frame : frames) {
    members += frame.members;
    lines += std::string(image_mark) + frame.coco_image + "\n";
    for (const std::string& annotation : frame.coco_annotations)
      lines += std::string(annotation_mark) + annotation + "\n";
  }
  write_file_whole(sample_part(seed, ".coco"), lines);
  write_file_whole(sample_part(seed, ".tar"), members);  // last: it marks the sample as complete
}

void DatasetDirectory::assemble(std::size_t shard) const {
  const std::uint64_t first = plan_.first_of(shard), last = plan_.last_of(shard);
  const std::string name = shard_name(shard);
  DigestedFile archive(path_ + "/" + name);
  std::string lines;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    archive.append(read_text_file(sample_part(seed, ".tar"), any_size));
    lines += read_text_file(sample_part(seed, ".coco"), any_size);
  }
  archive.append(tar_end());
  const auto count = [&](std::string_view mark) {
    std::uint64_t n = lines.starts_with(mark);
    const std::string start = "\n" + std::string(mark);
    for (std::size_t at = lines.find(start); at != std::string::npos;
         at = lines.find(start, at + 1))
      ++n;
    return n;
  };
  write_file_whole(part(shard_name(shard, ".coco")), lines);
  JsonWriter json;
  json.begin_object().field("name", name).list("seeds", std::array{first, last});
  json.field("frames", count(image_mark)).field("objects", count(annotation_mark));
  archive.finish(json);
  write_file_whole(part(shard_name(shard, ".json")), json.end_object().take());
  for (std::uint64_t seed = first; seed <= last; ++seed)
    for (const char* ending : {".tar", ".coco"}) remove(sample_part(seed, ending));
}

std::string DatasetDirectory::write_coco() const {
  DigestedFile file(path_ + "/coco.json");
  JsonWriter info;
  info.begin_object().field("description", "dataset " + plan_.digest);
  info.field("version", software_name()).end_object();
  file.append("{\"info\":" + info.take() + ",\"licenses\":[],\"categories\":" + coco_categories());
  // Two passes: images, then annotations, numbered from 1 in the order of the archives.
  for (const bool images : {true, false}) {
    file.append(images ? ",\"images\":[" : ",\"annotations\":[");
    std::uint64_t image = 0, annotation = 0;
    for (std::size_t shard = 0; shard < plan_.shards(); ++shard) {
      std::istringstream lines(read_text_file(part(shard_name(shard, ".coco")), any_size));
      for (std::string line; std::getline(lines, line);) {
        const bool is_image = line.starts_with(image_mark);
        std::uint64_t& id = is_image ? image : annotation;
        ++id;
        if (is_image != images) continue;
        std::string text = id > 1 ? ",\n{\"id\":" : "\n{\"id\":";
        text += std::to_string(id);
        if (is_image) text += ",\"shard\":\"" + shard_name(shard) + "\",";
        if (!is_image) text += ",\"image_id\":" + std::to_string(image) + ",";
        const std::size_t mark = is_image ? image_mark.size() : annotation_mark.size();
        file.append(text + line.substr(mark + 1));
      }
    }
    file.append("\n]");
  }
  file.append("}\n");
  JsonWriter json;
  json.begin_object().field("name", "coco.json");
  file.finish(json);
  return json.end_object().take();
}

std::size_t DatasetDirectory::finish() const {
  std::size_t missing = 0;
  for (std::size_t shard = 0; shard < plan_.shards(); ++shard) missing += !has_shard(shard);
  if (content() == Content::same_complete) return 0;  // another process did it
  if (missing > 0) return missing;
  const auto finishing = lock("finish");
  if (!finishing || content() == Content::same_complete) return 0;
  std::string text = head(plan_) + ",\"coco\":" + write_coco() + ",\"shards\":[";
  for (std::size_t shard = 0; shard < plan_.shards(); ++shard)
    text += (shard > 0 ? ",\n" : "\n") + read_text_file(part(shard_name(shard, ".json")));
  write_file_whole(path_ + "/dataset.json", text + "\n]}\n");
  remove(path_ + "/parts");
  return 0;
}

}  // namespace dmise
