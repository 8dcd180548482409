#include "problem/files/checksum.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL  // the header alone: programs that link us need no library of it
#include <xxhash.h>

namespace springproof {

std::string checksum(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

}  // namespace springproof
