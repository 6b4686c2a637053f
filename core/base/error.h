#pragma once
#include <stdexcept>
#include <string>

namespace dmise {

/// Base of all errors; the message is one line. Programs exit 1 on it.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Invalid input: `file:line:column: key: reason, got value`. Programs exit 2 on it.
class ConfigError : public Error {
 public:
  using Error::Error;
};

}  // namespace dmise
