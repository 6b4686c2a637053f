// Any bytes after the magic of an MCAP file are all that a node has said in a run, or one
// ConfigError that names the file.
#include <google/protobuf/stubs/logging.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <vector>

#include "core/base/error.h"
#include "nodes/own/recorded_actor.h"
#include "tests/fuzz/chunks.h"
#include "tests/own/sample_recording.h"

namespace {

using namespace dmise;

// Texts that are none are refused; the library would also print each.
[[maybe_unused]] const auto printing = google::protobuf::SetLogHandler(nullptr);
constexpr std::size_t head_bytes = 9, size_at = 1;

/// A file in memory.
class File {
 public:
  void hold(std::string_view bytes) const {
    if (ftruncate(number_, 0) != 0 ||
        pwrite(number_, bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
      __builtin_trap();
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(number_); }

 private:
  int number_ = memfd_create("recording", MFD_CLOEXEC);
};

/// A recording plain, in a chunk, in a compressed chunk.
const std::vector<std::string>& samples() {
  static const std::vector<std::string> all = [] {
    const std::string records = test::sample_records();
    return std::vector{records, test::chunk_record(records, false),
                       test::chunk_record(records, true)};
  }();
  return all;
}

std::uint64_t size_of_record(std::string_view records) {
  std::uint64_t size = 0;
  std::memcpy(&size, records.data() + size_at, sizeof size);
  return size;
}

/// Whole records, in order.
std::vector<std::string> records_in(std::string_view bytes) {
  std::vector<std::string> records;
  while (bytes.size() >= head_bytes && size_of_record(bytes) <= bytes.size() - head_bytes) {
    records.emplace_back(bytes.substr(0, head_bytes + size_of_record(bytes)));
    bytes.remove_prefix(records.back().size());
  }
  return records;
}

std::string mutated(const std::string& record) {
  std::string body = record.substr(head_bytes);
  const std::size_t size = body.size();
  body.resize(size + 16);
  body.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(body.data()), size, body.size()));
  return test::record(std::uint8_t(record[0]), body);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const File file;
  static const Scenario scenario = test::sample_scenario();
  file.hold(std::string(test::mcap_magic) + std::string(fuzz::view(data, size)));
  try {
    RecordedActor actor(scenario, "gnc", test::sample_digest, file.path());
    for (Tick tick = 0; tick <= test::sample_last_tick; ++tick) {
      const Message message = actor.step(tick, {}).at(0);
      const auto& states = std::get<ObjectStates>(*message.state);
      if (states.tick != tick || states.time != scenario.time_of(tick)) __builtin_trap();
    }
  } catch (const ConfigError& error) {
    if (!std::string_view(error.what()).starts_with(file.path() + ": ")) __builtin_trap();
  }
  return 0;
}

// One of its records is changed, left out, repeated or put into a chunk; lengths stay right.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  if (size == 0 || seed % 64 == 0)
    if (fuzz::place(samples()[seed / 64 % samples().size()], data, &size, max_size)) return size;
  auto records = records_in(fuzz::view(data, size));
  if (seed % 4 == 0 || records.empty()) return LLVMFuzzerMutate(data, size, max_size);
  std::string& record = records[seed / 64 % records.size()];
  switch (seed / 4 % 16) {
    case 0:
      record.clear();
      break;
    case 1:
      record += record;
      break;
    case 2:
      record = test::chunk_record(record, seed & 1);
      break;
    default:
      record = mutated(record);
  }
  std::string changed;
  for (const std::string& one : records) changed += one;
  return fuzz::place(changed, data, &size, max_size) ? size
                                                     : LLVMFuzzerMutate(data, size, max_size);
}
