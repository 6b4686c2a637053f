#pragma once
#include <map>
#include <optional>
#include <string>

#include "dmise/v1/node.pb.h"

namespace dmise {

/// Publisher of each topic of a run: one name each, fixed once the run has begun.
class TopicOwners {
 public:
  /// Returns why `join` cannot publish its topics; empty if it can.
  std::optional<std::string> fault_of(const v1::Join& join) const;
  /// Records the topics of a process that has joined.
  void add(const v1::Join& join);
  /// Releases the topics of a process that has left before the start.
  void remove(const std::string& node);
  /// Removes from `done`, received over the connection of `member`, topics that belong neither to
  /// it nor to a node behind that agent. False if there were any.
  bool keep_own(const std::string& member, v1::Done* done) const;

 private:
  struct Owner {
    std::string node, host;
  };
  std::map<std::string, Owner, std::less<>> owners_;  // by topic
};

}  // namespace dmise
