// Files that say themselves whether they are whole, and that several machines may write into one folder.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace springproof {

/// Thrown if a checked file is damaged.
class DamagedFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a line of the heading and the checksum of the content, then the content.  Any number of programs may write
/// the same file: it is one of theirs, whole.
/// @throws std::system_error naming the file and the reason.
void write_checked(const std::filesystem::path& file, std::string_view heading, std::string_view content);

/// As write_checked, unless the file is there already.
/// @return whether this call created it; of several at once exactly one does.
bool create_checked(const std::filesystem::path& file, std::string_view heading, std::string_view content);

/// The content that write_checked wrote.
/// @throws DamagedFile if the heading or the checksum does not match.
std::string read_checked(const std::filesystem::path& file, std::string_view heading);

[[noreturn]] void refuse_damaged(const std::filesystem::path& file);

}  // namespace springproof
