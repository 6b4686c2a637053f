#include "core/base/detached_work.h"

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace dmise {
namespace {

struct RunningWork {
  std::mutex mutex;
  std::condition_variable ended;
  int count = 0;

  void add(int change) {
    std::lock_guard lock(mutex);
    count += change;
    ended.notify_all();
  }
};

/// Never destroyed: work may outlive the program's other objects.
RunningWork& running_work() {
  static auto* running = new RunningWork;
  return *running;
}

}  // namespace

void start_detached(std::function<void()> work) {
  running_work().add(1);
  try {
    std::thread([work = std::move(work)]() mutable {
      work();
      work = nullptr;
      running_work().add(-1);
    }).detach();
  } catch (...) {
    running_work().add(-1);
    throw;
  }
}

bool wait_for_detached(std::chrono::milliseconds time) {
  RunningWork& running = running_work();
  std::unique_lock lock(running.mutex);
  return running.ended.wait_for(lock, time, [&] { return running.count == 0; });
}

}  // namespace dmise
