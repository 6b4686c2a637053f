#include "nodes/own/mcap_file.h"

#include <zlib.h>
#include <zstd.h>

#include <bit>
#include <cstring>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/base/files/mapped_file.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view magic("\x89MCAP0\r\n", 8);
constexpr std::uint64_t longest_chunk_bytes = std::uint64_t(1) << 30;
enum Opcode : std::uint8_t { schema_record = 3, channel_record = 4, message_record = 5, chunk = 6 };

/// Fields of a record, in order.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  T number() {
    T value{};
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view text() { return bytes(number<std::uint32_t>()); }
  std::string_view bytes(std::uint64_t size) {
    if (size > rest_.size()) throw Error("a record ends early");
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

std::string unpacked(std::string_view compression, std::string_view packed, std::uint64_t size) {
  if (size > longest_chunk_bytes) throw Error("a chunk of " + std::to_string(size) + " bytes");
  if (compression.empty()) return std::string(packed);
  if (compression != "zstd") throw Error("is compressed by " + printable(compression, 20));
  const unsigned long long stated = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (stated != size && stated != ZSTD_CONTENTSIZE_UNKNOWN)
    throw Error("a chunk of another size than it says");
  std::string plain(size, '\0');
  const std::size_t got = ZSTD_decompress(plain.data(), size, packed.data(), packed.size());
  if (ZSTD_isError(got)) throw Error(ZSTD_getErrorName(got));
  plain.resize(got);
  return plain;
}

class McapReader {
 public:
  explicit McapReader(const std::function<bool(const McapMessage&)>& hear) : hear_(hear) {}

  /// False once it has heard enough. In a chunk no record may be cut, or be a chunk.
  bool read(std::string_view records, bool in_chunk) {
    constexpr std::size_t head_bytes = 9;
    while (!records.empty() && records != magic) {
      Fields head(records);
      if (!in_chunk && records.size() < head_bytes) return true;
      const auto opcode = head.number<std::uint8_t>();
      const auto size = head.number<std::uint64_t>();
      if (!in_chunk && size > head.rest().size()) return true;
      if (in_chunk && opcode == chunk) throw Error("a chunk in a chunk");
      if (!take(opcode, Fields(head.bytes(size)))) return false;
      records = head.rest();
    }
    return true;
  }

 private:
  bool take(std::uint8_t opcode, Fields record) {
    switch (opcode) {
      case schema_record: {
        const auto id = record.number<std::uint16_t>();
        schemas_[id] = record.text();
        return true;
      }
      case channel_record: {
        const auto id = record.number<std::uint16_t>();
        const auto schema = record.number<std::uint16_t>();
        channels_[id] = {std::string(record.text()), schemas_[schema]};
        return true;
      }
      case message_record:
        return take_message(record);
      case chunk:
        return take_chunk(record);
      default:
        return true;
    }
  }

  bool take_message(Fields record) {
    const auto channel = channels_.find(record.number<std::uint16_t>());
    if (channel == channels_.end()) throw Error("a message of no channel");
    record.number<std::uint32_t>();  // sequence
    record.number<std::uint64_t>();  // times
    record.number<std::uint64_t>();
    const auto& [topic, schema] = channel->second;
    return hear_({topic, schema, record.rest()});
  }

  bool take_chunk(Fields record) {
    record.number<std::uint64_t>();  // times
    record.number<std::uint64_t>();
    const auto size = record.number<std::uint64_t>();
    const auto sum = record.number<std::uint32_t>();
    const std::string_view compression = record.text();
    const std::string plain =
        unpacked(compression, record.bytes(record.number<std::uint64_t>()), size);
    const auto* bytes = reinterpret_cast<const Bytef*>(plain.data());
    if (plain.size() != size || (sum != 0 && crc32_z(0, bytes, plain.size()) != sum))
      throw Error("a chunk has another checksum");
    return read(plain, true);
  }

  const std::function<bool(const McapMessage&)>& hear_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, std::pair<std::string, std::string>> channels_;  // name, schema
};

}  // namespace

void read_mcap(const std::string& path, const std::function<bool(const McapMessage&)>& hear) {
  try {
    const MappedFile file(path);
    const std::string_view bytes(reinterpret_cast<const char*>(file.bytes().data()),
                                 file.bytes().size());
    if (!bytes.starts_with(magic)) throw ConfigError(printable(path) + ": not an MCAP file");
    McapReader(hear).read(bytes.substr(magic.size()), false);
  } catch (const ConfigError&) {
    throw;
  } catch (const Error& error) {
    const std::string what = error.what();
    throw ConfigError(what.starts_with(path) ? what : printable(path) + ": damaged: " + what);
  }
}

}  // namespace dmise
