#pragma once
#include <string>
#include <string_view>
#include <utility>

#include "core/base/printable_ascii.h"
#include "core/exchange/run_products.h"

namespace dmise {

/// Text in the keyword = value notation of CCSDS navigation messages. Characters of values that are
/// not printable ASCII become ?.
class KvnText {
 public:
  /// Begins a message of a run with its header; `version_key`: CCSDS_TDM_VERS or CCSDS_OEM_VERS.
  KvnText(const RunProducts& run, std::string_view version_key) {
    key(version_key, "2.0");
    comment(run.software + ", scenario " + run.digest + ", seed " + std::to_string(run.seed));
    comment("CREATION_DATE is the start of the simulation");
    key("CREATION_DATE", run.utc({0})).key("ORIGINATOR", "DMISE");
  }
  KvnText& key(std::string_view key, std::string_view value) {
    return line(std::string(key) + " = " + printable_ascii(value));
  }
  KvnText& comment(std::string_view text) { return line("COMMENT " + printable_ascii(text)); }
  KvnText& line(std::string_view text) {
    text_ += text;
    text_ += '\n';
    return *this;
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace dmise
