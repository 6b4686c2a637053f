#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"

// The stream of an INDI client: XML elements one after the other, without a root. It may be
// hostile.
namespace dmise {

/// What no INDI client sends: its connection ends.
class BadIndi : public Error {
 public:
  using Error::Error;
};

/// One element of the stream, or one in it.
struct IndiElement {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;  // without white space at its ends
  std::vector<IndiElement> parts;

  /// "" without it.
  std::string attribute(const std::string& key) const;
};

inline constexpr std::size_t max_indi_element_bytes = 64 << 10;

/// Divides a stream into its elements. These have parts, which have none; there are no declarations
/// (so no entities but XML's own), comments or texts between elements.
class IndiStream {
 public:
  void add(std::string_view bytes) { waiting_ += bytes; }
  /// Removes and returns the next whole element; none: more bytes are needed. Throws `BadIndi`.
  std::optional<IndiElement> next();

 private:
  /// Whether an element ends with `c`.
  bool ends_with(char c);
  bool ends_tag();

  enum class In { between, tag_begin, tag, instruction };
  In in_ = In::between;
  char quote_ = 0, last_ = 0;
  bool closing_ = false;  // the tag
  int depth_ = 0;
  std::string waiting_;
  std::size_t looked_at_ = 0;  // first byte of `waiting_` not looked at yet
};

}  // namespace dmise
