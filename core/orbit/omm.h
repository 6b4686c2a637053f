#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/orbit/catalogue.h"
#include "core/orbit/record.h"

namespace dmise {

/// One Orbit Mean-elements Message (CCSDS 502.0-B) as keys and texts, independent of notation.
class OmmFields {
 public:
  void set(std::string_view key, std::string_view value) { fields_.emplace_back(key, value); }
  /// Trimmed text of a key; empty if missing.
  std::string_view get(std::string_view key) const;
  bool empty() const { return fields_.empty(); }
  void clear() { fields_.clear(); }

 private:
  std::vector<std::pair<std::string, std::string>> fields_;
};

/// Elements of a message whose theory is SGP4 (centre Earth, frame TEME and time UTC if stated).
/// NORAD_CAT_ID has 1 to 9 digits; OBJECT_ID "1998-067A" becomes "98067A". Throws `RecordError`.
MeanElements elements_of(const OmmFields& omm);

// One reader per notation. A bad message is refused alone; text that is not JSON or XML at all
// throws `ConfigError` with its line.
void read_omm_json(std::string_view text, CatalogueFile& file);
void read_omm_csv(std::string_view text, CatalogueFile& file);
void read_omm_xml(std::string_view text, CatalogueFile& file);
void read_omm_kvn(std::string_view text, CatalogueFile& file);

/// Adds the message that begins at `line` to `file`, or the reason why it is refused.
void add_omm(const OmmFields& omm, int line, CatalogueFile& file);

}  // namespace dmise
