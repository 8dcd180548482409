// Lists of values, one after the other in one array.
#pragma once

#include <numeric>
#include <span>
#include <vector>

namespace springproof {

template <class Value>
class Lists {
 public:
  /// @param each each(add) calls add(list, value) for all values, the same whenever it is called
  template <class Each>
  Lists(std::size_t count, const Each& each) : begin_(count + 1, 0) {
    each([&](std::size_t list, const Value&) { ++begin_[list + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    values_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    each([&](std::size_t list, const Value& value) { values_[next[list]++] = value; });
  }
  std::span<Value> operator[](std::size_t list) {
    return {values_.begin() + begin_[list], values_.begin() + begin_[list + 1]};
  }
  std::span<const Value> operator[](std::size_t list) const {
    return {values_.begin() + begin_[list], values_.begin() + begin_[list + 1]};
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<Value> values_;
};

}  // namespace springproof
