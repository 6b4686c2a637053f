#pragma once
#include <deque>
#include <memory>
#include <mutex>

namespace dmise {

/// Cache of tables that take milliseconds to make, by what they are made of: the last 64 made are
/// kept. Safe to call from several threads.
template <class Key, class Table>
class KeptTables {
 public:
  template <class Make>
  std::shared_ptr<const Table> of(const Key& key, Make&& make) {
    std::lock_guard lock(mutex_);
    for (const auto& [kept_key, table] : kept_)
      if (kept_key == key) return table;
    auto table = std::make_shared<const Table>(make());
    kept_.emplace_front(key, table);
    if (kept_.size() > most) kept_.pop_back();
    return table;
  }

 private:
  static constexpr std::size_t most = 64;
  std::mutex mutex_;
  std::deque<std::pair<Key, std::shared_ptr<const Table>>> kept_;
};

}  // namespace dmise
