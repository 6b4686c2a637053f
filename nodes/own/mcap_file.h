#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace dmise {

/// A message of an MCAP file.
struct McapMessage {
  std::string_view channel, schema;  // names
  std::string_view data;
};

/// Reads the messages of an MCAP file (mcap.dev) in their order, plain or compressed by zstd, until
/// `hear` returns false or the file ends; one that was not finished ends with its last whole
/// record. Throws `ConfigError` "PATH: reason" if it is no such file or damaged.
void read_mcap(const std::string& path, const std::function<bool(const McapMessage&)>& hear);

}  // namespace dmise
