#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/orbit/elements/catalogue.h"
#include "core/orbit/elements/record.h"

namespace dmise {

/// One Orbit Mean-elements Message (CCSDS 502.0-B) as keys and texts, independent of notation.
class OmmFields {
 public:
  /// `unit`: as the message states it; empty if it does not.
  void set(std::string_view key, std::string_view value, std::string_view unit = {}) {
    fields_.push_back({std::string(key), std::string(value), std::string(unit), {}});
  }
  /// Sets a key to what is neither a text nor a number: "null", "an array" or "an object".
  void set_other(std::string_view key, std::string_view what) {
    fields_.push_back({std::string(key), {}, {}, std::string(what)});
  }
  /// Trimmed text of a key; empty if missing or null. Throws `RecordError` if the key is there
  /// twice, is an array or an object, or has another unit than the standard's.
  std::string_view get(std::string_view key) const;
  /// Text of a key that must be there. Throws `RecordError` also if there is no text.
  std::string_view required(std::string_view key) const;
  bool empty() const { return fields_.empty(); }
  void clear() { fields_.clear(); }

 private:
  struct Field {
    std::string key, value, unit, other;
  };
  const Field* find(std::string_view key) const;
  std::vector<Field> fields_;
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
