#pragma once
#include <map>
#include <optional>
#include <string>

namespace dmise {

/// Returns why `name` cannot be the name of a node, an observer or a key; empty if it can: 1 to 64
/// letters, digits, - and _, not beginning with -, which would look like an option.
std::optional<std::string> fault_of_name(const std::string& name);

/// Names of the sensors and of the user's own nodes of a run. Each becomes the name of a directory,
/// a log, a key and a network member: names that differ only in case collide on some file systems,
/// and the names of other processes and directories of a run are reserved.
class NodeNames {
 public:
  /// Returns why a further one cannot be called `name`; empty if it can, and the name is then
  /// taken.
  std::optional<std::string> fault_of(const std::string& name);

 private:
  std::map<std::string, std::string> taken_;  // as given, by lower-case name
};

}  // namespace dmise
