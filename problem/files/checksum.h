// Checksum of a file's contents.
#pragma once

#include <string>
#include <string_view>

namespace springproof {

/// XXH3 with 128 bits, as 32 hexadecimal digits: detects damage and changes, not tampering.
std::string checksum(std::string_view bytes);

}  // namespace springproof
