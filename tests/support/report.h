#pragma once
#include <string>

#include "core/base/files/text_file.h"

namespace dmise::test {

/// "digest" of a time-master's report; empty when it has none.
inline std::string digest_in(const std::string& report) {
  const std::string json = read_text_file(report);
  const auto at = json.find("\"digest\":\"");
  return at == std::string::npos ? "" : json.substr(at + 10, 16);
}

}  // namespace dmise::test
