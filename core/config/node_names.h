#pragma once
#include <map>
#include <optional>
#include <string>

namespace dmise {

/// Why `name` can't be that of a node, an observer or a key; nothing if it can: 1 to 64 letters,
/// digits, - and _, not beginning with -, which would be taken for an option.
std::optional<std::string> fault_of_name(const std::string& name);

/// The names of the sensors of a run. Each has a directory in the run's, a log, a key and a place
/// in the network of its name: two that differ in case alone are one on some file systems, and
/// what a run itself calls its processes and directories is taken.
class SensorNames {
 public:
  /// Why a further sensor can't be called `name`; nothing if it can, and it is noted.
  std::optional<std::string> fault_of(const std::string& name);

 private:
  std::map<std::string, std::string> taken_;  // as given, by the name in lower case
};

}  // namespace dmise
