#include "nodes/runtime/protocol/topic_owners.h"

#include <algorithm>

namespace dmise {

std::optional<std::string> TopicOwners::fault_of(const v1::Join& join) const {
  for (const auto* topics : {&join.produces(), &join.produces_direct()})
    for (const std::string& topic : *topics)
      if (const auto owner = owners_.find(topic);
          owner != owners_.end() && owner->second.node != join.name())
        return topic + " is published by " + owner->second.node;
  return std::nullopt;
}

void TopicOwners::add(const v1::Join& join) {
  for (const auto* topics : {&join.produces(), &join.produces_direct()})
    for (const std::string& topic : *topics) owners_[topic] = {join.name(), join.host()};
}

void TopicOwners::remove(const std::string& node) {
  std::erase_if(owners_, [&](const auto& entry) { return entry.second.node == node; });
}

bool TopicOwners::keep_own(const std::string& member, v1::Done* done) const {
  auto* published = done->mutable_published();
  const auto others =
      std::remove_if(published->begin(), published->end(), [&](const v1::TopicTally& tally) {
        const auto owner = owners_.find(tally.topic());
        return member.empty() || owner == owners_.end() ||
               (owner->second.node != member && owner->second.host != member);
      });
  const bool all_own = others == published->end();
  published->erase(others, published->end());
  return all_own;
}

}  // namespace dmise
