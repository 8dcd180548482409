#include "comparisons/sweep/shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <string_view>

#include "problem/system/input_error.h"
#include "problem/system/shortened.h"

namespace springproof {
namespace {

/// 0: no number.
int whole_number(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : 0;
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard shard{0, 0};
  if (slash != std::string::npos)
    shard = {whole_number(std::string_view(text).substr(0, slash)),
             whole_number(std::string_view(text).substr(slash + 1))};
  if (shard.number < 1 || shard.number > shard.count || shard.count > most_shards)
    throw InputError(shortened(fmt::format(
        "--shard: is {} (allowed: K/N, the K-th of N shares, K from 1 to N, N up to {})", text, most_shards)));
  return shard;
}

std::vector<std::size_t> longest_first(const std::vector<double>& seconds) {
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seconds[a] > seconds[b]; });
  return order;
}

std::vector<int> shards_of(const std::vector<double>& expected_seconds, int count) {
  std::vector<double> load(static_cast<std::size_t>(count), 0.0);
  std::vector<int> shards(expected_seconds.size());
  for (const std::size_t part : longest_first(expected_seconds)) {
    const auto least = std::min_element(load.begin(), load.end());
    *least += expected_seconds[part];
    shards[part] = static_cast<int>(least - load.begin()) + 1;
  }
  return shards;
}

}  // namespace springproof
