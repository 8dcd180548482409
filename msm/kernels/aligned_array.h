// Arrays of the kernels, each at the start of a cache line.
#pragma once

#include <algorithm>
#include <memory>
#include <new>
#include <vector>

namespace springproof {

constexpr std::size_t cache_line = 64;

/// Array aligned to cache lines.
template <class Real>
class AlignedArray {
 public:
  AlignedArray() = default;
  AlignedArray(std::size_t size, Real value)
      : size_(size), values_(static_cast<Real*>(::operator new(size * sizeof(Real), alignment))) {
    std::fill_n(values_.get(), size, value);
  }
  Real* data() const { return values_.get(); }
  std::size_t size() const { return size_; }
  Real* begin() const { return data(); }
  Real* end() const { return data() + size_; }
  std::size_t bytes() const { return size_ * sizeof(Real); }

 private:
  static constexpr std::align_val_t alignment{cache_line};
  struct Delete {
    void operator()(Real* p) const { ::operator delete(p, alignment); }
  };
  std::size_t size_ = 0;
  std::unique_ptr<Real, Delete> values_;
};

template <class Real>
AlignedArray<Real> aligned_copy(const std::vector<double>& values) {
  AlignedArray<Real> copy(values.size(), Real(0));
  std::transform(values.begin(), values.end(), copy.data(), [](double v) { return static_cast<Real>(v); });
  return copy;
}

}  // namespace springproof
