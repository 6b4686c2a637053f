#pragma once
#include "core/base/error.h"

namespace dmise {

/// One record of a file is at fault; the message is its `reason, got "value"`.
class RecordError : public ConfigError {
 public:
  using ConfigError::ConfigError;
};

}  // namespace dmise
