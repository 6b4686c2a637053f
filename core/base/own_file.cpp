#include "core/base/own_file.h"

#include <dlfcn.h>
#include <link.h>

#include <filesystem>

namespace dmise {

std::string own_file() {
  std::error_code failed;
  Dl_info info{};
  link_map* loaded = nullptr;
  const auto here = reinterpret_cast<void*>(&own_file);
  if (::dladdr1(here, &info, reinterpret_cast<void**>(&loaded), RTLD_DL_LINKMAP) != 0 && loaded &&
      loaded->l_name[0] != '\0')  // which the program has not
    return std::filesystem::canonical(loaded->l_name, failed).string();
  return std::filesystem::read_symlink("/proc/self/exe", failed).string();
}

}  // namespace dmise
