// Whole files, read and written at once.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace springproof {

/// The whole file; empty if it cannot be read.
std::string text_of_file(const std::filesystem::path& file);

/// Writes all of it or nothing: into FILE.part, which is renamed when complete.  Of a symbolic link, what it leads to.
/// @throws std::system_error naming the file and the reason.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// The text without trailing white space.
std::string trimmed(std::string text);

}  // namespace springproof
