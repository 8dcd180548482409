// A file that gets its place when it is complete.
#pragma once

#include <filesystem>
#include <initializer_list>
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

}  // namespace springproof
