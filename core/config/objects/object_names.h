#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// Returns the entry of `names` closest to `word`, ignoring case; for "OSCAR 7 (AO-7)" both names
/// count. Empty if none is close.
std::string nearest_object(std::string_view word, const std::vector<std::string>& names);

/// Whether `word` is the name or the catalogue number of `object`.
template <class Object>
bool is_called(const Object& object, std::string_view word) {
  return word == object.name || word == std::to_string(object.catalogue_number);
}

}  // namespace dmise
