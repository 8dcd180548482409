// Classes of numbers that are united one by one.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace springproof {

class UnitedNumbers {
 public:
  explicit UnitedNumbers(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int of(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int i, int j) { parent_[std::max(of(i), of(j))] = std::min(of(i), of(j)); }

 private:
  std::vector<int> parent_;
};

}  // namespace springproof
