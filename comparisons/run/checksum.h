// What a file's contents come to.
#pragma once

#include <string>
#include <string_view>

namespace springproof {

/// XXH3 with 128 bits, as 32 hexadecimal digits: finds damage and change, not malice.
std::string checksum(std::string_view bytes);

}  // namespace springproof
