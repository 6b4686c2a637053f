#pragma once
#include "time-master/coordinator.h"

namespace dmise {

/// "running"
inline const char* phase_name(Phase phase) {
  switch (phase) {
    case Phase::gathering:
      return "gathering";
    case Phase::connecting:
      return "connecting";
    case Phase::running:
      return "running";
    case Phase::ended:
      return "ended";
    case Phase::failed:
      break;
  }
  return "failed";
}

}  // namespace dmise
