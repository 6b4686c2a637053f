#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sensors/indi/indi_request.h"

// Properties as an INDI server defines and sets them: vectors of items (protocol 1.7).
namespace dmise {

enum class IndiState { idle, ok, busy, alert };
enum class IndiRule { one_of_many, at_most_one };

struct IndiRange {
  const char* format = "%g";                 // how a client prints the number
  double low = 0.0, high = 0.0, step = 0.0;  // low = high: any number
  double noticed = 0.0;                      // smaller changes alone are not told
};

struct IndiItem {
  const char* name;
  const char* label;
  std::variant<std::string, double, bool> value = {};
  IndiRange range = {};  // that a number may have
};

/// What all properties of a name have.
struct IndiTitle {
  const char* name;
  const char* label;
  const char* group;
  IndiKind kind = IndiKind::text;
  IndiRule rule = IndiRule::one_of_many;  // how many switches may be on
};

struct IndiVector {
  std::string device;
  IndiTitle title;
  bool can_be_set = false;
  IndiState state = IndiState::idle;
  std::vector<IndiItem> items;
};

/// Where and why something is told.
struct IndiRemark {
  std::string utc;      // ISO 8601 without a Z
  std::string message;  // empty: none
};

// The elements of the protocol.
std::string indi_definition(const IndiVector& vector, const IndiRemark& remark);
std::string indi_update(const IndiVector& vector, const IndiRemark& remark);
std::string indi_deletion(const std::string& device, const char* property,
                          const IndiRemark& remark);
/// `device` is empty if it concerns none.
std::string indi_message(const std::string& device, const IndiRemark& remark);
/// An update of a vector of one BLOB.
std::string indi_blob_update(const IndiVector& vector, const std::string& bytes, const char* format,
                             const IndiRemark& remark);

/// Whether a client is to be told of the change.
bool is_noticed(const IndiVector& before, const IndiVector& after);

/// Base64 of RFC 4648, without line breaks.
std::string base64(const std::string& bytes);

}  // namespace dmise
