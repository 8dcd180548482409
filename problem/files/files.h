// Whole files, read and written at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace springproof {

/// The whole file; empty if it cannot be read, or is a pipe or a device, which may never end.
std::string text_of_file(const std::filesystem::path& file);

/// Writes all of it or nothing, in place of a file or of a symbolic link itself.  What a user names: named_files.h.
/// @throws std::system_error naming the file and the reason.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// The text without trailing white space.
std::string trimmed(std::string text);

}  // namespace springproof
