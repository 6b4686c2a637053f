#include "core/base/module.h"

#include <dlfcn.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/own_file.h"

namespace dmise {
namespace {

std::string path_of(const Module& module) {
  if (const char* path = std::getenv(module.environment)) return path;
  std::error_code failed;
  const std::string file = std::string("libdmise_") + module.name + ".so";
  const auto own = std::filesystem::path(own_file()).parent_path();
  for (auto above = own; above.has_relative_path(); above = above.parent_path())
    for (const auto& path : {above / "lib/dmise" / file, above / "lib" / file})
      if (std::filesystem::exists(path, failed)) return path.string();
  return (own.parent_path() / "lib" / file).string();
}

/// Signals are blocked while loading, so that threads which libraries start at that time take none.
void* loaded_from(const std::string& path) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  void* const loaded = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return loaded;
}

}  // namespace

void* made_by_module(const Module& module, const char* entry) {
  const std::string path = path_of(module), name = module.name;
  void* const loaded = loaded_from(path);
  if (!loaded) throw Error(name + " module cannot be loaded: " + ::dlerror());
  const auto make = reinterpret_cast<void* (*)(std::string&)>(::dlsym(loaded, entry));
  if (!make) throw Error(path + ": is not a " + name + " module");
  std::string reason;
  void* const made = make(reason);
  if (!made) throw Error(name + ": " + reason);
  return made;
}

}  // namespace dmise
