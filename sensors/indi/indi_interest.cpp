#include "sensors/indi/indi_interest.h"

#include <algorithm>

namespace dmise {
namespace {

constexpr std::size_t max_places = 1000;  // who asks for more is told of all

}  // namespace

void IndiInterest::ask(const GetIndiProperties& asked) {
  if (asked_.size() >= max_places) asked_.insert({"", ""});
  if (asked_.size() <= max_places) asked_.insert({asked.device, asked.property});
}

void IndiInterest::enable(const EnableIndiBlob& enabled) {
  if (blobs_.size() >= max_places) blobs_.clear();
  // What is said of a device holds for all of its properties.
  if (enabled.property.empty())
    std::erase_if(blobs_, [&](const auto& entry) { return entry.first.first == enabled.device; });
  blobs_[{enabled.device, enabled.property}] = enabled.use;
}

bool IndiInterest::wants(const std::string& device, const std::string& property, bool blob) const {
  const bool asked = asked_.contains({"", ""}) || asked_.contains({device, ""}) ||
                     asked_.contains({device, property});
  auto use = blobs_.find({device, property});
  if (use == blobs_.end()) use = blobs_.find({device, ""});
  if (blob) return use != blobs_.end() && use->second != BlobUse::never;
  const auto is_only = [&](const auto& entry) {
    return entry.first.first == device && entry.second == BlobUse::only;
  };
  return asked && std::ranges::none_of(blobs_, is_only);
}

}  // namespace dmise
