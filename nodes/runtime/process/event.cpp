#include "nodes/runtime/process/event.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>

#include "core/base/error.h"

namespace dmise {
namespace {

Event* signalled = nullptr;

extern "C" void on_stop_signal(int) { signalled->set(); }

}  // namespace

Event::Event() : fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0) throw Error("eventfd: too many open files");
}

Event::~Event() { close(fd_); }

void Event::set() {
  flag_.store(true, std::memory_order_release);
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = write(fd_, &one, sizeof one);
}

void Event::clear() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto taken = read(fd_, &count, sizeof count);
  flag_.store(false, std::memory_order_release);
}

Event& stop_signal() {
  static Event event;
  if (!signalled) {
    signalled = &event;
    struct sigaction action {};
    action.sa_handler = on_stop_signal;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction hangup {};
    sigaction(SIGHUP, nullptr, &hangup);
    if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  }
  return event;
}

}  // namespace dmise
