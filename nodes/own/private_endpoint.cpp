#include "nodes/own/private_endpoint.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr std::size_t longest_directory = 80;  // the address of a local socket has 107 characters

std::string place_for_temporary_files() {
  std::error_code error;
  const std::string path = std::filesystem::temp_directory_path(error).string();
  return error || path.size() > longest_directory ? "/tmp" : path;
}

}  // namespace

PrivateEndpoint::PrivateEndpoint() : directory_(place_for_temporary_files() + "/dmise-XXXXXX") {
  if (!mkdtemp(directory_.data()))
    throw Error(directory_ + ": can't be made: " + std::strerror(errno));
}

PrivateEndpoint::~PrivateEndpoint() {
  unlink(path().c_str());
  rmdir(directory_.c_str());
}

}  // namespace dmise
