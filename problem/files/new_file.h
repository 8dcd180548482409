// Files that get their place when they are complete, and files that say themselves whether they are whole: several
// machines may write those into one folder.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>

namespace springproof {

/// New content of a file, under a name beside it that nothing else has, "FILE.0123abcd.part", until it gets its place;
/// without one it is removed.  No link is followed, nothing of others is overwritten on the way.
class NewFile {
 public:
  /// @param pieces of the content, one after the other
  /// @throws std::system_error naming the file and the reason.
  NewFile(const std::filesystem::path& file, std::initializer_list<std::string_view> pieces);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Gives it its place, in place of what is there: a file, or a symbolic link itself.
  /// @throws std::system_error
  void replace();

  /// Gives it its place, unless something is there; also where there are no hard links.
  /// @return whether this call did; of several at once exactly one does.
  /// @throws std::system_error
  bool create();

 private:
  void write(int descriptor, std::initializer_list<std::string_view> pieces);
  [[noreturn]] void fail(int error);

  const std::filesystem::path file_;
  std::filesystem::path own_;  ///< empty: it is gone
};

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
