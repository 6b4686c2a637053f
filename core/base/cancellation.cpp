#include "core/base/cancellation.h"

namespace dmise {
namespace {

thread_local const std::atomic<bool>* flag_of_thread = nullptr;

}  // namespace

CancellationScope::CancellationScope(const std::atomic<bool>& asked) : before_(flag_of_thread) {
  flag_of_thread = &asked;
}

CancellationScope::~CancellationScope() { flag_of_thread = before_; }

const std::atomic<bool>* cancellation_flag() { return flag_of_thread; }

}  // namespace dmise
