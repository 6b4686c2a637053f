#include "core/base/module.h"

#include <dlfcn.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>

#include "core/base/error.h"

namespace dmise {
namespace {

std::string path_of(const Module& module) {
  if (const char* path = std::getenv(module.environment)) return path;
  std::error_code failed;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::string file = std::string("libdmise_") + module.name + ".so";
  const auto libraries = program.parent_path().parent_path() / "lib";
  const auto installed = libraries / "dmise" / file;
  return (std::filesystem::exists(installed, failed) ? installed : libraries / file).string();
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
