#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

namespace dmise {

/// An array of numpy without a copy, which cannot be written: `owner` keeps its memory.
template <class T>
nanobind::object array_in(const T* data, std::initializer_list<std::size_t> shape,
                          nanobind::handle owner) {
  return nanobind::ndarray<nanobind::numpy, const T>(data, shape.size(), shape.begin(), owner)
      .cast();
}

/// An array of numpy that owns the numbers of `values`.
template <class T>
nanobind::object array_of(std::vector<T> values, std::initializer_list<std::size_t> shape) {
  auto* kept = new std::vector<T>(std::move(values));
  const nanobind::capsule owner(kept,
                                [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nanobind::ndarray<nanobind::numpy, T>(kept->data(), shape.size(), shape.begin(), owner)
      .cast();
}

}  // namespace dmise
