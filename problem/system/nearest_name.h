// "did you mean ...?" for every name a user can mistype.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace springproof {

/// Levenshtein distance.
inline std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

/// "; did you mean 'x'?" with the nearest of `known`, or "" if none is within an edit distance of half the name's
/// length plus one.
inline std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  const std::string* best = nullptr;
  std::size_t distance = name.size() / 2 + 1;
  for (const std::string& k : known)
    if (const std::size_t d = edit_distance(name, k); d <= distance && (!best || d < distance)) best = &k, distance = d;
  return best ? "; did you mean '" + *best + "'?" : "";
}

}  // namespace springproof
