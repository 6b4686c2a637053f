#include "core/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "core/base/cancellation.h"

namespace dmise {

struct Threads::Pool {
  std::mutex mutex;
  std::condition_variable wake, idle;
  std::vector<std::thread> threads;
  std::function<void()> job;
  std::size_t generation = 0;
  int running = 0;
  bool stop = false;

  /// With fewer threads where the system allows no more: what is computed does not depend on it.
  explicit Pool(int extra) {
    threads.reserve(std::size_t(extra));
    try {
      for (int i = 0; i < extra; ++i) threads.emplace_back([this] { loop(); });
    } catch (const std::system_error&) {
    }
  }
  ~Pool() {
    {
      std::lock_guard lock(mutex);
      stop = true;
    }
    wake.notify_all();
    for (auto& thread : threads) thread.join();
  }
  void loop() {
    std::size_t seen = 0;
    std::unique_lock lock(mutex);
    while (true) {
      wake.wait(lock, [&] { return stop || generation != seen; });
      if (stop) return;
      seen = generation;
      auto mine = job;
      lock.unlock();
      mine();
      lock.lock();
      if (--running == 0) idle.notify_one();
    }
  }
  void run(const std::function<void()>& work) {
    {
      std::lock_guard lock(mutex);
      job = work;
      running = static_cast<int>(threads.size());
      ++generation;
    }
    wake.notify_all();
    work();
    std::unique_lock lock(mutex);
    idle.wait(lock, [&] { return running == 0; });
  }
};

Threads::Threads(int count) : count_(std::max(1, count)) {
  if (count_ > 1) pool_ = std::make_unique<Pool>(count_ - 1);
}

Threads::~Threads() = default;

void Threads::for_ranges(std::size_t items, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& work) {
  grain = std::max<std::size_t>(1, grain);
  const std::size_t ranges = (items + grain - 1) / grain;
  std::atomic<std::size_t> next{0};
  std::mutex error_mutex;
  std::exception_ptr error;
  const std::atomic<bool>* cancelled = cancellation_flag();
  const auto drain = [&] {
    for (std::size_t i = next++; i < ranges; i = next++) {
      try {
        if (cancelled && *cancelled) {
          next = ranges;
          throw Cancelled();
        }
        work(i * grain, std::min(items, (i + 1) * grain));
      } catch (...) {
        std::lock_guard lock(error_mutex);
        if (!error) error = std::current_exception();
      }
    }
  };
  if (pool_ && ranges > 1) {
    pool_->run(drain);
  } else {
    drain();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace dmise
