// Bytes and text as other formats want them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace springproof {

/// RFC 4648, with padding.
std::string base64(const void* bytes, std::size_t count);

/// Back; ends at the first character that is no digit.
std::string from_base64(std::string_view text);

/// With &amp; &lt; &gt; &quot; for the characters that XML and HTML reserve.
std::string xml_escaped(std::string_view text);

}  // namespace springproof
