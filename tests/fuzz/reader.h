// What the targets share: a reader reads or refuses; anything else that it does is a finding.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace springproof::fuzz {

[[noreturn]] inline void finding(const char* what, const char* more = "") {
  std::fprintf(stderr, "FINDING: %s %s\n", what, more);
  std::abort();
}

inline void require(bool holds, const char* what) {
  if (!holds) finding("this does not hold:", what);
}

/// Runs a reader that may throw a Refusal, and nothing else.  With SPRINGPROOF_FUZZ_READ in the environment (for seeds
/// that are there to be read) it may not.
template <class Refusal, class Reader>
int read_or_refuse(const Reader& reader) {
  try {
    reader();
  } catch (const Refusal& refusal) {
    if (std::getenv("SPRINGPROOF_FUZZ_READ")) finding("a seed that should be read is refused:", refusal.what());
  }
  return 0;
}

/// With SPRINGPROOF_FUZZ_WRITE in the environment: writes a file to start from there, and ends.  For formats that are
/// not written by hand.
template <class Writer>
int write_seed(const Writer& writer) {
  if (const char* file = std::getenv("SPRINGPROOF_FUZZ_WRITE")) {
    writer(file);
    std::exit(0);
  }
  return 0;
}

inline std::string_view view(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace springproof::fuzz
