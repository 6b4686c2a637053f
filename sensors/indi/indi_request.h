#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "sensors/indi/indi_stream.h"

// What an INDI client asks for (protocol 1.7).
namespace dmise {

enum class IndiKind { text, number, toggle, light, blob };

/// As it stands in the names of elements: "Text", "Switch".
std::string_view name_of(IndiKind kind);

struct GetIndiProperties {
  std::string device, property;  // empty: all
};

enum class BlobUse { never, also, only };
struct EnableIndiBlob {
  std::string device, property;  // empty: all of the device
  BlobUse use = BlobUse::never;
};

/// New values of a property, as they were written.
struct NewIndiVector {
  IndiKind kind = IndiKind::text;
  std::string device, property;
  std::map<std::string, std::string> values;
};

using IndiRequest = std::variant<GetIndiProperties, EnableIndiBlob, NewIndiVector>;

/// Reads a request; none: an element that says nothing to a server, or that the protocol does not
/// know, which is ignored. Throws `BadIndi` for a request that is none.
std::optional<IndiRequest> parse_indi(const IndiElement& element);

/// Reads a number: decimal, or sexagesimal as "-5:12:30.5", "5 12 30" and "5;12". None if it is
/// none or not finite.
std::optional<double> indi_number(std::string_view text);

}  // namespace dmise
