#include "core/base/detached_work.h"

#include <pthread.h>

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

RunningWork& running_work();

/// A forked process begins with none: it has only the thread that forked.
RunningWork* begun_anew_in_forks() {
  ::pthread_atfork([] { running_work().mutex.lock(); }, [] { running_work().mutex.unlock(); },
                   [] {
                     running_work().count = 0;
                     running_work().mutex.unlock();
                   });
  return new RunningWork;
}

/// Never destroyed: work may outlive the program's other objects.
RunningWork& running_work() {
  static auto* running = begun_anew_in_forks();
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
