#include "fem_reference/exchange/plain_words.h"

#include <algorithm>
#include <sstream>

#include "problem/system/shortened.h"

namespace springproof::fem {
namespace {

/// The text between two marks; empty if the first is missing.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const auto at = text.find(begin);
  if (at == std::string::npos) return {};
  const auto from = at + begin.size();
  return text.substr(from, text.find(end, from) - from);
}

std::string one_line(const std::string& text) {
  std::istringstream words(text);
  std::string line;
  for (std::string word; words >> word;)
    if (!std::all_of(word.begin(), word.end(), [](char c) { return c == '-'; }) || word == "-")
      line += (line.empty() ? "" : " ") + word;
  return line;
}

}  // namespace

std::string plain_words(const std::string& coloured) {
  const std::string message = without_colours(coloured);
  if (message.find("An error occurred in line <") == std::string::npos) return one_line(message);
  const std::string said = one_line(between(message, "Additional information:", "\n\n"));
  const std::string condition = one_line(between(message, "The violated condition was:", "\n"));
  return "deal.II: " + (!said.empty()        ? said
                        : !condition.empty() ? "a condition does not hold: " + condition
                                             : "an error without words");
}

}  // namespace springproof::fem
