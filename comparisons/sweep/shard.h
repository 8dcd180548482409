// Shares of the parts of a comparison, for several machines.
#pragma once

#include <string>
#include <vector>

namespace springproof {

/// One of `count` shares, numbered from 1.
struct Shard {
  int number = 1, count = 1;
};

inline constexpr int most_shards = 10000;

/// Reads "3/16".
/// @throws InputError
Shard parse_shard(const std::string& text);

/// The number of the shard of each part: the longest parts first, each to the shard with the least to do.  Parts that
/// take equally long go round.
std::vector<int> shards_of(const std::vector<double>& expected_seconds, int count);

/// The parts in the order in which they are to be started: none of the long ones is left for the end.
std::vector<std::size_t> longest_first(const std::vector<double>& expected_seconds);

}  // namespace springproof
