#pragma once
#include <map>
#include <set>
#include <string>
#include <utility>

#include "sensors/indi/indi_request.h"

namespace dmise {

/// What a client wants to be told of: what it has asked for, BLOBs where it enabled them.
class IndiInterest {
 public:
  void ask(const GetIndiProperties& asked);
  void enable(const EnableIndiBlob& enabled);

  /// "" as `property` is that of a message of the device.
  bool wants(const std::string& device, const std::string& property, bool blob) const;
  bool has_asked() const { return !asked_.empty(); }

 private:
  using Place = std::pair<std::string, std::string>;  // device and property; empty: all

  std::set<Place> asked_;
  std::map<Place, BlobUse> blobs_;
};

}  // namespace dmise
