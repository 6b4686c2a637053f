#include "sensors/frame/cue_journal.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string_view>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"

namespace dmise {
namespace {

std::string path_in(const std::string& directory) { return directory + "/tasks.journal"; }

/// Reads the numbers of a line one by one; `good` is false after a word that is no number.
struct Words {
  std::string_view rest;
  bool good = true;

  template <class T>
  T next() {
    T value{};
    if (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    const auto [end, code] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    good = good && code == std::errc{};
    if (good) rest.remove_prefix(std::size_t(end - rest.data()));
    return value;
  }
};

constexpr std::string_view task_word = "task", tick_word = "tick";
constexpr std::uint32_t max_points = 100000;

std::shared_ptr<const Task> read_task(std::string_view line) {
  Words words{line.substr(task_word.size())};
  auto task = std::make_shared<Task>();
  task->id = words.next<std::uint32_t>();
  task->track = words.next<std::uint32_t>();
  for (SimTime* t : {&task->given, &task->start, &task->on_target, &task->end, &task->path_start})
    t->ns = words.next<std::int64_t>();
  task->path_step_s = words.next<double>();
  const auto points = words.next<std::uint32_t>();
  if (!words.good || points < 2 || points > max_points) return nullptr;
  for (auto* path : {&task->path_m, &task->path_m_per_s})
    for (std::uint32_t i = 0; i < 3 * points && words.good; ++i)
      path->push_back(words.next<double>());
  return words.good && words.rest.empty() ? task : nullptr;
}

template <class Line>
void for_whole_lines(const std::string& path, Line line) {
  std::ifstream file(path);
  std::string text;
  while (std::getline(file, text) && !file.eof()) line(text);
}

}  // namespace

CueJournal::CueJournal(const std::string& directory) : path_(path_in(directory)) {}

CueJournal::~CueJournal() {
  if (file_) std::fclose(file_);
}

void CueJournal::fail(const std::string& reason) const { throw Error(path_ + ": " + reason); }

void CueJournal::open(const char* mode) {
  if (file_) std::fclose(file_);
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), code);
  file_ = std::fopen(path_.c_str(), mode);
  if (!file_) fail(std::string("can't be written: ") + std::strerror(errno));
}

void CueJournal::write(const std::string& line) {
  if (std::fwrite(line.data(), 1, line.size(), file_) != line.size() || std::fflush(file_) != 0)
    fail(std::string("can't be written: ") + std::strerror(errno));
}

void CueJournal::clear() { open("wb"); }

std::vector<std::shared_ptr<const Task>> CueJournal::resume() {
  std::map<std::uint32_t, std::shared_ptr<const Task>> tasks;
  std::string kept;
  for_whole_lines(path_, [&](const std::string& line) {
    if (line.starts_with(task_word)) {
      auto task = read_task(line);
      if (!task) fail("can't be read: " + line.substr(0, 60));
      tasks.emplace(task->id, std::move(task));
    }
    kept += line + "\n";
  });
  open("ab");                     // makes the directory
  write_file_whole(path_, kept);  // without a line that was cut off
  open("ab");
  std::vector<std::shared_ptr<const Task>> out;
  for (auto& [id, task] : tasks) out.push_back(std::move(task));
  return out;
}

void CueJournal::add(const Task& t) {
  std::string line =
      std::string(task_word) + " " + std::to_string(t.id) + " " + std::to_string(t.track);
  for (const SimTime time : {t.given, t.start, t.on_target, t.end, t.path_start})
    line += " " + std::to_string(time.ns);
  line += " " + shortest_text(t.path_step_s) + " " + std::to_string(t.path_m.size() / 3);
  for (const auto* path : {&t.path_m, &t.path_m_per_s})
    for (const double x : *path) line += " " + shortest_text(x);
  write(line + "\n");
}

void CueJournal::end(Tick tick) {
  write(std::string(tick_word) + " " + std::to_string(tick) + "\n");
}

Tick CueJournal::ticks_done(const std::string& directory) {
  Tick next = 0;
  for_whole_lines(path_in(directory), [&](const std::string& line) {
    if (!line.starts_with(tick_word)) return;
    Words words{std::string_view(line).substr(tick_word.size())};
    const auto tick = words.next<std::int64_t>();
    if (words.good) next = tick + 1;
  });
  return next;
}

}  // namespace dmise
