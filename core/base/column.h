#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace dmise {

/// Read-only array that shares ownership of its storage: a filled vector or a mapped file. Copies
/// share the storage.
template <class T>
class Column {
 public:
  using value_type = T;

  Column() = default;
  Column(std::vector<T> values) {
    auto kept = std::make_shared<const std::vector<T>>(std::move(values));
    values_ = *kept;
    owner_ = std::move(kept);
  }
  /// `owner` keeps the storage of `values` alive.
  Column(std::span<const T> values, std::shared_ptr<const void> owner)
      : values_(values), owner_(std::move(owner)) {}

  const T* data() const { return values_.data(); }
  std::size_t size() const { return values_.size(); }
  const T& operator[](std::size_t i) const { return values_[i]; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size(); }
  bool operator==(const Column& other) const { return std::ranges::equal(*this, other); }

 private:
  std::span<const T> values_;
  std::shared_ptr<const void> owner_;
};

}  // namespace dmise
