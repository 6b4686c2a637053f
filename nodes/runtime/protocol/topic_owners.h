#pragma once
#include <map>
#include <optional>
#include <string>

#include "dmise/v1/node.pb.h"

namespace dmise {

/// Who publishes which topic of a run: one name each, for good once the run has begun.
class TopicOwners {
 public:
  /// Why `join` can't publish what it says; nothing when it can.
  std::optional<std::string> fault_of(const v1::Join& join) const;
  /// It has joined: its topics are its own.
  void add(const v1::Join& join);
  /// It has left before the run began: others may publish its topics.
  void remove(const std::string& node);
  /// Takes out of `done`, which came over the connection of `member`, what it tells of topics of
  /// others: neither its own, nor of a node behind that agent. False when there was such.
  bool keep_own(const std::string& member, v1::Done* done) const;

 private:
  struct Owner {
    std::string node, host;
  };
  std::map<std::string, Owner, std::less<>> owners_;  // by topic
};

}  // namespace dmise
