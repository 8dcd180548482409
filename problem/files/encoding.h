// Base64 encoding and XML escaping.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace springproof {

/// RFC 4648, with padding.
std::string base64(const void* bytes, std::size_t count);

/// Decodes base64; stops at the first character that is no base64 digit.
std::string from_base64(std::string_view text);

/// Replaces the characters reserved in XML and HTML by &amp; &lt; &gt; &quot;.
std::string xml_escaped(std::string_view text);

}  // namespace springproof
