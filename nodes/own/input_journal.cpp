#include "nodes/own/input_journal.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/files/crc32c.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

/// Before the texts of each record. A journal stays on its host: integers have its byte order.
struct Head {
  std::int64_t tick = 0;
  std::uint32_t kind = 0;                            // kind of the message; 0: the tick ends
  std::uint32_t topic = 0, payload = 0, arrays = 0;  // bytes
  std::uint32_t crc = 0;                             // over the texts and this with crc 0
  std::uint32_t spare = 0;
};

struct Record {
  Head head;
  std::string texts;

  std::uint32_t crc() const {
    Head plain = head;
    plain.crc = 0;
    return crc32c(texts.data(), texts.size(), crc32c(&plain, sizeof plain));
  }
};

/// Reads the next record; false at the end or at an incomplete one.
bool read_record(std::ifstream& file, Record& record) {
  if (!file.read(reinterpret_cast<char*>(&record.head), sizeof record.head)) return false;
  const Head& h = record.head;
  if (h.topic > max_topic_bytes || h.payload > max_payload_bytes || h.arrays > max_array_bytes)
    return false;
  record.texts.resize(std::size_t(h.topic) + h.payload + h.arrays);
  if (!file.read(record.texts.data(), std::streamsize(record.texts.size()))) return false;
  return record.crc() == h.crc;
}

bool write(std::FILE* file, Record& record) {
  record.head.crc = record.crc();
  return std::fwrite(&record.head, sizeof record.head, 1, file) == 1 &&
         std::fwrite(record.texts.data(), 1, record.texts.size(), file) == record.texts.size();
}

Message message_of(const Record& record) {
  const Head& h = record.head;
  const std::string_view texts = record.texts;
  return {std::string(texts.substr(0, h.topic)), h.tick,
          std::make_shared<State>(decode(MessageKind(h.kind), texts.substr(h.topic, h.payload),
                                         texts.substr(h.topic + h.payload)))};
}

}  // namespace

InputReader::InputReader(const std::string& path) : file_(path, std::ios::binary) {}

bool InputReader::next(std::vector<Message>* messages) {
  Record record;
  while (read_record(file_, record)) {
    if (record.head.kind != 0) {
      if (messages) messages->push_back(message_of(record));
      continue;
    }
    if (record.head.tick != tick_) return false;
    ++tick_;
    bytes_ = std::uintmax_t(file_.tellg());
    return true;
  }
  return false;
}

InputJournal::~InputJournal() {
  if (file_) std::fclose(file_);
}

void InputJournal::fail(const std::string& reason) const { throw Error(path_ + ": " + reason); }

void InputJournal::open(const char* mode) {
  if (file_) std::fclose(file_);
  std::error_code code;
  std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), code);
  if (code) fail("can't be created: " + code.message());
  file_ = std::fopen(path_.c_str(), mode);
  if (!file_) fail(std::string("can't be written: ") + std::strerror(errno));
}

void InputJournal::clear() { open("wb"); }

std::uintmax_t InputJournal::read(
    Tick from, Tick before,
    const std::function<void(Tick, std::span<const Message>)>& again) const {
  InputReader reader(path_);
  std::vector<Message> inputs;
  while (reader.tick() < before) {
    const Tick tick = reader.tick();
    inputs.clear();
    if (!reader.next(tick >= from ? &inputs : nullptr))
      fail("ends before tick " + std::to_string(tick) + ", and the run continues at " +
           std::to_string(before) + ": start the run from its beginning");
    if (tick >= from) again(tick, inputs);
  }
  return reader.bytes();
}

void InputJournal::replay(Tick from, Tick before,
                          const std::function<void(Tick, std::span<const Message>)>& again) const {
  read(from, before, again);
}

void InputJournal::resume(Tick tick,
                          const std::function<void(Tick, std::span<const Message>)>& again) {
  continue_after(read(0, tick, again));
}

Tick InputJournal::resume() {
  InputReader reader(path_);
  while (reader.next(nullptr)) {
  }
  continue_after(reader.bytes());
  return reader.tick();
}

void InputJournal::continue_after(std::uintmax_t bytes) {
  open("ab");
  if (::truncate(path_.c_str(), off_t(bytes)) != 0)
    fail(std::string("can't be truncated: ") + std::strerror(errno));
}

void InputJournal::add(std::span<const Message> inputs) {
  for (const Message& message : inputs) {
    const Encoded encoded = encode(*message.state);
    Record record;
    record.head = {.tick = message.tick,
                   .kind = std::uint32_t(encoded.kind),
                   .topic = std::uint32_t(message.topic.size()),
                   .payload = std::uint32_t(encoded.payload.size()),
                   .arrays = std::uint32_t(encoded.arrays.size())};
    record.texts = message.topic + encoded.payload + encoded.arrays;
    if (!write(file_, record)) fail(std::string("can't be written: ") + std::strerror(errno));
  }
}

void InputJournal::end(Tick tick) {
  Record record;
  record.head.tick = tick;
  if (!write(file_, record) || std::fflush(file_) != 0)
    fail(std::string("can't be written: ") + std::strerror(errno));
}

Tick InputJournal::ticks_written(const std::string& path) {
  InputReader reader(path);
  while (reader.next(nullptr)) {
  }
  return reader.tick();
}

std::string input_journal_path(const std::string& directory, const std::string& node) {
  return directory + "/" + node + "/inputs.journal";
}

}  // namespace dmise
