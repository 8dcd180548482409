// std::from_chars of a double, which Emscripten's standard library (libc++ 14) lacks: put before stl.cpp by the build.
#pragma once

#include <cctype>
#include <charconv>
#include <cstdlib>
#include <string>

namespace std {

inline from_chars_result from_chars(const char* begin, const char* end, double& value) {
  const string word(begin, end);
  char* stop = nullptr;
  // strtod takes more: space and plus in front, hexadecimals
  const bool begins = !word.empty() && (isdigit(word[0]) || word[0] == '-' || word[0] == '.' || isalpha(word[0]));
  if (begins && word.find_first_of("xX") == string::npos) value = strtod(word.c_str(), &stop);
  const bool read = stop && stop != word.c_str();
  return {read ? begin + (stop - word.c_str()) : begin, read ? errc{} : errc::invalid_argument};
}

}  // namespace std
