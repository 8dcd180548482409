// Whole files, read and written at once; those that a user names: whatever stands behind the name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace springproof {

/// The whole file; empty if it cannot be read, or is a pipe or a device, which may never end.
std::string text_of_file(const std::filesystem::path& file);

/// Writes all of it or nothing, in place of a file or of a symbolic link itself.  What a user names:
/// write_named_file().
/// @throws std::system_error naming the file and the reason.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// XXH3 with 128 bits, as 32 hexadecimal digits: detects damage and changes, not tampering.
std::string checksum(std::string_view bytes);

/// The text without trailing white space.
std::string trimmed(std::string text);

inline constexpr std::uintmax_t largest_file = std::uintmax_t{1} << 31;  ///< that is read [bytes]

/// Nothing where the file can be read whole: it is there and neither a folder nor a pipe or a device, which may never
/// end.
/// @param allowed "a springs file, NAME.json"
/// @throws InputError naming the file, what it is, and what is allowed.
void require_file(const std::filesystem::path& file, std::string_view allowed,
                  std::uintmax_t most_bytes = largest_file);

/// The whole file.
/// @throws as require_file, and with the reason where it cannot be read.
std::string read_named_file(const std::filesystem::path& file, std::string_view allowed,
                            std::uintmax_t most_bytes = largest_file);

/// What a chain of symbolic links ends in, which may not exist yet; the file itself where it is none.
/// @throws std::system_error at a loop.
std::filesystem::path end_of_links(std::filesystem::path file);

/// As write_file; of a symbolic link, what it leads to; into a pipe or a device as it is.
/// @throws std::system_error naming the file and the reason.
void write_named_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace springproof
