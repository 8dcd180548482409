#include "problem/system/shortened.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace springproof {

std::string without_colours(const std::string& text) {
  const auto is_last = [](char c) { return c >= '@' && c <= '~'; };
  std::string out;
  for (auto at = text.begin(); at != text.end(); ++at) {
    if (*at != '\x1b' || text.end() - at < 2 || at[1] != '[') {
      out += *at;
      continue;
    }
    at = std::find_if(at + 2, text.end(), is_last);
    if (at == text.end()) break;
  }
  return out;
}

std::string shortened(const std::string& coloured) {
  const std::string message = without_colours(coloured);
  constexpr std::size_t longest = 100, shown = 40;
  const auto continues_letter = [&](std::size_t at) {
    return (static_cast<unsigned char>(message[at]) & 0xc0) == 0x80;
  };
  std::string out;
  for (std::size_t begin = 0, end; begin < message.size(); begin = end) {
    end = std::min(message.find(' ', begin), message.size());
    std::size_t cut = end;
    if (end - begin > longest)
      for (cut = begin + shown; cut > begin && continues_letter(cut);) --cut;
    for (const char c : std::string_view(message).substr(begin, cut - begin))
      out += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    if (cut < end) out += fmt::format("... ({} letters)", end - begin);
    if (end < message.size()) out += message[end++];
  }
  return out;
}

}  // namespace springproof
