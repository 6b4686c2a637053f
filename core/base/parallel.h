#pragma once
#include <cstddef>
#include <functional>
#include <memory>

namespace dmise {

/// Pool of threads for parallel loops. Results never depend on the number of threads: ranges are
/// cut by `grain` alone, and each writes only its own part of the output.
class Threads {
 public:
  /// `count` threads including the caller's, >= 1; 1 starts none.
  explicit Threads(int count = 1);
  ~Threads();

  int count() const { return count_; }

  /// Calls `work(begin, end)` for consecutive ranges of at most `grain` items covering [0, items);
  /// returns when all are done. The first exception that a range throws is rethrown here.
  void for_ranges(std::size_t items, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& work);

 private:
  struct Pool;
  std::unique_ptr<Pool> pool_;  // null: none but the caller's thread
  int count_ = 1;
};

}  // namespace dmise
