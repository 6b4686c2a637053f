#include "launch/dataset/dataset_directory.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "core/base/files/digest.h"
#include "core/base/files/json.h"
#include "core/base/files/json_record.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/version.h"
#include "core/dataset/tar.h"
#include "launch/command/command.h"
#include "launch/dataset/dataset_growth.h"
#include "nodes/runtime/process/event.h"
#include "sensors/dataset/frame_labels.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view partial_ending = ".partial", partial_plan = "plan.json.partial";

// Bytes of .dataset-lock.
constexpr std::int64_t directory_byte = 0;  // shared by tasks, alone to begin and to remove
constexpr std::int64_t finish_byte = 1;     // to write coco.json and dataset.json
constexpr std::int64_t task_byte = 1;       // plus the number of the task, from 1

bool is_directory(const std::string& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

std::vector<std::string> names_in(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(directory, ignored))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Whether `name` is `start`, at least `fewest` digits and one of `endings`, complete or not.
bool is_numbered(std::string name, std::string_view start, std::size_t fewest,
                 std::initializer_list<std::string_view> endings) {
  if (name.ends_with(partial_ending)) name.resize(name.size() - partial_ending.size());
  if (!name.starts_with(start)) return false;
  const std::size_t end = name.find_first_not_of("0123456789", start.size());
  return end != std::string::npos && end - start.size() >= fewest &&
         std::ranges::find(endings, std::string_view(name).substr(end)) != endings.end();
}

bool is_archive(const std::string& name) { return is_numbered(name, "dataset-", 6, {".tar"}); }

bool is_part(const std::string& name) {
  return name == "plan.json" || name == partial_plan ||
         is_numbered(name, "sample-", 1, {".tar", ".coco"}) ||
         is_numbered(name, "dataset-", 6, {".json", ".coco"});
}

std::string sample_name(std::uint64_t seed, const char* ending) {
  return "sample-" + std::to_string(seed) + ending;
}

/// Second line of the text file of a sample, of what its archive holds.
std::string members_line(std::string_view members) {
  return formatted("members %zu %08x\n", members.size(), crc32c(members.data(), members.size()));
}

/// The size of a file; -1 if there is none.
std::int64_t size_of(const std::string& path) {
  std::error_code missing;
  const auto size = fs::file_size(path, missing);
  return missing ? -1 : std::int64_t(size);
}

JsonRecord json_of(const std::string& path) { return {read_text_file(path, any_size), path}; }

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

bool DatasetDirectory::begin(const DatasetTask& task, bool force) {
  const std::string lock_path = path_ + "/.dataset-lock";
  // Without a lock, which could not be made in a directory that is only read.
  if (!force && (path_exists(path_ + "/dataset.json") || !path_exists(lock_path))) try {
      if (is_complete()) return false;
    } catch (const ConfigError&) {
      // Another process may have begun meanwhile.
      if (path_exists(path_ + "/dataset.json") || !path_exists(lock_path)) throw;
    }
  lock_.emplace(lock_path);
  const bool alone = lock(force);
  if (force) clear();
  if (!force && is_complete()) return false;
  if (alone) {
    make_directories(path_ + "/parts");
    if (!force && content() == Content::fewer_complete) reopen();
    // First the plan: it tells that the other files are ours.
    write_file_whole(part("plan.json"),
                     dataset_head(plan_) + ",\"tasks\":" + std::to_string(task.count) + "}\n");
    write_file_whole(path_ + "/scenario.yaml", plan_.scenario_text);
    remove_file(path_ + "/dataset.json");  // fewer seeds are no longer all
    lock_->take(directory_byte, FileLock::Use::shared);
  } else {
    require_tasks(task);
  }
  if (!lock_->take(task_byte + std::int64_t(task.number), FileLock::Use::alone))
    throw ConfigError(path_ + ": another process works on --shard " + std::to_string(task.number) +
                      "/" + std::to_string(task.count));
  return true;
}

bool DatasetDirectory::lock(bool force) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (true) {
    if (lock_->take(directory_byte, FileLock::Use::alone)) return true;
    if (!force && lock_->take(directory_byte, FileLock::Use::shared)) return false;
    if (force || std::chrono::steady_clock::now() > give_up)
      throw ConfigError(path_ + ": another process works in this directory");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // it begins or removes files
  }
}

void DatasetDirectory::require_tasks(const DatasetTask& task) const {
  if (json_of(part("plan.json")).get<std::uint64_t>("tasks") == task.count) return;
  throw ConfigError(path_ +
                    ": other processes make this data set, with another n of --shard i/n, got " +
                    std::to_string(task.number) + "/" + std::to_string(task.count));
}

DatasetDirectory::Content DatasetDirectory::content() const {
  const std::string manifest = path_ + "/dataset.json", plan = part("plan.json");
  // The manifest again: another process may have written it and removed the plan meanwhile.
  for (const std::string& path : {manifest, plan, manifest}) {
    if (!path_exists(path)) continue;
    const auto there = recorded_plan(read_text_file(path, any_size), plan_);
    const bool same = there && dataset_head(*there) == dataset_head(plan_);
    if (same) return path == plan ? Content::same_unfinished : Content::same_complete;
    if (there && path == manifest && there->seeds_per_shard == plan_.seeds_per_shard &&
        there->first_seed == plan_.first_seed && there->last_seed < plan_.last_seed)
      return Content::fewer_complete;
    throw ConfigError(path_ +
                      ": contains another data set; --force replaces it, --out writes elsewhere");
  }
  if (const std::string file = file_of_no_dataset(); !file.empty())
    throw ConfigError(path_ + ": contains " + printable(file) +
                      ", which is of no data set there; --force replaces files of such names, "
                      "--out writes elsewhere");
  return Content::nothing;
}

std::string DatasetDirectory::file_of_no_dataset() const {
  for (const std::string& name : names_in(path_))
    if (name == "scenario.yaml" || name == "coco.json" || is_archive(name)) return name;
  if (path_exists(path_ + "/parts") && !is_directory(path_ + "/parts")) return "parts";
  for (const std::string& name : names_in(path_ + "/parts"))
    if (name != partial_plan) return "parts/" + name;
  return "";
}

void DatasetDirectory::clear() const {
  if (path_exists(path_ + "/parts") && !is_directory(path_ + "/parts"))
    throw ConfigError(path_ + "/parts: is not a directory");
  remove_file(part("plan.json"));  // first: what is left, if this is stopped, is of no data set
  for (const char* name : {"/dataset.json", "/coco.json"}) {
    remove_file(path_ + name);
    remove_file(path_ + name + std::string(partial_ending));
  }
  for (const std::string& name : names_in(path_))
    if (is_archive(name)) remove_file(path_ + "/" + name);
  remove_parts();
}

void DatasetDirectory::remove_parts() const {
  for (const std::string& name : names_in(path_ + "/parts"))
    if (is_part(name)) remove_file(part(name));
  std::error_code ignored;
  if (fs::symlink_status(path_ + "/parts", ignored).type() == fs::file_type::directory)
    fs::remove(path_ + "/parts", ignored);  // if it is empty
}

void DatasetDirectory::reopen() const {
  const auto old = recorded_plan(read_text_file(path_ + "/dataset.json", any_size), plan_);
  if (!old) return;
  require_files(*old);
  remove_parts();
  make_directories(path_ + "/parts");
  restore_parts(path_, *old);
}

bool DatasetDirectory::is_complete() const {
  if (content() != Content::same_complete) return false;
  require_files(plan_);
  return true;
}

void DatasetDirectory::require_files(const DatasetPlan& plan) const {
  const JsonRecord manifest = json_of(path_ + "/dataset.json");
  std::vector<JsonRecord> files = manifest.objects("shards");
  if (files.size() != plan.shards())
    throw ConfigError(path_ + ": dataset.json has " + std::to_string(files.size()) + " of " +
                      std::to_string(plan.shards()) + " archives; --force makes all anew");
  files.insert(files.begin(), manifest.object("coco"));
  for (const JsonRecord& file : files) {
    const std::string name = file.get<std::string>("name");
    const std::int64_t size = size_of(path_ + "/" + name), wanted = file.get<std::int64_t>("bytes");
    if (size == wanted) continue;
    throw ConfigError(path_ + ": " + name + " " +
                      (size < 0 ? "is missing" : "has " + std::to_string(size) + " bytes") +
                      ", by dataset.json it has " + std::to_string(wanted) +
                      "; --force makes all anew");
  }
}

bool DatasetDirectory::has_shard(std::size_t shard) const {
  const std::string json = part(shard_name(shard, ".json"));
  const std::int64_t size = size_of(path_ + "/" + shard_name(shard));
  return size >= 0 && path_exists(json) && size == json_of(json).get<std::int64_t>("bytes");
}

bool DatasetDirectory::has_sample(std::uint64_t seed) const {
  const std::int64_t size = size_of(part(sample_name(seed, ".tar")));
  const std::string text = part(sample_name(seed, ".coco"));
  if (size < 0 || !path_exists(text)) return false;
  const std::string lines = read_text_file(text, any_size);
  return lines.find("\nmembers " + std::to_string(size) + " ") + 1 == digest_line(plan_).size();
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
  write_file_whole(part(sample_name(seed, ".coco")),
                   digest_line(plan_) + members_line(members) + lines);
  // Last: it marks the sample as complete.
  write_file_whole(part(sample_name(seed, ".tar")), members);
}

std::string DatasetDirectory::lines_of(const std::string& part_name) const {
  const std::string text = read_text_file(part(part_name), any_size), first = digest_line(plan_);
  if (!text.starts_with(first))
    throw Error(part(part_name) + ": is of another data set; --force makes all anew");
  return text.substr(first.size());
}

void DatasetDirectory::assemble(std::size_t shard) const {
  const std::uint64_t first = plan_.first_of(shard), last = plan_.last_of(shard);
  const std::string name = shard_name(shard);
  DigestedFile archive(path_ + "/" + name);
  std::string lines;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const std::string members = read_text_file(part(sample_name(seed, ".tar")), any_size);
    const std::string text = lines_of(sample_name(seed, ".coco")),
                      first_line = members_line(members);
    if (!text.starts_with(first_line))
      throw Error(part(sample_name(seed, ".tar")) + ": is damaged; removed, it is made again");
    lines += text.substr(first_line.size());
    archive.append(members);
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
  write_file_whole(part(shard_name(shard, ".coco")), digest_line(plan_) + lines);
  JsonWriter json;
  json.begin_object().field("name", name).list("seeds", std::array{first, last});
  json.field("frames", count(image_mark)).field("objects", count(annotation_mark));
  archive.finish(json);
  write_file_whole(part(shard_name(shard, ".json")), json.end_object().take());
  for (std::uint64_t seed = first; seed <= last; ++seed)
    for (const char* ending : {".tar", ".coco"}) remove_file(part(sample_name(seed, ending)));
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
      std::istringstream lines(lines_of(shard_name(shard, ".coco")));
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

std::size_t DatasetDirectory::finish() {
  std::size_t missing = 0;
  for (std::size_t shard = 0; shard < plan_.shards(); ++shard) missing += !has_shard(shard);
  if (missing > 0) return missing;
  while (!lock_->take(finish_byte, FileLock::Use::alone)) {  // another process finishes it
    if (stop_signal().is_set()) throw ExitWith{130};
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (content() != Content::same_complete) {
    std::string text = dataset_head(plan_) + ",\"coco\":" + write_coco() + ",\"shards\":[";
    for (std::size_t shard = 0; shard < plan_.shards(); ++shard)
      text += (shard > 0 ? ",\n" : "\n") + read_text_file(part(shard_name(shard, ".json")));
    write_file_whole(path_ + "/dataset.json", text + "\n]}\n");
  }
  // The last process that leaves the directory can have it alone.
  lock_->release(directory_byte);
  if (lock_->take(directory_byte, FileLock::Use::alone) && path_exists(path_ + "/dataset.json"))
    remove_parts();
  lock_.reset();
  return 0;
}

}  // namespace dmise
