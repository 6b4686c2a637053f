#pragma once
#include <string>

#include "core/base/error.h"

namespace dmise::test {

/// What `work` throws as `ConfigError`; "no error" if it ends.
template <class Work>
std::string config_error_of(Work&& work) {
  try {
    work();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace dmise::test
