#pragma once
#include <string>

namespace dmise {

/// An address of this machine that only this user can connect to: a socket in a directory of its
/// own, which is removed with this object. Connections last.
class PrivateEndpoint {
 public:
  /// Throws `Error` if there is no place for temporary files.
  PrivateEndpoint();
  ~PrivateEndpoint();
  PrivateEndpoint(const PrivateEndpoint&) = delete;
  PrivateEndpoint& operator=(const PrivateEndpoint&) = delete;

  std::string address() const { return "ipc://" + path(); }

 private:
  std::string path() const { return directory_ + "/socket"; }
  std::string directory_;
};

}  // namespace dmise
